"""usage: moving_picture.py FOLDER DOCS: makes playground.webp of the frames that pictures.js took, and playground-cost.webp."""

import pathlib
import sys

from PIL import Image

folder, docs = map(pathlib.Path, sys.argv[1:])
frames = [Image.open(path).convert("RGB") for path in sorted(folder.glob("[0-9]*.png"))]
width = 520
frames = [f.resize((width, f.height * width // f.width), Image.Resampling.LANCZOS) for f in frames]
frames[0].save(docs / "playground.webp", save_all=True, append_images=frames[1:], duration=80, loop=0, quality=14, method=6)
cost = Image.open(folder / "cost.png").convert("RGB")
cost = cost.resize((1080, cost.height * 1080 // cost.width), Image.Resampling.LANCZOS)
cost.save(docs / "playground-cost.webp", quality=55, method=6)
print((docs / "playground.webp").stat().st_size, "bytes")
