# SPDX-License-Identifier: MIT
#
# calls_test.py SKC SOURCE REFERENCE BUILD: what kernels and reduces compute in Chromium is what native code computes, within the
# bounds that calls.mjs states; the types that skc writes for TypeScript are right; the runtime is small.
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
import chromium
import package

skc, source, reference, build = sys.argv[1], os.path.realpath(sys.argv[2]), sys.argv[3], sys.argv[4]
here = os.path.dirname(os.path.realpath(__file__))
most_bytes = 33000  # of the package, minified and gzipped
seconds = 400  # a few, on a machine that has nothing else to do



def modules_of_document(folder):
    """Writes the modules of docs/browser.md, with the .sk files that it shows."""
    with open(os.path.join(source, "docs/browser.md")) as document:
        blocks = re.findall(r"^```(?:sk|ts) file=(\S+)[^\n]*\n(.*?)^```", document.read(), re.M | re.S)
    for name, text in blocks:
        with open(os.path.join(folder, name), "w") as file:
            file.write(text)
    for name in [name for name, _ in blocks if name.endswith(".sk")]:
        subprocess.run([skc, "--emit=js", "-o", folder, os.path.join(folder, name)], check=True)
    modules = [os.path.join(folder, name) for name, _ in blocks if name.endswith(".ts")]
    assert modules, "docs/browser.md shows no module"
    return modules


chromium.need()
with tempfile.TemporaryDirectory() as folder:
    package.build(source, f"{folder}/streamkernel", build)
    for name in ("calls.sk", "layouts.sk", "reductions.sk"):
        subprocess.run([skc, "--emit=js", "-o", folder, f"{here}/{name}"], check=True)
    shutil.copy(f"{here}/types.ts", folder)
    package.check_types([f"{folder}/types.ts", *modules_of_document(folder)], folder)
    with open(f"{folder}/expected.json", "w") as expected:
        subprocess.run([reference], stdout=expected, check=True)
    for name in ("index.html", "calls.mjs", "append.mjs", "devices.mjs", "layouts.mjs", "mistakes.mjs", "reductions.mjs", "repeats.mjs"):
        os.symlink(f"{here}/{name}", f"{folder}/{name}")
    report = chromium.report_of(folder, "index.html", seconds)
    size = package.minified(f"{folder}/streamkernel", build)

for mistake in report["mistakes"]:
    print(mistake)
print(f"{report['checks']} checks, {len(report['mistakes'])} mistakes; seconds: {report['seconds']}")
if size is None:
    print("esbuild is not here (--target playground_editor, which needs npm): the package's size is not tested")
elif size > most_bytes:
    report["mistakes"].append(size)
    print(f"the package has {size} bytes, minified and gzipped, more than {most_bytes}")
sys.exit(1 if report["mistakes"] or report["checks"] < 60 else 0)
