#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws pipelines: draw.py SEED COUNT KERNELS.sk OUT.sk OUT.hpp writes them as StreamKernel, and, for each, a C++ function that
makes the same calls one by one."""
import pathlib
import random
import sys

# A kernel: its parameters, where `v` is a value, `x` an element, `g` a gather and `o` an output.
KERNELS = {"lift": "xo", "scale": "vxo", "mixed": "xxo", "split": "xoo", "blur": "go", "edge": "gxo", "placed": "xo"}
FOLDS = ["total", "largest"]
LOCALS = ["a", "b", "c"]
OUTPUTS = ["r", "s"]


class Draw:
    def __init__(self, source, number):
        self.source, self.number = source, number
        self.written = []
        self.calls = []
        for _ in range(source.randint(3, 9)):
            self.call(None)
        for output in OUTPUTS:
            if output not in self.written:
                self.call(output)
        self.folds = source.sample(FOLDS, source.randint(0, 2))
        for fold in self.folds:
            self.calls.append((fold, [self.read(), f"{fold}Of"]))
        self.calls = self.needed()

    def needed(self):
        """The calls without those that write what nothing reads."""
        live, kept = set(OUTPUTS), []
        for kernel, arguments in reversed(self.calls):
            kinds = KERNELS.get(kernel, "x")
            outputs = {a for a, kind in zip(arguments, kinds) if kind == "o"}
            if kernel not in FOLDS and not outputs & live:
                continue
            live = (live - outputs) | {a for a, kind in zip(arguments, kinds) if kind in "xg"}
            kept.append((kernel, arguments))
        return kept[::-1]

    def read(self):
        return self.source.choice(["x", "y"] + self.written)

    def call(self, output):
        kernel = self.source.choice(list(KERNELS) if output is None else ["lift", "blur", "mixed"])
        free = LOCALS + OUTPUTS
        arguments = []
        for kind in KERNELS[kernel]:
            if kind == "v":
                arguments.append(self.source.choice(["k", "0.5f * k", "1 - k"]))
            elif kind == "o":
                name = output if output is not None else self.source.choice([n for n in free if n not in arguments[-1:]])
                arguments.append(name)
            else:
                arguments.append(self.read())
        outputs = [a for a, kind in zip(arguments, KERNELS[kernel]) if kind == "o"]
        if len(set(outputs)) < len(outputs):
            return
        self.calls.append((kernel, arguments))
        self.written += [name for name in outputs if name not in self.written]

    def parameters(self):
        return ", ".join(["float k, float x<>, float y<>, out float r<>, out float s<>"]
                         + [f"reduce float {f}Of<>{' = 0' if f == 'total' else ''}" for f in self.folds])

    def locals(self):
        return [n for n in LOCALS if any(n in arguments for _, arguments in self.calls)]

    def sk(self):
        lines = [f"pipeline void drawn{self.number}({self.parameters()}) {{"]
        if self.locals():
            lines.append("  float " + ", ".join(f"{n}<>" for n in self.locals()) + ";")
        lines += [f"  {kernel}({', '.join(arguments)});" for kernel, arguments in self.calls]
        return "\n".join(lines + ["}", ""])

    def cpp(self):
        lines = [f"inline void calls{self.number}([[maybe_unused]] sk::Device& device, Fields& f) {{"]
        lines += [f"  Field {n} = device.stream<float>(f.x.shape());" for n in self.locals()]
        for kernel, arguments in self.calls:
            named = [a if a in LOCALS else a[:-1] + "f.k" if a.endswith("k") else "f." + a for a in arguments]
            lines.append(f"  {kernel}({', '.join(named)});")
        return "\n".join(lines + ["}", ""])

    def row(self):
        folds = ", ".join(f"f.{name}Of" for name in self.folds)
        more = ", " + folds if folds else ""
        return (f"    {{[](sk::Device&, Fields& f) {{ drawn{self.number}(f.k, f.x, f.y, f.r, f.s{more}); }},\n"
                f"     calls{self.number}}},")


def main():
    seed, count, kernels, sk, cpp = sys.argv[1:]
    source = random.Random(int(seed))
    drawn = [Draw(source, number) for number in range(int(count))]
    text = pathlib.Path(kernels).read_text().split("// One kernel:")[0]
    pathlib.Path(sk).write_text("namespace drawn {\n" + text + "\n".join(d.sk() for d in drawn) + "}\n")
    pathlib.Path(cpp).write_text(
        "// Written by draw.py.\n#pragma once\n\n#include <array>\n\n#include \"drawn_pipelines.sk.hpp\"\n\nnamespace drawn {\n\n"
        "using Field = sk::Stream<float>;\n\nstruct Fields {\n  float k;\n  Field x, y, r, s, totalOf, largestOf;\n};\n\n"
        + "\n".join(d.cpp() for d in drawn)
        + "\nstruct Pair {\n  void (*asPipeline)(sk::Device&, Fields&);\n  void (*asCalls)(sk::Device&, Fields&);\n};\n\n"
        f"inline const std::array<Pair, {count}> pairs{{{{\n" + "\n".join(d.row() for d in drawn) + "\n}};\n\n}  // namespace drawn\n")


if __name__ == "__main__":
    main()
