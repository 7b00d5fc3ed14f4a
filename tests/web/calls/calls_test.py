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

skc, source, reference, build = sys.argv[1], os.path.realpath(sys.argv[2]), sys.argv[3], os.path.realpath(sys.argv[4])
here = os.path.dirname(os.path.realpath(__file__))
seconds = 400  # a few, on a machine that has nothing else to do


def check_sizes(sizes):
    """What docs/browser.md says of the package's sizes, in kB, is what they are, rounded up."""
    with open(os.path.join(source, "docs/browser.md")) as document:
        said = re.search(r"takes (\d+) kB for kernels, (\d+) kB\s+for kernels and reduces, and (\d+) kB for everything.*?loads (\d+) kB more", document.read(), re.S)
    assert said, "docs/browser.md does not say how large the package is"
    for (use, size), kilobytes in zip(sizes.items(), map(int, said.groups())):
        if not 1000 * (kilobytes - 1) < size <= 1000 * kilobytes:
            yield f"the package has {size} bytes for {use}, but docs/browser.md says {kilobytes} kB"


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
    sizes = package.minified(f"{folder}/streamkernel", build)

if sizes is not None:
    report["mistakes"] += check_sizes(sizes)
for mistake in report["mistakes"]:
    print(mistake)
print(f"{report['checks']} checks, {len(report['mistakes'])} mistakes; seconds: {report['seconds']}")
if sizes is None:
    print("skipped: the package's size, as esbuild is not here (--target playground_editor, which needs npm)")
sys.exit(1 if report["mistakes"] or report["checks"] < 60 else 0)
