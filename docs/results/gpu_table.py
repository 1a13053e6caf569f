#!/usr/bin/env python3
"""The table of gpu.md from the kernels.json of several devices: gpu_table.py NAME=kernels.json ...

A row is a kernel, in the worst of its specializations. A cell: vector registers, then what AMD's driver says of waves a SIMD, or Adreno's of
waves a core, or `-`; then what is spilled (on Adreno: instructions that do so) and the bytes of scratch memory a thread, only where that is not
0; then bytes of shared memory, where it is told.
"""
import json
import sys


def first(statistics, *names):
    return next((statistics[name] for name in names if name in statistics), None)


def cell(variants):
    def worst(*names):
        values = [first(v["statistics"], *names) for v in variants]
        return max((v for v in values if v is not None), default=None)

    registers = worst("VGPRs", "Number of GPRs", "Registers used")
    waves = min((w for v in variants if (w := first(v["statistics"], "Subgroups per SIMD", "Max Waves Per Core")) is not None), default=None)
    scalar, vector = worst("Spilled SGPRs") or 0, worst("Spilled VGPRs", "STP Count") or 0
    scratch, shared = worst("Scratch size", "SLM Size") or 0, worst("LDS size")
    parts = [f"{registers}" + (f" / {waves}" if waves is not None else "")]
    if scalar or vector:
        parts.append(f"**spills {scalar} SGPR, {vector} VGPR**")
    if scratch:
        parts.append(f"**scratch {scratch}**")
    return ", ".join(parts), shared


def main():
    devices = [argument.split("=", 1) for argument in sys.argv[1:]]
    kernels = {name: json.load(open(path))["kernels"] for name, path in devices}
    shaders = list(dict.fromkeys(k["shader"] for k in next(iter(kernels.values()))))
    print("| kernel | variants | shared memory, bytes | " + " | ".join(name for name, _ in devices) + " |")
    print("|---|---|---|" + "---|" * len(devices))
    for shader in shaders:
        cells, shared = [], []
        for name, _ in devices:
            text, bytes_ = cell([k for k in kernels[name] if k["shader"] == shader])
            cells.append(text)
            shared += [bytes_] if bytes_ is not None else []
        count = sum(k["shader"] == shader for k in next(iter(kernels.values())))
        print(f"| {shader} | {count} | {max(shared, default='-')} | " + " | ".join(cells) + " |")


main()
