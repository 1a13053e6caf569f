#!/usr/bin/env python3
"""Draws docs/results/seen_bad_llvmpipe.svg, two panels of what `bench --motion` plots: seen_bad.py motion.svg OUT.svg"""
import re
import sys

# The panel's title there and here, and where it is moved to.
PANELS = (("builtin:atelier, room, middle: bad tiles", "the built-in room, 20 pixels a degree: bad tiles", -676),
          ("playbot_lod2_2dgs_sh2.ply, near: bad tiles", "a trained scene, near: bad tiles", -26))

plot = open(sys.argv[1]).read()
parts = ["<svg xmlns='http://www.w3.org/2000/svg' width='1330' height='420' viewBox='0 0 1330 420'>",
         re.search(r"<style>.*?</style>", plot).group(), "<rect width='100%' height='100%' fill='white'/>"]
for title, new_title, x in PANELS:
    panel = re.search(rf"<text x='750.0' y='([\d.]+)' class='panel'>{re.escape(title)}</text>.*?(?=<text [^>]*class='panel'|</svg>)", plot, re.S)
    parts += [f"<g transform='translate({x} {22 - float(panel.group(1))})'>", panel.group().replace(title, new_title).rstrip(), "</g>"]
with open(sys.argv[2], "w") as file:
    file.write("\n".join(parts + ["</svg>", ""]))
