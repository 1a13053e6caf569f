#!/usr/bin/env python3
"""Which room may include which: `.ci/arrows.py` lists what goes against it, and ends with 1 then.

A room is a folder, with those in it that have no line of their own. What it sees is on its right; tests see everything. No room sees one that
sees it, but for the viewer's, which are one here."""

import pathlib
import re
import subprocess
import sys

ROOMS = {
    "shaders/shared": "",
    "shaders": "shaders/shared",
    "xr/simulated/files": "",
    "xr/simulated": "xr/simulated/files",
    "engine": "",  # errors, platforms, poses and eyes, modes
    "engine/setup": "engine xr/simulated/files",
    "engine/picture": "engine shaders/shared",
    "engine/scene": "engine engine/picture",
    "engine/web": "engine engine/scene",
    "engine/reference": "engine engine/scene",
    "engine/gpu": "engine engine/scene shaders shaders/shared",
    "engine/passes": "engine engine/gpu shaders/shared",
    "engine/frame": "engine engine/gpu engine/passes engine/picture",
    "engine/library": "engine engine/scene engine/picture engine/gpu engine/frame",
    "engine/stability": "engine engine/scene engine/reference engine/frame",
    "xr": "engine engine/gpu shaders/shared",
    "app": "engine engine/* xr shaders",
}


def room_of(path):
    fitting = [room for room in ROOMS if path.startswith(room + "/")]
    return max(fitting, key=len, default=None)


def sees(room, other):
    return any(other == one or (one.endswith("/*") and other.startswith(one[:-1])) for one in ROOMS[room].split())


def main():
    wrong = []
    listed = subprocess.run(["git", "ls-files", "*.h", "*.cpp"], capture_output=True, text=True, check=True).stdout.split()
    for path in listed:
        room = room_of(path)
        if room is None or not pathlib.Path(path).exists():
            continue
        for included in re.findall(r'^#include "([^"]+)"', pathlib.Path(path).read_text(), re.MULTILINE):
            other = room_of(included)
            if other is not None and other != room and not sees(room, other):
                wrong.append(f"{path}: {room} does not see {other} ({included})")
    for line in wrong:
        print(line)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
