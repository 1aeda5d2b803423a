"""usage: moving_picture.py FOLDER DOCS: makes playground.gif of the frames that pictures.js took, and copies the curve."""

import pathlib
import shutil
import sys

from PIL import Image

folder, docs = map(pathlib.Path, sys.argv[1:])
frames = [Image.open(path).convert("RGB") for path in sorted(folder.glob("[0-9]*.png"))]
width = 560
frames = [f.resize((width, f.height * width // f.width), Image.Resampling.LANCZOS) for f in frames]
# One palette for all, so that colours do not flicker.
samples = frames[:: len(frames) // 4]
sheet = Image.new("RGB", (width, sum(f.height for f in samples)))
for i, f in enumerate(samples):
    sheet.paste(f, (0, i * f.height))
palette = sheet.quantize(96)
shown = [f.quantize(palette=palette, dither=Image.Dither.NONE) for f in frames]
shown[0].save(docs / "playground.gif", save_all=True, append_images=shown[1:], duration=83, loop=0, optimize=True)
cost = Image.open(folder / "cost.png").convert("RGB").quantize(64)
cost.save(docs / "playground-cost.png", optimize=True)
print((docs / "playground.gif").stat().st_size, "bytes")
