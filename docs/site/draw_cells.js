// Draws docs/cells.svg, the still picture of the figure "cells" in docs/paper-explained.md.
// usage: node docs/site/draw_cells.js [--check]

import {readFileSync, writeFileSync} from "node:fs";

import {bodiesInThePlane, meanEdgeOf, stepInThePlane, triangleInTheMiddle} from "./live/plane.js";

const file = new URL("../cells.svg", import.meta.url);
const {points, triangles} = bodiesInThePlane();
const size = 0.6 * meanEdgeOf(points, triangles);
const chosen = triangleInTheMiddle(points, triangles);
const one = stepInThePlane(points, triangles, size).each[chosen];
const [width, height] = [18.5, 10.6];
const short = (v) => Number(v.toFixed(3)).toString();

const lines = [];
for (let x = 0; x <= width; x += size) lines.push(`M${short(x)} 0V${height}`);
for (let y = 0; y <= height; y += size) lines.push(`M0 ${short(y)}H${width}`);
const path = (corners) => `M${corners.map((c) => points[c].map(short).join(" ")).join("L")}Z`;
const looked = new Set(one.found);
const dots = (wanted, radius) => points.filter((_, i) => looked.has(i) === wanted)
                                     .map(([x, y]) => `<circle cx="${short(x)}" cy="${short(y)}" r="${radius}"/>`)
                                     .join("");

const text = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="740" height="424">
<style>@media (prefers-color-scheme:dark){svg{filter:invert(.92)hue-rotate(180deg)}}</style>
<rect width="${width}" height="${height}" fill="#fff"/>
<rect x="${short(one.low[0] * size)}" y="${short(one.low[1] * size)}" width="${
    short(
        (one.high[0] - one.low[0] + 1) * size
    )}" height="${short((one.high[1] - one.low[1] + 1) * size)}" fill="#1f6fb2" opacity="0.25"/>
<path d="${lines.join("")}" fill="none" stroke="#5d6670" stroke-width="0.025" opacity="0.7"/>
<path d="${triangles.map(path).join("")}" fill="#1f6fb2" fill-opacity="0.12" stroke="#1f6fb2" stroke-width="0.035"/>
<path d="${path(triangles[chosen])}" fill="#1f6fb2" fill-opacity="0.75"/>
<g fill="#5d6670">${dots(false, 0.08)}</g>
<g fill="#c4540a">${dots(true, 0.17)}</g>
</svg>
`;
if (process.argv[2] === "--check") {
  if (readFileSync(file, "utf8") !== text) {
    console.error("docs/cells.svg is not what docs/site/draw_cells.js draws");
    process.exit(1);
  }
} else {
  writeFileSync(file, text);
}
