"""Needs python3-numpy and python3-pil. Draws docs/results/seen.png: seen_strip.py OUT.png FULL,BUDGET,BOUND...
Each argument names three folders of `render --path`, of one walk: in full, at a budget, and within a bound. The places are those where the budget is off most."""
import sys

import numpy as np
from PIL import Image

FRAME, PLACE_PX, SCALE, PLACES = "000025", 48, 4, 3
EYES = ("left", "right")


def read(folder, eye):
    return Image.open(f"{folder}/frame_{FRAME}_{eye}.png").convert("RGB")


def worst_places(full, other):
    """Corners of the places whose error is greatest, in the left eye, none beside another."""
    difference = np.asarray(read(full, "left"), float) - np.asarray(read(other, "left"), float)
    rows, columns = (length // PLACE_PX for length in difference.shape[:2])
    errors = (difference[: rows * PLACE_PX, : columns * PLACE_PX] ** 2).reshape(rows, PLACE_PX, columns, PLACE_PX, 3).mean((1, 3, 4))
    taken = []
    for place in np.argsort(-errors.ravel()):
        y, x = divmod(int(place), columns)
        if all(abs(x - a) + abs(y - b) >= 3 for a, b in taken):
            taken.append((x, y))
        if len(taken) == PLACES:
            return [(x * PLACE_PX, y * PLACE_PX) for x, y in taken]


step = PLACE_PX * SCALE + 4
walks = [argument.split(",") for argument in sys.argv[2:]]
strip = Image.new("RGB", (6 * step + 12, PLACES * len(walks) * step), "white")
for walk, folders in enumerate(walks):
    for row, (x, y) in enumerate(worst_places(folders[0], folders[1])):
        for column, (folder, eye) in enumerate((folder, eye) for folder in folders for eye in EYES):
            place = read(folder, eye).crop((x, y, x + PLACE_PX, y + PLACE_PX)).resize((PLACE_PX * SCALE,) * 2, Image.NEAREST)
            strip.paste(place, (column * step + column // 2 * 6, (walk * PLACES + row) * step))
strip.save(sys.argv[1], optimize=True)
