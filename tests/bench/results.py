# SPDX-License-Identifier: MIT
"""Results of benchmarks, read from JSON, and tables of them."""
import json
import math
import statistics


def quartiles(values):
    """The lower quartile, the median and the upper one."""
    if len(values) == 1:
        return values * 3
    return statistics.quantiles(values, n=4, method="inclusive")


class Results:
    """`document` is the JSON of all files as one. A problem is (program, log2 of its size)."""

    def __init__(self, document):
        self.document = document
        self.problems = {}  # problem -> contender -> run, in the order of the files
        for run in document["runs"]:
            self.problems.setdefault((run["program"], run["log2"]), {})[run["contender"]] = run

    def programs(self):
        return list(dict.fromkeys(program for program, _ in self.problems))

    def sizes(self, program):
        return sorted(log2 for name, log2 in self.problems if name == program)

    def ours(self):
        """Our contenders, without the variants of single programs, whose names have a second word."""
        names = dict.fromkeys(run["contender"] for run in self.document["runs"] if run["ours"])
        return [name for name in names if " " not in name]

    def peers(self):
        return list(dict.fromkeys(run["contender"] for run in self.document["runs"] if not run["ours"]))

    def seconds(self, problem, contender):
        """The median of the time, or None."""
        run = self.problems.get(problem, {}).get(contender)
        return statistics.median(run["seconds"]) if run else None

    def ratios(self, problem, ours, peer):
        """Quartiles of the peer's time over ours, or None. In one run, they are of the rounds' ratios: both suffered alike."""
        runs = self.problems.get(problem, {})
        if ours not in runs or peer not in runs:
            return None
        a, b = runs[ours], runs[peer]
        if a["file"] == b["file"] and len(a["seconds"]) == len(b["seconds"]):
            return quartiles([theirs / mine for mine, theirs in zip(a["seconds"], b["seconds"])])
        mine = statistics.median(a["seconds"])
        return [seconds / mine for seconds in quartiles(b["seconds"])]

    def machine_text(self):
        texts = []
        for machine in self.document["machines"]:
            renderer = machine.get("renderer")
            texts.append(f"{machine['threads']} threads of {machine['processor']}" + (f"; {renderer}" if renderer else ""))
        return "Measured on " + ", and on ".join(dict.fromkeys(texts)) + "."


def read(paths):
    """One set of results of several files. Figures of sk_bench ("device" and "results") are kept as they are."""
    document = {"machines": [], "runs": [], "absent": []}
    for number, path in enumerate(paths):
        with open(path, encoding="utf-8") as file:
            part = json.load(file)
        if "results" in part:
            document["device"], document["results"] = part["device"], part["results"]
        document["machines"] += part.get("machines", []) + ([part["machine"]] if "machine" in part else [])
        document["absent"] += part.get("absent", [])
        for run in part.get("runs", []):
            document["runs"].append({**run, "file": (number, run.get("file"))})
    files = {}
    for run in document["runs"]:
        run["file"] = files.setdefault(run["file"], len(files))
    return Results(document)


def three_digits(number):
    """3190, not 3.19e+03."""
    return f"{float(f'{number:.3g}'):g}"


def time_text(seconds):
    for factor, unit in ((1, "s"), (1e3, "ms"), (1e6, "us")):
        if seconds * factor >= 1 or unit == "us":
            return f"{three_digits(seconds * factor)} {unit}"


def ratio_text(value):
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}" if value >= 10 else f"{value:.2f}" if value >= 0.1 else f"{value:.2g}"


def rate_text(run, seconds):
    """Work in a second: operations where they are many for each byte, else bytes."""
    operations, size = run["operations"], run["bytes"]
    if operations > 4 * size:
        return f"{operations / seconds / 1e9:.3g} Gop/s"
    return f"{size / seconds / 1e9:.3g} GB/s"


def rates_table(found):
    """Head and rows: a row for each contender, a column for each program: millions of elements a second at its largest size."""
    programs = found.programs()
    contenders = dict.fromkeys(run["contender"] for run in found.document["runs"])
    rows = []
    for contender in contenders:
        row = [contender]
        for program in programs:
            log2 = found.sizes(program)[-1]
            seconds = found.seconds((program, log2), contender)
            row.append("" if seconds is None else three_digits(2.0 ** log2 / seconds / 1e6))
        rows.append(row)
    return ["M/s"] + programs, rows


def table_of(found, ours, largest_only=False):
    """Head and rows: a row for each problem that `ours` took part in, a column for each peer."""
    peers = [peer for peer in found.peers()
             if any(found.ratios(problem, ours, peer) for problem in found.problems)]
    rows = []
    for program in found.programs():
        there = [log2 for log2 in found.sizes(program) if ours in found.problems[(program, log2)]]
        raced = [log2 for log2 in there if any(found.ratios((program, log2), ours, peer) for peer in peers)] or there
        for log2 in raced[-1:] if largest_only else there:
            problem = (program, log2)
            run, seconds = found.problems[problem][ours], found.seconds(problem, ours)
            row = [program, f"2^{log2} {run['element']}", time_text(seconds), rate_text(run, seconds)]
            for peer in peers:
                ratios = found.ratios(problem, ours, peer)
                row.append("" if ratios is None else
                           f"{ratio_text(ratios[1])} ({ratio_text(ratios[0])}-{ratio_text(ratios[2])})")
            rows.append(row)
    return ["program", "size", ours, "rate"] + peers, rows


def steps_table(found):
    """Of programs that are a step of something: how many of them a second, on a grid of so many cells a side."""
    contenders = found.ours() + [peer for peer in found.peers()
                                 if any(peer in runs for (program, _), runs in found.problems.items() if is_step(program))]
    rows = []
    for program in filter(is_step, found.programs()):
        for log2 in found.sizes(program):
            seconds = [found.seconds((program, log2), name) for name in contenders]
            mine = [name for name in found.ours() if found.seconds((program, log2), name)]
            if not mine:
                continue
            best = min(mine, key=lambda name: found.seconds((program, log2), name))
            ratios = [found.ratios((program, log2), best, peer) for peer in contenders if peer not in found.ours()]
            rows.append([program.removesuffix(" step"), f"{2 ** (log2 // 2)} x {2 ** (log2 - log2 // 2)}"]
                        + [three_digits(1 / s) if s else "" for s in seconds]
                        + [f"{best}: " + ", ".join(ratio_text(r[1]) for r in ratios if r)])
    return ["steps of", "cells"] + [f"{name}, a second" for name in contenders] + ["our best over the peer's"], rows


def is_step(program):
    return program.endswith(" step")


def plain(head, rows):
    """A table for a terminal."""
    widths = [max(len(row[i]) for row in [head] + rows) for i in range(len(head))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in [head] + rows]
    return "\n".join([lines[0], "-" * sum(width + 2 for width in widths)] + lines[1:])


def markdown(head, rows):
    lines = ["| " + " | ".join(row) + " |" for row in [head] + rows]
    lines.insert(1, "|" + "---|" * len(head))
    return "\n".join(lines) + "\n"


def slope(points):
    """The exponent p of y ~ x^p that fits best (least squares of logarithms)."""
    xs = [math.log2(x) for x, _ in points]
    ys = [math.log2(y) for _, y in points]
    x, y = statistics.mean(xs), statistics.mean(ys)
    return sum((a - x) * (b - y) for a, b in zip(xs, ys)) / sum((a - x) ** 2 for a in xs)
