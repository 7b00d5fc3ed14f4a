# SPDX-License-Identifier: MIT
#
# drift_test.py PROGRAM DEVICE SOURCE [SK]: the heat balance of the foil is off, SK_SHADOW names the kernel that is to blame, and the
# factored form mends it, as a configuration file does that computes the kernel in doubles. With SK, docs/accuracy.md quotes what the
# program and `sk shadow` print, times aside.
import json
import os
import re
import subprocess
import sys
import tempfile

program, device, source = os.path.realpath(sys.argv[1]), sys.argv[2], os.path.realpath(sys.argv[3])
sk = os.path.realpath(sys.argv[4]) if len(sys.argv) > 4 else None
size = [] if sk else ["--size", "32"]  # documents quote the usual size
configuration = os.path.join(source, "examples/drift/radiate.toml")
folder = tempfile.TemporaryDirectory()
with open(os.path.join(source, "docs/accuracy.md")) as file:
    document = file.read()


def run(*arguments, **variables):
    """The percentage that the foil loses more than it gains, and what the program says."""
    environment = {**os.environ, "SK_DEVICE": device, "SK_SHADOW": "", "SK_CONFIG": "", **variables}
    done = subprocess.run([program, *size, *arguments], capture_output=True, text=True, cwd=folder.name, env=environment)
    assert done.returncode == 0 and done.stderr == "", done
    assert os.path.exists(os.path.join(folder.name, "drift.png")), done.stdout
    found = re.search(r"^energy balance: it loses (\S+) % (more|less) than it gains$", done.stdout, re.M)
    sign = 1 if found[2] == "more" else -1
    return sign * float(found[1]), done.stdout[done.stdout.index("the beam"):]


def quoted(name):
    """The lines of the block of docs/accuracy.md behind <!-- NAME -->."""
    return document.split(f"<!-- {name} -->\n```text\n")[1].split("```")[0].splitlines()


def timeless(text):
    """The lines of a text without times and the room that they take."""
    return [re.sub(r" +", " ", re.sub(r"[\d.]+ (us|ms|s)\b", "", line)) for line in text.splitlines()]


def check_document(said, off, texts):
    """What docs/accuracy.md quotes: of the program, of `sk shadow`, and for each way to run the program the imbalance and the first line."""
    for line in quoted("sk program drift"):
        assert line in said.splitlines(), f"docs/accuracy.md quotes '{line}', not of:\n{said}"
    for (balance, text) in zip(off, texts):
        assert f"| {balance:.5f} % | {text} |" in document, f"docs/accuracy.md has no row with {balance:.5f} % and {text}"


def check_shadow():
    done = subprocess.run([sk, "shadow", "report.json"], capture_output=True, text=True, check=True, cwd=folder.name)
    for line in timeless("\n".join(quoted("sk shadow of drift"))):
        assert line in timeless(done.stdout), f"docs/accuracy.md quotes '{line}', not of:\n{done.stdout}"


def verdict(*arguments, every=1, **variables):
    off, said = run(*arguments, SK_SHADOW=f"report.html,every={every}", **variables)
    with open(os.path.join(folder.name, "report.json")) as file:
        report = json.load(file)
    assert not report["notes"], report["notes"]
    return off, report["verdicts"][0], said


plain, first, beside = verdict()
assert 0.2 < plain < 1, beside
assert (first["kind"], first["kernel"]) == ("error", "drift::radiate"), first
if sk:
    check_shadow()
    _, said = run()
    assert beside == said, f"a shadow changes what the program computes: {beside}"

mended, cured, _ = verdict("--mended", every=1000)  # what is read is always compared
raised, high, _ = verdict(every=1000, SK_CONFIG=configuration)
for off, line in ((mended, cured), (raised, high)):
    assert abs(off) < 1e-3 and line["kind"] == "fine", (off, line)
if sk:
    check_document(said, (plain, mended, raised), (first["text"], cured["text"], high["text"]))
