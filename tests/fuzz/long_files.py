#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes the files of the corpus that are too long to keep: long_files.py FOLDER makes FOLDER/PARSER/FILE of each."""
import math
import pathlib
import random
import sys


def star():
    """A polygon of 600 corners, every second one of which is a random way in."""
    radii = random.Random(3)
    lines = []
    for i in range(600):
        angle = 2 * math.pi * i / 600
        radius = 1 if i % 2 else radii.uniform(0.1, 0.9)
        lines.append(f"v {radius * math.cos(angle):.5g} {radius * math.sin(angle):.5g} 0")
    lines.append("f " + " ".join(str(i + 1) for i in range(600)))
    return lines


FILES = {
    "cloth_scene/many_long_pins.toml": ["[cloth]", "points = [32768, 1]"] + ["[[pin]]", 'edge="top"'] * 4800,
    "mesh/star.obj": star(),
    "table/wide_and_long.csv": ["\0" + "," * 8000] + ["1"] * 8000,
}

for name, lines in FILES.items():
    file = pathlib.Path(sys.argv[1], name)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("".join(line + "\n" for line in lines))
