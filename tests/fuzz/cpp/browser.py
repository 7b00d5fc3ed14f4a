# SPDX-License-Identifier: MIT
#
# browser.py FOLDER SOURCE BUILD PACKAGE: runs the modules NUMBER.sk.js of a folder in Chromium, and compares what their kernels compute with
# samples.json. Prints a line for each difference: the number, a colon, and what differs. Chromium starts once for all modules.
# The JavaScript package is built into the folder PACKAGE, unless it is there already.
import os
import shutil
import sys
import tempfile

folder, source, build, built = (os.path.realpath(path) for path in sys.argv[1:5])
here = os.path.dirname(os.path.realpath(__file__))
sys.path.append(os.path.join(source, "tests/web"))
import chromium
import package

seconds = 1200

if not chromium.path:
    sys.exit("skipped: chromium is not installed; './dev test web' installs it")  # standard output has the differences
with tempfile.TemporaryDirectory() as pages:
    if not os.path.exists(built):
        package.build(source, built, build)
    os.symlink(built, f"{pages}/streamkernel")
    for name in ("browser.html", "browser.mjs"):
        shutil.copy(f"{here}/{name}", pages)
    for name in os.listdir(folder):
        os.symlink(f"{folder}/{name}", f"{pages}/{name}")
    report = chromium.report_of(pages, "browser.html", seconds)
for number, difference in report:
    print(f"{number}: {difference}".replace("\n", "\1"))
