# SPDX-License-Identifier: MIT
#
# pictures.py BUILD: makes the pictures of docs/accuracy.md, in docs/images: drift.png, the foil as it is and mended, and
# drift_report.png, the page that SK_SHADOW writes, as Chromium shows it in a window 1280 pixels wide.
import os
import subprocess
import sys
import tempfile
import time

here = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(here, "../../tests/web"))
import devtools  # noqa: E402 (found there)

program = os.path.join(os.path.realpath(sys.argv[1]), "bin/drift")
images = os.path.join(here, "../../docs/images")
small = ["-strip", "-dither", "none", "-colors", "256", "-define", "png:compression-level=9"]


def converted(arguments, name):
    subprocess.run(["convert", *arguments, *small, f"PNG8:{images}/{name}"], check=True)


with tempfile.TemporaryDirectory() as folder, devtools.page() as page:
    native = {**os.environ, "SK_DEVICE": "native"}
    plain, mended, shown = (os.path.join(folder, name) for name in ("drift.png", "mended.png", "shown.png"))
    subprocess.run([program], check=True, cwd=folder, env={**native, "SK_SHADOW": "report.html"})
    subprocess.run([program, "--mended", "--output", mended], check=True, cwd=folder, env=native)
    converted([plain, "(", "-size", "8x384", "xc:white", ")", mended, "+append"], "drift.png")
    page.look(1280, 900, "light")
    page.open(f"file://{folder}/report.html")
    page.wait("document.querySelector('#main table') !== null")
    page.evaluate("document.documentElement.style.overflow = 'hidden'")  # no bar for scrolling
    page.look(1280, round(page.evaluate("document.querySelector('#kernels table').getBoundingClientRect().bottom")) + 24, "light")
    time.sleep(1)  # transitions end
    page.picture(shown)
    converted([shown], "drift_report.png")
