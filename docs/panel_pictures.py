#!/usr/bin/env python3
"""Pictures of the viewer's panel, its pages and states, as docs/headset.md shows them: `docs/panel_pictures.py build/release/bin/binosplat docs/panel`.

Each is the panel's part of the viewer's window on a display without a screen (Xvfb), beside the simulated headset, which a script
brings into the state; frames go by the clock. A state lasts until the picture has been taken, but for the one in which the scene loads."""

import collections
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import zlib

LAST = "rate 30\nsize 64 64\nframes none\n"
LEFT_AWAY = "controller left 0 position -0.2 1.2 -0.35 turn 0 -80\n"
# Opens the page of scenes, and pulls the trigger on Next scene once.
NEXT_SCENE = (
    "controller right 0 position 0.2 1.2 -0.35 look -0.535 1.765 -0.887\npress right trigger 4 7\n"
    "controller right 8 position 0.2 1.2 -0.35 look -0.535 1.765 -0.887\n"
    "controller right 9 position 0.2 1.2 -0.35 look -0.516 1.384 -0.854\npress right trigger 11 14\n" + LEFT_AWAY
)
# Pulls the trigger on the button of another page; x and z of where that is.
PAGE = "controller right 0 position 0.2 1.2 -0.35 look {0} 1.765 {1}\npress right trigger 4 7\n" + LEFT_AWAY
# Holds the trigger on Recentre.
PRESSED = ("controller right 0 position 0.2 1.2 -0.35 look -0.609 1.619 -0.834\npress right trigger 4 400\n"
           + LEFT_AWAY)
STATES = {
    "scenes": ("room2.ply --load-first", LAST + PAGE.format(-0.535, -0.887)),
    "method": ("room2.ply --load-first", LAST + PAGE.format(-0.447, -0.931)),
    "help": ("room2.ply --load-first", LAST + PAGE.format(-0.359, -0.975)),
    "loading": ("builtin:atelier", LAST),
    "scene": ("builtin:fence --load-first", LAST),
    "headset_off": ("builtin:fence --load-first", LAST + "at 3 worn off\n"),
    "lost": ("builtin:fence --load-first", LAST + "at 3 head off\n"),
    "other": ("builtin:fence --load-first", LAST + "at 3 should-render off\n"),
    "gone": ("builtin:fence --load-first", LAST + "no-headset-for 100000 after-loss\nat 3 lose-session\n"),
    "replaced": ("builtin:fence --load-first", LAST + "at 12 lose-session\n"),
    "pressed": ("builtin:fence --load-first", LAST + PRESSED),
    "beaten": ("builtin:fence --load-first --config view.toml", "rate 90\nsize 1000 1000\nframes none\n"),
    "held": ("builtin:one-splat --load-first --config view.toml", "rate 11\nsize 1000 1000\nframes none\n"),
    "failed": ("a.ply --load-first", LAST + NEXT_SCENE),
}
SCENES = ("room2.ply", "Комната.ply", "חדר השינה.ply", "غرفة الجلوس.ply", "हिन्दी कक्षा.ply", "森林小屋.ply")
SEEN = (*SCENES[2:], SCENES[0])
BUILT_IN = ("fence", "step-edge", "slanted-wall")
SCREEN = (1400, 800)
EYE_PX = 720  # the window shows an eye of this size, and the panel beside it
PANEL_PX = (EYE_PX * 768 // 960, EYE_PX)
PATIENCE_S, LOADS_S, SETTLES_S = 120, 1.5, 20


def screen_rows(path):
    """An X window dump of 32 bits a pixel, as Xvfb keeps it: rows of (red, green, blue)."""
    with open(path, "rb") as file:
        data = file.read()
    head = struct.unpack(">25I", data[:100])
    start = head[0] + 12 * head[19]
    for y in range(head[5]):
        row = data[start + y * head[12] : start + (y + 1) * head[12]]
        yield [(row[4 * x + 2], row[4 * x + 1], row[4 * x]) for x in range(head[4])]


def shows_window(path):
    """The screen is black but for a mouse until the window is there."""
    with open(path, "rb") as file:
        data = file.read()
    return len(data) - data.count(0) > PANEL_PX[0] * PANEL_PX[1]


def write_png(path, rows):
    """With a palette of the most frequent colours that differ; each other one becomes the nearest of these."""
    counts = collections.Counter(pixel for row in rows for pixel in row)

    def distance(one, other):
        return sum((a - b) ** 2 for a, b in zip(one, other))

    colours, index = [], {}
    for pixel, _ in counts.most_common():
        nearest = min(range(len(colours)), key=lambda i: distance(pixel, colours[i]), default=None)
        if len(colours) < 256 and (nearest is None or distance(pixel, colours[nearest]) > 60):
            nearest = len(colours)
            colours.append(pixel)
        index[pixel] = nearest
    raw = b"".join(b"\0" + bytes(index[pixel] for pixel in row) for row in rows)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 3, 0, 0, 0)))
        file.write(chunk(b"PLTE", b"".join(bytes(colour) for colour in colours)))
        file.write(chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def look_at_some(program, work):
    """So that the page has pictures of scenes that were shown before, and a favourite."""
    with open(os.path.join(work, "seen.script"), "w") as file:
        file.write("rate 30\nsize 160 120\nframes none\n")
    environment = dict(os.environ, XDG_CONFIG_HOME=os.path.join(work, ".config"), DISPLAY="", WAYLAND_DISPLAY="")
    for scene_file in SEEN:
        command = [program, "view", scene_file, "--load-first", "--hide-panel", "--frames", "40", "--simulate", "seen.script"]
        subprocess.run(command, cwd=work, env=environment, check=True, stdout=subprocess.DEVNULL)
    with open(os.path.join(work, ".config", "binosplat", "favourite-scenes.txt"), "w") as file:
        file.write(os.path.join(work, SCENES[-1]) + "\n")
    shutil.rmtree(os.path.join(work, "out"), ignore_errors=True)


def take(program, folder, name, scene, script):
    with tempfile.TemporaryDirectory(prefix="binosplat-") as work:
        with open(os.path.join(work, "state.script"), "w") as file:
            file.write(script)
        for number, scene_file in enumerate(SCENES if name == "scenes" else ("a.ply", SCENES[0])):
            kind = BUILT_IN[number % len(BUILT_IN)]
            subprocess.run([program, "scene", kind, "--out", scene_file], cwd=work, check=True, stdout=subprocess.DEVNULL)
        if name == "scenes":
            look_at_some(program, work)
        with open(os.path.join(work, "view.toml"), "w") as file:
            file.write('[view]\nquality = "fast"\n')
        if name == "failed":
            with open(os.path.join(work, "b.ply"), "w") as file:
                file.write("ply\nformat ascii 1.0\nelement vertex many\n")
        size = "{}x{}x24".format(*SCREEN)
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", "1", "-screen", "0", size, "-fbdir", work], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        )
        viewer = None
        try:
            display = ":" + server.stdout.readline().decode().strip()
            environment = dict(os.environ, DISPLAY=display, XDG_CONFIG_HOME=os.path.join(work, ".config"))
            environment.pop("WAYLAND_DISPLAY", None)
            command = [program, "view", *scene.split(), "--simulate", "state.script"]
            viewer = subprocess.Popen(command, cwd=work, env=environment, stdout=subprocess.DEVNULL)
            # Until the window is there, and then as long as the script takes to bring the state.
            end = time.monotonic() + PATIENCE_S
            while time.monotonic() < end and not shows_window(os.path.join(work, "Xvfb_screen0")):
                time.sleep(0.02)
            time.sleep(LOADS_S if name == "loading" else SETTLES_S)
            rows = list(screen_rows(os.path.join(work, "Xvfb_screen0")))
            # Without a window manager a window begins in the screen's corner.
            part = [row[EYE_PX : EYE_PX + PANEL_PX[0]] for row in rows[: PANEL_PX[1]]]
            write_png(os.path.join(folder, f"{name}.png"), part)
        finally:
            for process in (viewer, server):
                if process is not None:
                    process.terminate()
                    process.wait()


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, folder = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    for name in sys.argv[3:] or STATES:
        take(program, folder, name, *STATES[name])


if __name__ == "__main__":
    main()
