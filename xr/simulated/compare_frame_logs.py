#!/usr/bin/env python3
"""Compares two runs of a program on the simulated OpenXR runtime: their frame logs, and on request their pictures.

    compare_frame_logs EXPECTED ACTUAL [--tolerance 1e-5] [--ignore KEY]... [--pictures STEPS [--share SHARE]]

EXPECTED and ACTUAL are folders that SIMULATED_OPENXR_OUT named, or the frames.jsonl in them. Exit code 0: they agree; 1: they differ, and the
first differences are printed; 2: one of them cannot be read. Nothing but Python is needed.
"""
import argparse
import json
import math
import pathlib
import struct
import sys
import zlib

MOST_SHOWN = 20


class Unreadable(Exception):
    pass


def read_log(place):
    path = place / "frames.jsonl" if place.is_dir() else place
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise Unreadable(f"{path}: cannot be read ({error})")
    frames = []
    for number, line in enumerate(lines, 1):
        try:
            frames.append(json.loads(line))
        except (ValueError, RecursionError) as error:
            raise Unreadable(f"{path}:{number}: not a line of JSON ({error})")
        if not isinstance(frames[-1], dict):
            raise Unreadable(f"{path}:{number}: not a frame, must be an object of JSON")
    return frames


def differences(expected, actual, tolerance, ignored, place=""):
    """Yields a line for each value that differs."""
    if isinstance(expected, dict) and isinstance(actual, dict):
        for key in list(expected) + [key for key in actual if key not in expected]:
            if key in ignored:
                continue
            inside = f"{place}.{key}" if place else key
            if key not in actual:
                yield f"{inside} is missing"
            elif key not in expected:
                yield f"{inside} is new"
            else:
                yield from differences(expected[key], actual[key], tolerance, ignored, inside)
    elif isinstance(expected, list) and isinstance(actual, list):
        if len(expected) != len(actual):
            yield f"{place} has {len(actual)} entries, expected {len(expected)}"
        for index, (one, other) in enumerate(zip(expected, actual)):
            yield from differences(one, other, tolerance, ignored, f"{place}[{index}]")
    elif is_number(expected) and is_number(actual):
        if not (expected == actual or abs(expected - actual) <= tolerance):
            yield f"{place} is {actual}, expected {expected}"
    elif expected != actual:
        yield f"{place} is {json.dumps(actual)}, expected {json.dumps(expected)}"


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def read_png(path):
    """Width, height and bytes of 8-bit RGB, which is what the runtime writes."""
    data = path.read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise Unreadable(f"{path}: not a PNG file")
    packed, place, header = b"", 8, None
    while place + 8 <= len(data):
        length, kind = struct.unpack(">I4s", data[place : place + 8])
        body = data[place + 8 : place + 8 + length]
        if kind == b"IHDR" and len(body) == 13:
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        place += length + 12
    if header is None or header[2:] != (8, 2, 0, 0, 0):
        raise Unreadable(f"{path}: not 8-bit RGB")
    width, height = header[:2]
    try:
        raw = zlib.decompress(packed)
        if len(raw) != height * (3 * width + 1):
            raise Unreadable(f"{path}: broken (not of its size)")
        return width, height, unfilter(raw, width, height)
    except (zlib.error, IndexError) as error:
        raise Unreadable(f"{path}: broken ({error})")


def unfilter(raw, width, height):
    row_bytes, rows, before = 3 * width, [], bytearray(3 * width)
    for y in range(height):
        start = y * (row_bytes + 1)
        kind, row = raw[start], bytearray(raw[start + 1 : start + 1 + row_bytes])
        for i in range(row_bytes if kind else 0):
            left, up = row[i - 3] if i >= 3 else 0, before[i]
            corner = before[i - 3] if i >= 3 else 0
            guess = (0, left, up, (left + up) // 2, paeth(left, up, corner))[kind]
            row[i] = (row[i] + guess) & 255
        rows.append(bytes(row))
        before = row
    return b"".join(rows)


def paeth(left, up, corner):
    guess = left + up - corner
    return min((left, up, corner), key=lambda one: abs(guess - one))


def picture_difference(expected, actual, steps, share):
    """None if they agree."""
    if not actual.exists():
        return f"{actual.name} is missing"
    (width, height, one), (other_width, other_height, other) = read_png(expected), read_png(actual)
    if (width, height) != (other_width, other_height):
        return f"{actual.name} is {other_width}x{other_height}, expected {width}x{height}"
    if one == other:
        return None
    squares, off = 0, 0
    for pixel in range(0, len(one), 3):
        worst = max(abs(one[pixel + c] - other[pixel + c]) for c in range(3))
        squares += sum((one[pixel + c] - other[pixel + c]) ** 2 for c in range(3))
        off += worst > steps
    if off <= share * width * height:
        return None
    psnr = 10 * math.log10(255 * 255 * len(one) / squares)
    return f"{actual.name} is off by more than {steps} in {off} of {width * height} pixels (PSNR {psnr:.1f} dB)"


def picture_differences(expected, actual, steps, share):
    names = sorted(path.name for path in expected.glob("frame_*.png"))
    if not names:
        yield f"{expected} has no pictures to compare with"
    for name in names:
        difference = picture_difference(expected / name, actual / name, steps, share)
        if difference is not None:
            yield difference
    for path in sorted(actual.glob("frame_*.png")):
        if path.name not in names:
            yield f"{path.name} is new"


def log_differences(expected, actual, tolerance, ignored):
    for number, (one, other) in enumerate(zip(expected, actual), 1):
        place = f"frame {one['frame']}" if "frame" in one else f"line {number}"
        for line in differences(one, other, tolerance, ignored):
            yield f"{place}: {line}"
    if len(expected) != len(actual):
        yield f"{len(actual)} lines, expected {len(expected)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("expected", type=pathlib.Path)
    parser.add_argument("actual", type=pathlib.Path)
    parser.add_argument("--tolerance", type=float, default=1e-5, help="by which numbers may be off (default 1e-5)")
    parser.add_argument("--ignore", action="append", default=["swapchain", "picture"], metavar="KEY",
                        help="a key that does not count, such as events (swapchain and picture never do)")
    parser.add_argument("--pictures", type=int, metavar="STEPS", help="compare the pictures, too; each channel may be off by STEPS of 255")
    parser.add_argument("--share", type=float, default=0.0, help="of a picture's pixels that may be off by more (default 0)")
    options = parser.parse_args()
    found = []
    try:
        found += log_differences(read_log(options.expected), read_log(options.actual), options.tolerance, set(options.ignore))
        if options.pictures is not None:
            found += picture_differences(options.expected, options.actual, options.pictures, options.share)
    except (Unreadable, OSError) as error:
        print(f"compare_frame_logs: {error}", file=sys.stderr)
        return 2
    for line in found[:MOST_SHOWN]:
        print(line)
    if len(found) > MOST_SHOWN:
        print(f"... and {len(found) - MOST_SHOWN} more")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
