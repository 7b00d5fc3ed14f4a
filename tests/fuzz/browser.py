# SPDX-License-Identifier: MIT
#
# browser.py FOLDER SOURCE BUILD PACKAGE PAGE: runs the module PAGE, which has the files of a folder beside it, in Chromium. It posts pairs of
# a number and a text; each is printed as a line with a colon between. The JavaScript package is built into the folder PACKAGE,
# unless it is there already. The exit status is 3 if the page posts nothing, not even progress, for SK_PAGE_SECONDS (300).
import os
import shutil
import sys
import tempfile

folder, source, build, built, page = (os.path.realpath(path) for path in sys.argv[1:6])
here = os.path.dirname(os.path.realpath(__file__))
sys.path.append(os.path.join(source, "tests/web"))
import chromium
import package

seconds = float(os.environ.get("SK_PAGE_SECONDS", "300"))
hung = 3

if not chromium.path:
    sys.exit("skipped: chromium is not installed; './dev test web' installs it")  # standard output has the differences
with tempfile.TemporaryDirectory() as pages:
    if not os.path.exists(built):
        package.build(source, built, build)
    os.symlink(built, f"{pages}/streamkernel")
    shutil.copy(f"{here}/browser.html", pages)
    shutil.copy(page, f"{pages}/page.mjs")
    for name in os.listdir(folder):
        os.symlink(f"{folder}/{name}", f"{pages}/{name}")
    try:
        report = chromium.report_of(pages, "browser.html", seconds)
    except chromium.Silent as silence:
        print(silence, file=sys.stderr)
        sys.exit(hung)
for number, text in report:
    print(f"{number}: {text}".replace("\n", "\1"))
