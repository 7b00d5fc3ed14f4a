# SPDX-License-Identifier: MIT
#
# shadow_test.py PROGRAM FILTER MPIRUN [OPTION...]: a test of ranks passes with a shadow, too, on two ranks, and leaves one report of both.
import json
import os
import subprocess
import sys
import tempfile

program, wanted, *mpirun = sys.argv[1:]


def fail(message):
    sys.exit(f"broken: {message}")


with tempfile.TemporaryDirectory() as place:
    report = os.path.join(place, "report.json")
    run = subprocess.run([*mpirun, "-n", "2", program, wanted], cwd=place, capture_output=True, text=True,
                         env=os.environ | {"SK_SHADOW": f"{report},given=list"})
    if run.returncode != 0:
        fail(f"status {run.returncode}\n{run.stdout}{run.stderr}")
    if "SK_SHADOW" in run.stderr:
        fail(run.stderr)
    with open(report) as file:
        told = json.load(file)
    if told["ended"] != "normally" or told["ranks"] != 2:
        fail(f"the report ended {told['ended']}, with {told['ranks']} ranks")
    if os.listdir(place) != ["report.json"]:
        fail(f"the run leaves {os.listdir(place)}")
    followed = [kernel["name"] for kernel in told["kernels"] if kernel["followed"] > 0]
    if not followed or told["followed"] < told["calls"] // 2:
        fail(f"{told['followed']} of {told['calls']} calls are followed")
    # Each rank is compared with its own reference, whose halos carry the other's: floats explain the errors.
    far = [kernel["name"] for kernel in told["kernels"] if not kernel["total"]["largest"] < 1e-3]
    if far:
        fail(f"far from the reference: {far}; {told['verdicts']}")
    if not told["given"]:
        fail("nothing is given")
    print(f"{len(followed)} kernels, {told['calls']} calls, {len(told['given'])} parameters")
