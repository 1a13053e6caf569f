#!/usr/bin/env python3
"""Which room may include which: `.ci/arrows.py` lists violations, and exits with 1 if there are any.

A room is a folder, including its subfolders that have no line of their own, or the files of one name. The rooms
it sees are on its right and stand above it, so no two rooms see each other; tests see everything. Headers of a
system are for platform_*.cpp, and for the simulated runtime, which shares nothing with the program."""

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
    "engine/scene": "engine",
    "engine/builtin": "engine engine/scene",
    "engine/places": "engine engine/scene",
    "engine/files": "engine engine/picture engine/scene engine/builtin",
    "engine/files/web": "engine engine/files engine/scene",
    "engine/twin": "engine engine/scene",
    "engine/gpu": "engine engine/scene shaders shaders/shared",
    "engine/passes": "engine engine/gpu shaders/shared",
    "engine/baselines": "engine engine/gpu engine/passes shaders/shared",
    "engine/frame": "engine engine/gpu engine/passes engine/baselines engine/picture",
    "engine/levels": "engine engine/files engine/scene engine/places engine/gpu engine/passes shaders/shared",
    "engine/stream": "engine engine/scene engine/builtin engine/files engine/files/web engine/gpu shaders/shared",
    "engine/library": "engine engine/scene engine/builtin engine/places engine/files engine/files/web engine/picture engine/gpu engine/passes engine/frame engine/stream",
    "xr": "engine engine/gpu shaders/shared",
    "app/scores": "engine engine/picture shaders/shared",
    "app/summary": "engine engine/scene",
    "app/axes": "engine engine/passes shaders/shared",
    "app/stability_cases": "engine engine/*",
    "app/terminal": "engine",
    "app/options": "engine engine/* app/scores",
    "app/load": "engine engine/* app/options app/terminal",
    "app/plot": "engine",
    "app/report": "engine engine/* app/options app/plot app/stability_cases",
    "app/view/governor": "engine",
    "app/bench": "engine engine/* app/axes app/load app/options app/plot app/report app/scores app/terminal app/view/governor",
    "app/view/files": "engine engine/frame engine/picture engine/setup",
    "app/view/placement": "engine engine/scene xr",
    "app/view/room": "engine engine/gpu engine/passes xr app/view/placement",
    "app/view/settings": "engine engine/builtin engine/scene engine/setup app/options app/view/governor",
    "app/view/headset": "engine engine/gpu engine/passes xr app/terminal app/view/room",
    "app/view/scenes": "engine engine/* app/load app/options app/terminal app/view/files app/view/placement app/view/settings",
    "app/view/wearer": "engine engine/frame xr app/view/placement app/view/room app/view/settings",
    "app/view/panel": "engine engine/* xr app/options app/report app/view/files app/view/headset app/view/placement app/view/room app/view/scenes app/view/settings app/view/wearer",
    "app/view/window": "engine engine/gpu app/view/panel app/view/placement app/view/room",
    "app/desktop": "engine engine/* app/options app/terminal app/view/files app/view/panel app/view/placement app/view/room app/view/scenes app/view/settings app/view/window",
    "app/view": "engine engine/* shaders xr app/axes app/options app/terminal app/view/* app/desktop",
    "app/command_line": "engine engine/* app/options app/terminal app/view/settings",
    "app": "engine engine/* shaders app/*",
}

SYSTEM_HEADERS = re.compile(
    r"^\s*#\s*include\s*<((?:sys|linux|netinet|arpa)/.*"
    r"|(?:unistd|fcntl|signal|poll|spawn|dirent|dlfcn|pthread|pwd"
    r"|termios|sched|pty|io|process|direct|[Ww]indows)\.h)>", re.MULTILINE)


def room_of(path):
    fitting = [room for room in ROOMS if path.startswith((room + "/", room + "."))]
    return max(fitting, key=len, default=None)


def sees(room, other):
    return any(other == one or (one.endswith("/*") and other.startswith(one[:-1])) for one in ROOMS[room].split())


def main():
    rooms = list(ROOMS)
    wrong = [f"{room} sees {other}, which does not stand above it" for room in rooms for other in rooms[rooms.index(room):] if sees(room, other)]
    listed = subprocess.run(["git", "ls-files", "*.h", "*.cpp"], capture_output=True, text=True, check=True).stdout.split()
    for path in listed:
        room = room_of(path)
        if room is None or not pathlib.Path(path).exists():
            continue
        text = pathlib.Path(path).read_text()
        if not room.startswith("xr/simulated") and not pathlib.Path(path).name.startswith("platform_"):
            wrong += [f"{path}: only platform_*.cpp includes {header}" for header in SYSTEM_HEADERS.findall(text)]
        for included in re.findall(r'^#include "([^"]+)"', text, re.MULTILINE):
            other = room_of(included)
            if other is not None and other != room and not sees(room, other):
                wrong.append(f"{path}: {room} does not see {other} ({included})")
    for line in wrong:
        print(line)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
