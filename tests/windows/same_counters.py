#!/usr/bin/env python3
"""Whether two report.json count the same: `same_counters.py EXPECTED ACTUAL`. Prints what differs, and ends with 1 then."""

import json
import sys

expected, actual = (json.load(open(name, encoding="utf-8")) for name in sys.argv[1:3])
odd = [f"{key}: {expected['counters'].get(key)} and {actual['counters'].get(key)}"
       for key in sorted(expected["counters"].keys() | actual["counters"].keys())
       if expected["counters"].get(key) != actual["counters"].get(key)]
odd += [f"left out: {text}" for text in set(expected["left_out"]) ^ set(actual["left_out"])]
print("".join(f"    {line}\n" for line in odd), end="")
sys.exit(1 if odd else 0)
