# SPDX-License-Identifier: MIT
#
# bench.py SKC SOURCE BUILD: the size of the npm package, and how fast its calls are in Chromium, which draws with SwiftShader unless
# SK_CHROMIUM_OPTIONS says otherwise (--use-angle=gl). gpu.js does the same in turn, where npm has fetched it (--target web_peers). A
# line is: what, its figure, the goal if it has one.
import gzip
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
import chromium
import package

skc, source, build = sys.argv[1], os.path.realpath(sys.argv[2]), os.path.realpath(sys.argv[3])
here = os.path.dirname(os.path.realpath(__file__))
at_most = {
    "package for kernels, minified and gzipped (kB)": 25,
    "package for kernels and reduces, minified and gzipped (kB)": 25,
    "package for everything, minified and gzipped (kB)": 25,
    "first result after the context (ms)": 100,
    "host cost of saxpy (us)": 5,
    "host cost of diffuse in place (us)": 5,
}
at_least = {"saxpy 1024 x 1024, times gpu.js": 3, "heat step 1024 x 1024, times gpu.js": 3, "sum 1024 x 1024 to a value, times gpu.js": 10}
gpu_js = f"{build}/tests/web/peers/node_modules/gpu.js/dist/gpu-browser.min.js"

chromium.need()
with tempfile.TemporaryDirectory() as folder:
    package.build(source, f"{folder}/streamkernel")
    subprocess.run([skc, "--emit=js", "-o", folder, f"{here}/../calls/calls.sk"], check=True)
    for name in ("index.html", "bench.mjs", "gpu_js.mjs"):
        os.symlink(f"{here}/{name}", f"{folder}/{name}")
    if os.path.exists(gpu_js):
        os.symlink(gpu_js, f"{folder}/gpu-browser.min.js")
    else:
        print("gpu.js is not here (--target web_peers, which needs npm): nothing is compared with it")
    figures = {"package, gzipped without comments (kB)": package.gzipped(source) / 1000}
    for use, size in (package.minified(f"{folder}/streamkernel", build) or {}).items():
        figures[f"package for {use}, minified and gzipped (kB)"] = size / 1000
    with open(f"{folder}/calls.sk.js", "rb") as module:
        figures["calls.sk.js, gzipped (kB)"] = len(gzip.compress(module.read())) / 1000
    report = chromium.report_of(folder, "index.html", 600)
for name, value in {**figures, **report["figures"]}.items():
    goal = f"   at most {at_most[name]}" if name in at_most else f"   at least {at_least[name]}" if name in at_least else ""
    print(f"{name:45} {value:10.2f}{goal}" if isinstance(value, float) else f"{name:45} {value}")
for mistake in report["mistakes"]:
    print(mistake)
sys.exit(1 if report["mistakes"] else 0)
