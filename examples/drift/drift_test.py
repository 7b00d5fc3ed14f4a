# SPDX-License-Identifier: MIT
#
# drift_test.py PROGRAM DEVICE CONFIGURATION: the heat balance of the foil is off, SK_SHADOW names the kernel that is to blame, and
# the factored form mends it, as a configuration file does that computes the kernel in doubles.
import json
import os
import re
import subprocess
import sys
import tempfile

program, device, configuration = os.path.realpath(sys.argv[1]), sys.argv[2], os.path.realpath(sys.argv[3])
folder = tempfile.TemporaryDirectory()


def run(*arguments, **variables):
    """The percentage that the foil loses more than it gains, and what the program says."""
    environment = {**os.environ, "SK_DEVICE": device, "SK_SHADOW": "", "SK_CONFIG": "", **variables}
    done = subprocess.run([program, "--size", "32", *arguments], capture_output=True, text=True, cwd=folder.name, env=environment)
    assert done.returncode == 0 and done.stderr == "", done
    assert os.path.exists(os.path.join(folder.name, "drift.png")), done.stdout
    found = re.search(r"^energy balance: it loses (\S+) % (more|less) than it gains$", done.stdout, re.M)
    sign = 1 if found[2] == "more" else -1
    return sign * float(found[1]), done.stdout[done.stdout.index("the beam"):]


def verdict(*arguments):
    _, said = run(*arguments, SK_SHADOW="report.html")
    with open(os.path.join(folder.name, "report.json")) as file:
        report = json.load(file)
    assert not report["notes"], report["notes"]
    return report["verdicts"][0], said


off, said = run()
assert 0.2 < off < 1, said
first, beside = verdict()
assert beside == said, f"a shadow changes what the program computes: {beside}"
assert (first["kind"], first["kernel"]) == ("error", "drift::radiate"), first

off, said = run("--mended")
assert abs(off) < 1e-3, said
first, _ = verdict("--mended")
assert first["kind"] == "fine", first

off, said = run(SK_CONFIG=configuration)
assert abs(off) < 1e-3, said
