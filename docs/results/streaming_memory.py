#!/usr/bin/env python3
"""Memory of a program over time: streaming_memory.py OUT.svg LIMIT_MIB PROGRAM ARGUMENT...

Runs it, reads its resident memory (Linux, VmRSS) four times a second, prints the greatest and the last, and plots all with a line at the
limit. With a software device that is the device's memory, too.
"""
import re
import subprocess
import sys
import time

WIDTH, HEIGHT, LEFT, TOP = 560, 220, 56, 30


def resident_mib(pid):
    try:
        with open(f"/proc/{pid}/status") as status:
            found = re.search(r"VmRSS:\s+(\d+) kB", status.read())
    except OSError:
        found = None
    return int(found.group(1)) / 1024 if found else None


def draw(points, limit):
    seconds, high = points[-1][0], 1.1 * max(limit, max(mib for _, mib in points))

    def place(time_s, mib):
        return LEFT + WIDTH * time_s / seconds, TOP + HEIGHT * (1 - mib / high)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + 20}" height="{TOP + HEIGHT + 44}" font-family="sans-serif" font-size="12">',
           '<rect width="100%" height="100%" fill="#fff"/>', f'<text x="{LEFT}" y="{TOP - 10}" font-weight="bold">resident memory, MiB</text>',
           f'<rect x="{LEFT}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#888"/>']
    for step in range(5):
        mib, time_s = high * step / 4, seconds * step / 4
        out.append(f'<text x="{LEFT - 6}" y="{place(0, mib)[1] + 4:.1f}" text-anchor="end">{mib:.0f}</text>')
        out.append(f'<text x="{place(time_s, 0)[0]:.1f}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{time_s:.0f} s</text>')
    y = place(0, limit)[1]
    out.append(f'<path d="M{LEFT} {y:.1f}h{WIDTH}" stroke="#d55e00" stroke-dasharray="6 4"/><text x="{LEFT + 6}" y="{y - 5:.1f}" fill="#d55e00">limit</text>')
    path = " ".join(f"{'L' if i else 'M'}{x:.1f} {y:.1f}" for i, (x, y) in enumerate(place(*point) for point in points))
    return "\n".join(out + [f'<path d="{path}" fill="none" stroke="#0072b2" stroke-width="2"/>', "</svg>"]) + "\n"


def main():
    picture, limit, *command = sys.argv[1:]
    begin, points = time.monotonic(), []
    program = subprocess.Popen(command)
    while program.poll() is None:
        if (mib := resident_mib(program.pid)) is not None:
            points.append((time.monotonic() - begin, mib))
        time.sleep(0.25)
    print(f"exit code {program.returncode}; at most {max(mib for _, mib in points):.0f} MiB, in the end {points[-1][1]:.0f} MiB, limit {limit} MiB")
    with open(picture, "w") as file:
        file.write(draw(points, float(limit)))


main()
