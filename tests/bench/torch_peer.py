#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Times the programs of sk_race in PyTorch, on a GPU where there is one: torch_peer.py --json FILE.

The same problems in the same sizes, each result checked against doubles before it is timed. The JSON has the form of
sk_race's, so that report.py puts both in one table. Where PyTorch has no operation for a program, it is composed of those
that there are; torch.compile is tried where that fuses them, and counts as a contender of its own.
"""
import argparse
import json
import math
import os
import platform
import re
import statistics
import sys
import time

import torch

DEVICE = torch.device("cuda" if torch.cuda.is_available() else "cpu")


def finish():
    if DEVICE.type == "cuda":
        torch.cuda.synchronize()


def grid(log2):
    return 1 << (log2 // 2), 1 << (log2 - log2 // 2)


def numbers(*shape, seed, low=0.0, high=1.0):
    generator = torch.Generator().manual_seed(seed)
    return (low + (high - low) * torch.rand(*shape, generator=generator)).to(DEVICE)


def padded(u):
    return torch.nn.functional.pad(u[None, None], (1, 1, 1, 1), mode="replicate")[0, 0]


def relative_error(result, expected):
    difference = (result.double() - expected).abs().max().item()
    return difference / max(expected.abs().max().item(), 1e-300)


class Work:
    """What one problem needs: `run` computes it from tensors that are there; `check` gives the error of its result. `moves`: where
    that is all there is to do, a function that copies as many bytes."""

    def __init__(self, run, check, tolerance, compiles=False, moves=None):
        self.run, self.check, self.tolerance, self.compiles, self.moves = run, check, tolerance, compiles, moves


def copy_of(count):
    """Copies so many floats: what it reads and writes are 8 bytes each."""
    source = numbers(count, seed=1)
    target = torch.empty_like(source)
    return lambda: target.copy_(source)


def saxpy(log2):
    x, y = numbers(1 << log2, seed=1), numbers(1 << log2, seed=2)
    r = torch.empty_like(x)
    run = lambda: torch.add(y, x, alpha=2.5, out=r)
    return Work(run, lambda result: relative_error(result, y.double() + 2.5 * x.double()), 2 ** -22,
                moves=copy_of(3 * x.numel() // 2))


def total(log2):
    x = numbers(1 << log2, seed=1)
    # To a number of the host's, as ours.
    return Work(lambda: x.sum().item(), lambda result: abs(result / x.double().sum().item() - 1), 1e-3)


def dot(log2):
    x, y = numbers(1 << log2, seed=1), numbers(1 << log2, seed=2)
    expected = lambda: (x.double() @ y.double()).item()
    return Work(lambda: (x @ y).item(), lambda result: abs(result / expected() - 1), 1e-3)


def residual(log2):
    q, r = numbers(1 << log2, seed=1), numbers(1 << log2, seed=2)
    rn = torch.empty_like(r)
    expected = lambda: torch.square(r.double() - 0.75 * q.double()).sum().item()

    def run():
        torch.sub(r, q, alpha=0.75, out=rn)
        return rn @ rn

    return Work(run, lambda result: abs(result.item() / expected() - 1), 1e-3)


def five_points(u):
    p = padded(u)
    return u + 0.2 * (p[1:-1, :-2] + p[1:-1, 2:] + p[:-2, 1:-1] + p[2:, 1:-1] - 4 * u)


def nine_points(u):
    p = padded(u)
    corners = p[:-2, :-2] + p[:-2, 2:] + p[2:, :-2] + p[2:, 2:]
    sides = p[:-2, 1:-1] + p[1:-1, :-2] + p[1:-1, 2:] + p[2:, 1:-1]
    return (corners + 2 * sides + 4 * u) / 16


def stencil(function):
    def work(log2):
        u = numbers(*grid(log2), seed=1)
        return Work(lambda f=function: f(u), lambda result: relative_error(result, function(u.double())), 2 ** -21,
                    compiles=(function, u), moves=copy_of(u.numel()))
    return work


def gemv(log2):
    rows, columns = grid(log2)
    a, x = numbers(rows, columns, seed=1), numbers(columns, seed=2)
    return Work(lambda: a @ x, lambda result: relative_error(result, a.double() @ x.double()), 1e-5)


def gemm(log2):
    rows, columns = grid(log2)
    a, b = numbers(rows, columns, seed=1), numbers(columns, columns, seed=2)
    return Work(lambda: a @ b, lambda result: relative_error(result, a.double() @ b.double()), 1e-5)


def scan(log2):
    x = (numbers(1 << log2, seed=1, high=4)).to(torch.int32)
    run = lambda: torch.cumsum(x, 0, dtype=torch.int32)  # inclusive, which is the same work
    return Work(run, lambda result: (result.long() - torch.cumsum(x.long(), 0)).abs().max().item(), 0)


def compaction(log2):
    x = numbers(1 << log2, seed=1, low=-1)
    run = lambda: torch.masked_select(x, x > 0)
    return Work(run, lambda result: float(result.cpu().tolist() != [v for v in x.cpu().tolist() if v > 0]), 0)


def sort(log2):
    keys = numbers(1 << log2, seed=1, low=-1000, high=1000)
    run = lambda: torch.sort(keys).values
    def check(result):
        expected = torch.sort(keys.double().cpu()).values
        return (result.double().cpu() - expected).abs().max().item()
    return Work(run, check, 0)


def sort_pairs(log2):
    keys = numbers(1 << log2, seed=1, low=-1000, high=1000)
    values = 2 * keys
    def run():
        order = torch.sort(keys, stable=True)
        return values[order.indices]
    def check(result):
        expected = torch.sort(values.double().cpu()).values
        return (result.double().cpu() - expected).abs().max().item()
    return Work(run, check, 0)


def bodies(log2):
    n = 1 << log2
    position, mass = numbers(n, 3, seed=1), numbers(n, seed=2)

    def attract(position, mass):
        way = position[None] - position[:, None]
        nearness = torch.rsqrt((way * way).sum(-1) + 1e-3)
        return ((mass * nearness ** 3)[..., None] * way).sum(1)
    return Work(lambda: attract(position, mass),
                lambda result: relative_error(result, attract(position.double(), mass.double())), 1e-4)


def fourier(log2):
    parts = numbers(1 << log2, 2, seed=1, low=-1, high=1)
    x = torch.view_as_complex(parts)
    def check(result):
        expected = torch.fft.fft(x.to(torch.complex128))
        return ((result - expected).abs().max() / expected.abs().max()).item()
    return Work(lambda: torch.fft.fft(x), check, 1e-5)


def advance(u, v):
    def lap(a):
        return (torch.roll(a, 1, 0) + torch.roll(a, -1, 0) + torch.roll(a, 1, 1) + torch.roll(a, -1, 1)) - 4 * a
    reaction = u * v * v
    return u + 0.16 * lap(u) - reaction + 0.04 * (1 - u), v + 0.08 * lap(v) + reaction - (0.04 + 0.06) * v


def ten_steps(u, v):
    for _ in range(10):
        u, v = advance(u, v)
    return u, v


def reaction(log2):
    u, v = numbers(*grid(log2), seed=1), numbers(*grid(log2), seed=2)
    check = lambda result: max(relative_error(a, b) for a, b in zip(result, ten_steps(u.double(), v.double())))
    return Work(lambda: ten_steps(u, v), check, 1e-5, compiles=(ten_steps, u, v))


def product(starts, columns, values, tolerance, moves=None):
    """A matrix in compressed rows, times a vector, by cuSPARSE on a GPU."""
    n = starts.numel() - 1
    x = numbers(n, seed=2)
    a = torch.sparse_csr_tensor(starts.int(), columns.int(), values, (n, n))
    def check(result):
        expected = torch.zeros(n, dtype=torch.double, device=DEVICE)
        rows = torch.repeat_interleave(torch.arange(n, device=DEVICE), starts[1:] - starts[:-1])
        expected.index_add_(0, rows, values.double() * x.double()[columns])
        return relative_error(result, expected)
    return Work(lambda: a @ x, check, tolerance, moves=moves)


def starts_of(entries):
    return torch.cat([torch.zeros(1, dtype=torch.long, device=DEVICE), torch.cumsum(entries, 0)])


def spread(starts, width, first):
    """Columns: one in each of the parts, as many as the row has entries, of `width` columns from `first` of each row on."""
    entries = starts[1:] - starts[:-1]
    rows = torch.repeat_interleave(torch.arange(entries.numel(), device=DEVICE), entries)
    part = width // entries[rows]
    number = torch.arange(int(starts[-1]), device=DEVICE) - starts[rows]
    place = (numbers(int(starts[-1]), seed=4) * part).long().minimum(part - 1)
    return first[rows] + number * part + place


def sparse(log2):
    n = 1 << log2
    starts = starts_of(8 + (numbers(n, seed=3) * 17).long().clamp(max=16))
    width = min(4096, n)
    first = (torch.arange(n, device=DEVICE) - width // 2).clamp(0, n - width)
    return product(starts, spread(starts, width, first), numbers(int(starts[-1]), seed=1), 1e-5)


def power_law(log2):
    n = 1 << log2
    lengths = (4 * (1 - numbers(n, seed=5).double()) ** (-1 / 1.2)).clamp(max=min(n, 1 << 16)).long()
    starts = starts_of(lengths)
    columns = spread(starts, n, torch.zeros(n, dtype=torch.long, device=DEVICE))
    return product(starts, columns, numbers(int(starts[-1]), seed=1), 1e-4)


def five_diagonals(log2):
    """Where the neighbours of each element of a grid are, in compressed rows, and which of five numbers is whose."""
    rows, columns = grid(log2)
    n = rows * columns
    i = torch.arange(n, device=DEVICE)
    x, y = i % columns, i // columns
    true = torch.ones_like(i, dtype=torch.bool)
    inside = torch.stack([y > 0, x > 0, true, x + 1 < columns, y + 1 < rows], 1)
    places = i[:, None] + torch.tensor([-columns, -1, 0, 1, columns], device=DEVICE)
    return starts_of(inside.sum(1)), places[inside], inside


def five_point_matrix(log2):
    starts, columns, inside = five_diagonals(log2)
    return product(starts, columns, numbers(5 << log2, seed=1).view(-1, 5)[inside], 1e-5,
                   moves=copy_of(7 * (1 << log2) // 2))


def gradient_steps(n):
    return 16 if n > 1 << 20 else 128


def gradients(log2):
    """Iterations of conjugate gradients for Poisson's equation, without a question to the device."""
    n = 1 << log2
    steps = gradient_steps(n)
    starts, columns, inside = five_diagonals(log2)
    values = torch.tensor([-1.0, -1.0, 4.0, -1.0, -1.0], device=DEVICE).expand(n, 5)[inside]
    b = numbers(n, seed=6)

    def solve(kind):
        a = torch.sparse_csr_tensor(starts.int(), columns.int(), values.to(kind), (n, n))

        def run():
            r = b.to(kind)
            x, p, rr = torch.zeros_like(r), r.clone(), r @ r
            for _ in range(steps):
                q = a @ p
                alpha = rr / (p @ q)
                x.addcmul_(p, alpha)
                r = r.addcmul(q, -alpha)
                rr, before = r @ r, rr
                p = torch.addcmul(r, p, rr / before)
            return x
        return run
    return Work(solve(torch.float), lambda result: relative_error(result, solve(torch.double)()), 1e-2)


def mandelbrot(log2):
    rows, columns = grid(log2)
    real = (-2 + 2.5 / columns * (torch.arange(columns, device=DEVICE) + 0.5))[None].float()
    imaginary = (-1.25 + 2.5 / rows * (torch.arange(rows, device=DEVICE) + 0.5))[:, None].float()

    def escape(real, imaginary):
        x = torch.zeros((rows, columns), device=DEVICE, dtype=real.dtype)
        y, steps = torch.zeros_like(x), torch.zeros((rows, columns), device=DEVICE, dtype=torch.int32)
        for _ in range(256):
            inside = x * x + y * y <= 4
            steps += inside
            x, y = torch.where(inside, x * x - y * y + real, x), torch.where(inside, 2 * x * y + imaginary, y)
        return steps
    check = lambda result: (result != escape(real.double(), imaginary.double())).double().mean().item()
    return Work(lambda: escape(real, imaginary), check, 0.05)


def gradients_work(n):
    steps = gradient_steps(n)
    return 23 * n * steps, 32 * n * steps


# Program, element, sizes, operations and bytes of n elements (as programs.cpp has them), work.
PROGRAMS = [
    ("saxpy", "floats", (12, 16, 20, 24, 26, 28), lambda n: (2 * n, 12 * n), saxpy),
    ("sum", "floats", (12, 16, 20, 24, 26, 28), lambda n: (n, 4 * n), total),
    ("dot", "floats", (12, 16, 20, 24), lambda n: (2 * n, 8 * n), dot),
    ("folded output", "floats", (12, 16, 20, 24), lambda n: (4 * n, 12 * n), residual),
    ("5-point stencil", "floats", (12, 16, 20, 24, 26, 28), lambda n: (6 * n, 8 * n), stencil(five_points)),
    ("9-point stencil", "floats", (12, 16, 20, 24), lambda n: (11 * n, 8 * n), stencil(nine_points)),
    ("mandelbrot", "pixels", (12, 16, 20), lambda n: (0, 4 * n), mandelbrot),
    ("sgemv", "elements", (12, 16, 20, 24), lambda n: (2 * n, 4 * n), gemv),
    ("sgemm", "elements", (12, 16, 20), lambda n: (2 * n * math.sqrt(n), 12 * n), gemm),
    ("prefix scan", "ints", (12, 16, 20, 24), lambda n: (n, 8 * n), scan),
    ("compaction", "floats", (12, 16, 20, 24), lambda n: (n, 6 * n), compaction),
    ("sort", "floats", (12, 16, 20, 24), lambda n: (n * math.log2(n), 8 * n), sort),
    ("sort of pairs", "floats", (12, 16, 20, 24), lambda n: (n * math.log2(n), 16 * n), sort_pairs),
    ("n-body", "bodies", (10, 12, 14), lambda n: (20 * n * n, 28 * n), bodies),
    ("fft", "complex numbers", (12, 16, 20), lambda n: (5 * n * math.log2(n), 16 * n), fourier),
    ("gray-scott", "elements", (12, 16, 20), lambda n: (240 * n, 160 * n), reaction),
    ("sparse matrix", "rows", (12, 16, 20), lambda n: (32 * n, 140 * n), sparse),
    ("power-law matrix", "rows", (20,), lambda n: (40 * n, 172 * n), power_law),
    ("5-point matrix", "rows", (24,), lambda n: (10 * n, 28 * n), five_point_matrix),
    ("conjugate gradients", "unknowns", (16, 24), gradients_work, gradients),
]


def samples(run, rounds, sample_seconds):
    """Seconds for doing it once, round by round, by the wall clock around as many as fill a sample."""
    run()
    finish()
    start = time.perf_counter()
    run()
    finish()
    times = max(1, min(10000, round(sample_seconds / max(time.perf_counter() - start, 1e-6))))
    seconds = []
    for _ in range(rounds):
        start = time.perf_counter()
        for _ in range(times):
            run()
        finish()
        seconds.append((time.perf_counter() - start) / times)
    return seconds


def contenders(work, compiled):
    """Name, what it runs, and whether that computes the result."""
    yield "PyTorch", work.run, True
    if work.moves:
        yield "copy", work.moves, False
    if compiled and work.compiles:
        function, *tensors = work.compiles
        fused = torch.compile(function)
        yield "torch.compile", lambda: fused(*tensors), True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", metavar="FILE", required=True)
    parser.add_argument("--filter", default=".*", help="a regular expression: programs whose names it is found in")
    parser.add_argument("--sizes", help="logarithms to base 2: 12,16,20")
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--sample", type=float, default=20, help="milliseconds of a round")
    parser.add_argument("--compile", action="store_true", help="torch.compile of what it may fuse, too (slow to start)")
    arguments = parser.parse_args()
    torch.backends.cuda.matmul.allow_tf32 = False  # floats are floats
    runs, absent = [], []
    for program, element, sizes, work_of, make in PROGRAMS:
        if not re.search(arguments.filter, program):
            continue
        for log2 in [int(size) for size in arguments.sizes.split(",")] if arguments.sizes else sizes:
            operations, size = work_of(2.0 ** log2)
            try:
                work = make(log2)
                for name, run, computes in contenders(work, arguments.compile):
                    error = work.check(run()) if computes else 0
                    if not error <= work.tolerance:
                        raise ValueError(f"its error is {error:.3g}, more than {work.tolerance:.3g}")
                    seconds = samples(run, arguments.rounds, arguments.sample / 1000)
                    print(f"{program:16} 2^{log2:<3} {name:14} {1e3 * statistics.median(seconds):10.4g} ms", flush=True)
                    runs.append({"program": program, "log2": log2, "element": element, "operations": operations,
                                 "bytes": size, "contender": name, "ours": False, "seconds": seconds})
            except (RuntimeError, ValueError) as error:
                why = str(error).splitlines()[0]
                print(f"{program:16} 2^{log2:<3} PyTorch is left out: {why}", flush=True)
                absent.append({"program": program, "log2": log2, "contender": "PyTorch", "why": why,
                               "wrong": isinstance(error, ValueError)})
            if DEVICE.type == "cuda":
                torch.cuda.empty_cache()
    name = torch.cuda.get_device_name() if DEVICE.type == "cuda" else ""
    with open(arguments.json, "w", encoding="utf-8") as file:
        json.dump({"machine": {"processor": platform.processor() or platform.machine(), "threads": os.cpu_count(),
                               "renderer": name}, "runs": runs, "absent": absent}, file, indent=1)
    return 1 if any(entry["wrong"] for entry in absent) else 0


if __name__ == "__main__":
    sys.exit(main())
