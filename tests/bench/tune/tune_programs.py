#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tunes five programs on one device: tune_programs.py BIN OUT --device gpu [--scale 4] [--budget 60s] [--programs heat,cloth].

BIN has sk, lattice, solve and cloth. For each program, sk tune searches from the program as it is, and from everything in doubles
(double.toml), and verifies what it finds on other inputs. Then the program runs with the file and without it in turns, for --longer times as
many steps; the times are those that the program prints of itself. OUT gets the files, the reports, the charts if gnuplot is there, and results.json; table.txt has the rows
of docs/accuracy.md.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
UNITS = {"us": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0}


def lattice(width, height, steps):
    """The commands of a lattice: on the scene of its name, on the unseen one, and on the first for longer."""

    def commands(name, scale, longer):
        size = f"{int(width * scale)}x{int(height * scale)}"
        return [["lattice", str(HERE / f"{scene}.toml"), "--size", size, "--steps", str(count), "--no-account"]
                for scene, count in ((name, steps), (f"{name}_unseen", steps), (name, steps * longer))]

    return commands


def solve(name, scale, longer):
    """Poisson's equation in space, and one that is stretched."""
    n = int(64 * scale)
    rest = ["--preconditioner", "none", "--tolerance", "1e-5", "--most", "4000"]
    first = ["solve", f"poisson:{n}x{n}x{n}", *rest]
    return [first, ["solve", f"poisson:{n}x{n}x{n // 2}:1,2,1", *rest], first]


def cloth(name, scale, longer):
    points = str(int(384 * scale) + 1)
    rest = ["--points", points, points, "--no-compare", "--check", "1"]
    return [["cloth", str(HERE / f"{scene}.toml"), *rest, "--steps", str(100 * count)]
            for scene, count in (("cloth", 1), ("cloth_unseen", 1), ("cloth", longer))]


def results(*names_and_tolerances):
    """Options for results, each with its tolerance of the relative L2 norm."""
    pairs = zip(names_and_tolerances[::2], names_and_tolerances[1::2])
    return [word for name, tolerance in pairs for word in ("--result", f"{name}=l2:{tolerance}")]


# Which results count, and how exact they must be: from the program as it is, and from doubles. Boiling is chaotic: cells that are
# about to boil do so or not, whatever the rounding. A cloth moves by millimetres in a metre, so that its tolerances are smaller.
PROGRAMS = {
    "heat": (lattice(1024, 1024, 200), results("lattice::temperature", "1e-2"), results("lattice::temperature", "1e-5")),
    "reaction": (lattice(1024, 1024, 100), results("lattice::u", "1e-2", "lattice::v", "1e-2"),
                 results("lattice::u", "1e-4", "lattice::v", "1e-4")),
    "boiling": (lattice(1024, 640, 100), results("lattice::temperature", "2e-3"), results("lattice::temperature", "2e-3")),
    "gradients": (solve, ["--allow-decisions", *results("linear::x", "1e-3")], ["--allow-decisions", *results("linear::x", "1e-4")]),
    "cloth": (cloth, results("cloth::p", "1e-5", "cloth::d", "1e-2"), results("cloth::p", "1e-6", "cloth::d", "1e-3")),
}


def seconds_of(text):
    """What the program prints of its own time: "in 2.6 s"."""
    found = re.search(r" in ([\d.e+-]+) (us|ms|s|min)$", text, re.M)
    return float(found[1]) * UNITS[found[2]] if found else None


def timed(command, environment, rounds):
    """The program's own seconds with each environment, in turns."""
    times = [[] for _ in environment]
    for _ in range(rounds):
        for own, variables in zip(times, environment):
            done = subprocess.run(command, capture_output=True, text=True, env=os.environ | variables)
            own.append(seconds_of(done.stdout))
    return times


def tune(name, start, arguments):
    """Searches from one start. Returns a row of the table."""
    commands, *tolerances = PROGRAMS[name]
    seen, unseen, long = [[str(arguments.bin / words[0]), *words[1:]] for words in commands(name, arguments.scale, arguments.longer)]
    run = f"{name}_{start}"
    out = arguments.out / run
    environment = {"SK_DEVICE": arguments.device, "SK_CACHE": str(arguments.out / "cache")}
    if start == "double":
        environment["SK_CONFIG"] = str(HERE / "double.toml")
    words = [str(arguments.bin / "sk"), "tune", *tolerances[start == "double"], "--any-status", "--budget", arguments.budget,
             "-o", f"{out}.toml", "--json", f"{out}.json", "--verify", " ".join(unseen)]
    if shutil.which("gnuplot"):
        words += ["--chart", f"{out}.svg"]
    began = time.monotonic()
    done = subprocess.run([*words, "--", *seen], capture_output=True, text=True, env=os.environ | environment)
    out.with_suffix(".txt").write_text(done.stdout + done.stderr)
    row = {"program": name, "start": start, "command": " ".join(seen), "unseen": " ".join(unseen), "status": done.returncode,
           "searched": time.monotonic() - began, "failure": done.stderr.strip().splitlines()[-1:] if done.returncode else []}
    if not pathlib.Path(f"{out}.json").exists():
        return row
    report = json.loads(pathlib.Path(f"{out}.json").read_text())
    row |= {key: report[key] for key in ("device", "timeRatio", "asItIs", "tuned", "evidence", "verified", "complete", "results")}
    kept = next((file for file in (f"{out}.toml", f"{out}.toml.rejected") if pathlib.Path(file).exists()), None)
    if kept and report["tuned"]["setting"]:
        plain = {"SK_CONFIG": environment.get("SK_CONFIG", "")}
        row["plain"], row["with"] = timed(long, [environment | plain, environment | {"SK_CONFIG": kept}], arguments.rounds)
    return row


def text_of(row):
    """A row of the table in docs/accuracy.md."""
    head = f"| {row['program']} from {row['start']} | {row.get('device', '')} |"
    if "tuned" not in row:
        return f"{head} {' '.join(row['failure'])} |"
    worst = lambda verdict: max(verdict["errors"], key=lambda each: each["ofTolerance"] or 0, default=None)
    error = worst(row["tuned"])
    tolerance = ", ".join(sorted({f"{each['tolerance']:g}" for each in row["results"]}))
    choices = "; ".join(f"`{each['name']}`: {each['key']} {each['value']}" for each in row["tuned"]["setting"]) or "nothing"
    holds = all(each["holds"] for each in row["verified"])
    unseen = max((each["tuned"]["ofTolerance"] or 0 for each in row["verified"]), default=0)
    ratio = "1"
    if "plain" in row and None not in row["plain"] + row["with"]:
        ratios = sorted(plain / own for plain, own in zip(row["plain"], row["with"]))
        ratio = f"{statistics.median(ratios):.2f} ({ratios[0]:.2f} to {ratios[-1]:.2f})"
    seconds = statistics.median(row["asItIs"]["seconds"])
    return (f"{head} {tolerance} | {error['error']:.2g} of {error['result']} | {1 / row['timeRatio']:.2f} | {ratio} | {choices} | "
            f"{'yes' if holds else 'no'}, {unseen:.2g} of the tolerance | kernels {seconds:.3g} s, "
            f"search {row['searched']:.0f} s{'' if row['complete'] else ', ended by the budget'} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("out", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--device", required=True)
    parser.add_argument("--scale", type=float, default=1)
    parser.add_argument("--longer", type=int, default=1)
    parser.add_argument("--budget", default="60s")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--programs", type=lambda text: text.split(","), default=list(PROGRAMS))
    parser.add_argument("--starts", type=lambda text: text.split(","), default=["single", "double"])
    parser.add_argument("--until", type=float, default=float("inf"), help="seconds after which no search begins")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    rows, began = [], time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)  # programs may write pictures
        for start in arguments.starts:
            for name in arguments.programs:
                if time.monotonic() - began > arguments.until:
                    print(f"no time is left for {name} from {start}", flush=True)
                    continue
                rows.append(tune(name, start, arguments))
                print(text_of(rows[-1]), flush=True)
                (arguments.out / "results.json").write_text(json.dumps(rows, indent=1))
                (arguments.out / "table.txt").write_text("".join(text_of(row) + "\n" for row in rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
