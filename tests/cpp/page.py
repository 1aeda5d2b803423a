"""usage: page.py PAGE OUT: a program of the C++ blocks of a page, one after the other."""

import re
import sys

BEGIN = """#include <vox/vox_cell_size.hpp>
#include "cpp/scene.hpp"
#include <cstdio>
static std::uint64_t hits;
static double depth;
static const Scene scene;
static const std::vector<float>& xyz = scene.a;
static const std::vector<std::uint32_t>& tets = scene.tets;
int main() {
"""
END = """    const bool right = hits > 0 && depth > 0 && best > 0.9 && best < 1.1 && kept.size() > 0 && a != b;
    std::puts(right ? "all blocks ran" : "a block computed something else");
}
"""

with open(sys.argv[1], encoding="utf-8") as page:
    text = page.read()
blocks = re.findall(r"^```cpp\n(.*?)^```$", text, flags=re.S | re.M)
if not blocks:
    sys.exit(f"{sys.argv[1]} holds no C++")
with open(sys.argv[2], "w", encoding="utf-8") as program:
    program.write(BEGIN + "\n".join(blocks) + END)
