# SPDX-License-Identifier: MIT
"""busy.py SK_RACE [ARGUMENTS]: what native calls take beside as many busy processes as there are processors.

Compares with the quiet machine, with one thread beside the same load, and with OpenMP beside the same load. ARGUMENTS go to sk_race,
such as --sizes 16,20 and --filter."""
import json
import os
import statistics
import subprocess
import sys
import tempfile

race, arguments = sys.argv[1], sys.argv[2:]
if not any(argument.startswith("--sizes") for argument in arguments):
    arguments += ["--sizes", "16,20"]
processors = len(os.sched_getaffinity(0))
SLOWER = 2.5  # at most, than on the quiet machine
beside = " beside load"


def runs(only, environment):
    """(program, log2) -> contender -> the median of its seconds."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "race.json")
        command = [race, "--only", only, "--busy", str(processors), "--json", file, *arguments]
        subprocess.run(command, check=True, stdout=sys.stderr, env={**os.environ, **environment})
        with open(file, encoding="utf-8") as text:
            found = {}
            for run in json.load(text)["runs"]:
                found.setdefault((run["program"], run["log2"]), {})[run["contender"]] = statistics.median(run["seconds"])
            return found


everybody = runs("^(native|OpenMP)$", {})
alone = runs("^native$", {"OMP_NUM_THREADS": "1"})
print(f"Native calls beside {processors} busy processes on {processors} processors")
print("| program | size | quiet | beside load | slower | than one thread beside load | OpenMP beside load, over ours |")
print("|---|---|---|---|---|---|---|")
worst = 0
for (program, log2), of in everybody.items():
    ours = of["native" + beside]
    slower = ours / of["native"]
    worst = max(worst, slower)
    one = alone.get((program, log2), {}).get("native" + beside)
    theirs = of.get("OpenMP" + beside)
    print(f"| {program} | 2^{log2} | {1e6 * of['native']:.4g} us | {1e6 * ours:.4g} us | {slower:.2f} | "
          + (f"{ours / one:.2f}" if one else "-") + " | " + (f"{theirs / ours:.3g}" if theirs else "-") + " |")
print(f"at most {SLOWER} times slower: {'yes' if worst <= SLOWER else 'NO'} ({worst:.2f})")
