#!/usr/bin/env python3
"""Drawings of docs/headset.md: `docs/draw.py OUT` writes OUT/controls/*.svg, one for each family of controllers,
from the bindings in xr/bindings.cpp, and OUT/overlap.svg. `docs/draw.py docs` renews those of this folder."""

import pathlib
import re
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent

# What people call an input, by its binding path. A new one needs a name here.
WORDS = {
    "input/select/click": "select",
    "input/trigger/value": "trigger",
    "input/squeeze/value": "squeeze",
    "input/squeeze/click": "squeeze",
    "input/squeeze/force": "squeeze, by force",
    "input/thumbstick": "stick",
    "input/trackpad": "pad, pressed",
    "input/menu/click": "menu",
    "input/y/click": "Y",
    "input/b/click": "B",
    "input/x/click": "X",
    "input/a/click": "A",
    "input/primary/click": "primary button",
    "input/secondary/click": "secondary button",
    "input/back/click": "back",
    "input/view/click": "view",
    "input/dpad_down/click": "D-pad down",
    "input/shoulder/click": "shoulder",
    "input/cluster_front_logitech/click": "front button",
    "input/cluster_middle_logitech/force": "middle button",
    "input/cluster_back_logitech/click": "back button",
    "input/select/value": "pinch",
    "input/aim_activate_ext/value": "pinch",
    "input/grasp_ext/value": "fist",
}

WIDTH, HEIGHT, HAND_X, TEXT_X = 1400, 310, (580, 820), (490, 910)
SHAPE = 'stroke="#444" stroke-width="2"'


def read_profiles():
    """(path, trigger, squeeze, stick, stick_click, stick_press, (menu left, menu right), (play left, play right),
    haptic) of each row of kProfiles, or None."""
    text = (ROOT / "xr" / "bindings.cpp").read_text()
    values = dict(re.findall(r'\*?(k\w+) = ("[^"]*")', text))
    values |= dict(re.findall(r"\b(k\w+)\{((?:\"[^\"]*\"|nullptr), (?:\"[^\"]*\"|nullptr))\}", text))
    table = re.sub(r"//[^\n]*", "", text[text.index("kProfiles[] = {") + len("kProfiles[] = {") :])
    profiles = []
    for row in re.findall(r"\{((?:[^{}]|\{[^{}]*\})*)\}", table[: table.index("};\n")]):
        words = re.findall(r'"[^"]*"|\w+', re.sub(r"\bk[A-Z]\w*", lambda match: values[match.group()], row))
        path, _, trigger, squeeze, stick, click, press, left, right, play_left, play_right, haptic = (
            None if w == "nullptr" else w.strip('"') for w in words
        )
        profiles.append((path, trigger, squeeze, stick, click, press, (left, right), (play_left, play_right), haptic))
    return profiles


def label(side, y, part_x, part_y, text):
    """At its side's margin, with a line to a part of the controller."""
    outwards, x = (1, -1)[side == 0], TEXT_X[side]
    anchor = "end" if side == 0 else "start"
    return (
        f'  <path d="M{x - 4 * outwards} {y - 5} L{HAND_X[side] + part_x} {part_y}" stroke="#888" fill="none"/>\n'
        f'  <text x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>\n'
    )


def draw_side(profile, side):
    """Parts lie mirrored on the two sides; x grows towards the middle between them."""
    _, trigger, squeeze, stick, click, press, menus, plays, haptic = profile
    inwards, x, is_hand = (-1, 1)[side == 0], HAND_X[side], haptic is None
    svg = ""
    if is_hand:
        svg += f'  <rect x="{x - 32}" y="120" width="64" height="76" rx="24" fill="#e8eaee" {SHAPE}/>\n'
        for finger in range(4):
            y, height = (62, 66) if finger in (1, 2) else (74, 54)
            svg += f'  <rect x="{x - 31 + 16 * finger}" y="{y}" width="13" height="{height}" rx="6" fill="#e8eaee" {SHAPE}/>\n'
        svg += f'  <rect x="{x + inwards * 32 - 20}" y="112" width="40" height="14" rx="7" fill="#d89f9f" {SHAPE}/>\n'
    else:
        svg += f'  <rect x="{x - 34}" y="60" width="68" height="150" rx="30" fill="#e8eaee" {SHAPE}/>\n'
    svg += f'  <text x="{x}" y="30" text-anchor="middle" font-weight="bold">{("left", "right")[side]}</text>\n'
    if trigger:
        if not is_hand:
            svg += f'  <rect x="{x - 18}" y="46" width="36" height="16" rx="6" fill="#d89f9f" {SHAPE}/>\n'
        place = (92, inwards * 32, 112) if is_hand else (58, -inwards * 18, 54)
        svg += label(side, *place, WORDS[trigger] + ": click; away from the panel, teleport")
    if stick:
        is_pad = click is not None
        svg += f'  <circle cx="{x}" cy="{130 if is_pad else 94}" r="{24 if is_pad else 13}" fill="#9fb6d8" {SHAPE}/>\n'
        what = ": walk, or teleport" if side == 0 else ": turn, rise and sink"
        if press:
            what += ("; pressed in: the previous viewpoint", "; pressed in: the next viewpoint")[side]
        svg += label(side, *((134, 0, 124) if is_pad else (98, 0, 94)), WORDS[stick] + what)
    if menus[side]:
        is_above = click is not None  # of the pad
        y = 88 if is_above else 122
        svg += f'  <circle cx="{x - inwards * 12}" cy="{y}" r="7" fill="#d8c79f" {SHAPE}/>\n'
        svg += label(side, 98 if is_above else 134, -inwards * 12, y, WORDS[menus[side]] + ": show or hide the panel")
    if plays[side]:
        svg += f'  <circle cx="{x - inwards * 2}" cy="138" r="7" fill="#c4b5d8" {SHAPE}/>\n'
        svg += label(side, 154, -inwards * 2, 138, WORDS[plays[side]] + ": pause or play; held: the other scene")
    if squeeze:
        if not is_hand:
            svg += f'  <rect x="{x - inwards * 32 - 9}" y="146" width="18" height="40" rx="6" fill="#a9d89f" {SHAPE}/>\n'
        svg += label(side, 178, -inwards * (26 if is_hand else 32), 166, WORDS[squeeze] + ": hold the scene, or the panel")
    return svg


def draw_controls(out):
    families = {}
    for profile in read_profiles():
        families.setdefault(profile[1:8], []).append(profile)
    out.mkdir(parents=True, exist_ok=True)
    for profiles in families.values():
        svg = (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="15" fill="#222">\n'
            f'  <rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>\n'
        )
        svg += draw_side(profiles[0], 0) + draw_side(profiles[0], 1)
        if profiles[0][2]:
            svg += f'  <text x="{WIDTH // 2}" y="246" text-anchor="middle">both: the scene follows the hands, turns and grows</text>\n'
        for line, names in enumerate(textwrap.wrap(", ".join(profile[0] for profile in profiles), 150, break_on_hyphens=False)):
            svg += f'  <text x="{WIDTH // 2}" y="{280 + 18 * line}" text-anchor="middle" font-size="12" fill="#666">{names}</text>\n'
        svg += "</svg>\n"
        vendor, name = profiles[0][0].split("/")
        (out / f"{name if name != 'controller' else vendor + '_' + name}.svg").write_text(svg)


# In periods: how long the program and the device work on a frame, and how long before its display xrWaitFrame
# returns.
PROGRAM, DEVICE, LEAD = 0.4, 0.7, 2.0
LEFT, PERIOD_PX, ROW_PX, SHOWN = 90.0, 46.0, 22.0, 16


def play(in_flight):
    """((program begins, ends), (device begins, ends), is late) of each frame, if the program waits until fewer than
    `in_flight` frames are in flight."""
    frames, program, device = [], 0.0, 0.0
    for turn in range(SHOWN):
        if turn >= in_flight:
            program = max(program, frames[turn - in_flight][1][1])
        begin = max(program, turn)
        program = begin + PROGRAM
        start = max(program, device)
        device = start + DEVICE
        frames.append(((begin, program), (start, device), device > turn + LEAD))
    return frames


def draw_rows(title, in_flight, top):
    svg = f'<text x="8" y="{top - 8:.0f}" font-weight="bold">{title}</text>\n'
    svg += f'<text x="8" y="{top + 15:.0f}">program</text>\n<text x="8" y="{top + ROW_PX + 15:.0f}">device</text>\n'
    for turn in range(SHOWN + 2):
        svg += f'<path d="M{LEFT + PERIOD_PX * turn:.1f} {top - 2:.0f}V{top + 2 * ROW_PX + 2:.0f}" stroke="#ccc"/>\n'
    for index, (*parts, is_late) in enumerate(play(in_flight)):
        for row, (begin, end) in enumerate(parts):
            if end > SHOWN + 1:
                continue
            x, width, y = LEFT + PERIOD_PX * begin, PERIOD_PX * (end - begin), top + ROW_PX * row
            fill = "#d9534f" if is_late else ("#4a7fb5", "#9dbfe0")[index % 2]
            svg += f'<rect x="{x:.1f}" y="{y + 2:.0f}" width="{width - 1:.1f}" height="18" fill="{fill}"/>\n'
            svg += f'<text x="{x + 2:.1f}" y="{y + 15:.0f}" fill="#fff" font-size="10">{index}</text>\n'
    return svg


def draw_overlap(path):
    svg = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="900" height="230" font-family="sans-serif" font-size="12">\n'
        '<rect width="900" height="230" fill="#fff"/>\n'
        '<text x="8" y="18">The program works 40 % of a period for each frame, the device 70 %. Lines: a period each, '
        "when xrWaitFrame may return. Red: late.</text>\n"
    )
    svg += draw_rows("as the viewer does: it waits for the frame before the last", 2, 60.0)
    svg += draw_rows("if it waited for each frame before it ended it", 1, 155.0)
    path.write_text(svg + "</svg>\n")


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: docs/draw.py OUT")
    draw_controls(pathlib.Path(sys.argv[1]) / "controls")
    draw_overlap(pathlib.Path(sys.argv[1]) / "overlap.svg")


if __name__ == "__main__":
    main()
