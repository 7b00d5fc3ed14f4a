# SPDX-License-Identifier: MIT
#
# Tries all 2^32 floats as arguments of functions, natively and on llvmpipe, and keeps what it finds in exhaustive.json, from which
# the tests repeat the worst arguments. Takes minutes for each function and profile. Usage: exhaustive.py SK [FUNCTION ...]
import json
import pathlib
import subprocess
import sys
import tempfile

PLACES = [("native", ""), ("software", "glsl330"), ("software", "glsl430"), ("software", "essl300")]
KEPT = 4  # worst arguments
FILE = pathlib.Path(__file__).parent / "exhaustive.json"


def record_of(found):
    """What is kept of a record of `sk accuracy --exhaustive`."""
    keys = ("function", "profile", "every", "arguments", "largest", "not_nearest")
    record = {key: found[key] for key in keys}
    record["worst"] = [{"x": one["x"]["hex"], "got": one["got"]["hex"], "error": one["error"]} for one in found["worst"][:KEPT]]
    return record


def merged(old, new):
    """Replaces the records of a function and a profile, unless they had more arguments."""
    records = {(one["function"], one["profile"]): one for one in old}
    for one in new:
        key = (one["function"], one["profile"])
        if key not in records or records[key]["arguments"] <= one["arguments"]:
            records[key] = one
    return [records[key] for key in sorted(records)]


def write(records):
    lines = ",\n".join("  " + json.dumps(record) for record in records)
    FILE.write_text(f"[\n{lines}\n]\n")


def run(sk, function, device, profile, every):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "errors.json"
        command = [sk, "accuracy", "--exhaustive", function, "--device", device, "--every", str(every), "--json", str(out)]
        subprocess.run(command + (["--profile", profile] if profile else []), check=True)
        return json.loads(out.read_text())["records"]


def main(arguments):
    every = 1
    if len(arguments) > 2 and arguments[1] == "--every":
        every = int(arguments[2])
        del arguments[1:3]
    sk, functions = arguments[0], arguments[1:] or ["all"]
    for function in functions:
        for device, profile in PLACES:
            found = run(sk, function, device, profile, every)
            old = json.loads(FILE.read_text()) if FILE.exists() else []
            write(merged(old, [record_of(one) for one in found]))


if __name__ == "__main__":
    main(sys.argv[1:])
