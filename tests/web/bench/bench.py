# SPDX-License-Identifier: MIT
#
# bench.py SKC SOURCE: the size of the npm package, and how fast its calls are in Chromium, which draws with SwiftShader unless
# SK_CHROMIUM_OPTIONS says otherwise (--use-angle=gl). A line is: what, its figure, the goal if it has one.
import gzip
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
import chromium
import package

skc, source = sys.argv[1], os.path.realpath(sys.argv[2])
here = os.path.dirname(os.path.realpath(__file__))
goals = {"package, gzipped (kB)": 25, "first result (ms)": 100, "host cost of saxpy (us)": 5, "host cost of diffuse in place (us)": 5}

chromium.need()
with tempfile.TemporaryDirectory() as folder:
    package.build(source, f"{folder}/streamkernel")
    subprocess.run([skc, "--emit=js", "-o", folder, f"{here}/../calls/calls.sk"], check=True)
    for name in ("index.html", "bench.mjs"):
        os.symlink(f"{here}/{name}", f"{folder}/{name}")
    figures = {"package, gzipped (kB)": package.gzipped(source) / 1000}
    with open(f"{folder}/calls.sk.js", "rb") as module:
        figures["calls.sk.js, gzipped (kB)"] = len(gzip.compress(module.read())) / 1000
    report = chromium.report_of(folder, "index.html", 600)
for name, value in {**figures, **report["figures"]}.items():
    goal = f"   at most {goals[name]}" if name in goals else ""
    print(f"{name:45} {value:10.2f}{goal}" if isinstance(value, float) else f"{name:45} {value}")
for mistake in report["mistakes"]:
    print(mistake)
sys.exit(1 if report["mistakes"] else 0)
