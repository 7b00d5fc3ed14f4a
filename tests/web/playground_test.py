# SPDX-License-Identifier: MIT
#
# playground_test.py SK SKC SOURCE SHARE: the page of `sk serve` in a real browser. A program is typed, errors are shown at their
# lines, the picture moves, and a link restores the program. With the plain editor, and with CodeMirror where SHARE has it.
import os
import re
import sys
import tempfile
import time

import chromium
import devtools
import playground

sk, skc, source, share = (os.path.realpath(path) for path in sys.argv[1:5])
pictures = os.environ.get("SK_PICTURES")  # a folder for what the page looks like

state = "document.getElementById('state').textContent"
pixels = """(() => {
  const canvas = document.getElementById('picture');
  const context = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
  return data.reduce((sum, value, i) => (i % 4 < 3 ? sum + value : sum), 0) / (canvas.width * canvas.height);
})()"""
white = "kernel void view(float time, out float3 c<>) {\n  c = float3(1, 1, 1);\n}\n"


def running(page):
    page.wait(f"/^running/.test({state})")


def replace(page, text):
    """Types a program in place of the one that is there."""
    page.evaluate("document.querySelector('#source [aria-label=Program]').focus()")
    page.press("a", 65, modifiers=2)
    page.type(text)


def text(page):
    return page.evaluate("document.querySelector('#source textarea')?.value ?? document.querySelector('.cm-content').innerText")


def look(page, name):
    if pictures:
        page.picture(os.path.join(pictures, f"{name}.png"))


def check(page, address, editor):
    page.open(address)
    running(page)
    page.evaluate("document.getElementById('size').value = '128'; document.getElementById('size').dispatchEvent(new Event('change'))")
    first = page.evaluate(pixels)
    page.wait(f"Math.abs({pixels} - {first}) > 0.001")  # it moves
    assert "#version 300 es" in page.evaluate("document.getElementById('glsl').textContent")
    look(page, f"{editor}_light")

    replace(page, white.replace("float3(1, 1, 1)", "float3(1, 1, wrong)"))
    message = page.wait("document.querySelector('#messages .error')?.textContent")
    assert re.match(r"2:20: error: use of undeclared identifier 'wrong'", message), message
    assert page.evaluate(state) == "1 error"
    if editor == "codemirror":
        page.wait("document.querySelector('.cm-lintRange-error')?.textContent === 'wrong'")
        assert page.evaluate("document.querySelectorAll('.cm-lint-marker-error').length") == 1
    page.look(1280, 800, "dark")
    look(page, f"{editor}_dark")

    replace(page, white)
    page.wait(f"{state} === 'running view'")
    page.wait(f"{pixels} > 760")
    assert page.evaluate("document.querySelectorAll('#messages li').length") == 0

    # compiles, but is no picture: the page says why
    replace(page, "kernel void step(float k, float u<>, out float v<>) { v = k * u; }\n")
    page.wait(f"/'k' of 'step': the page gives float time/.test({state})")
    replace(page, "kernel void a(out float v<>) { v = 1; }\nkernel void b(out float v<>) { v = 1; }\n")
    page.wait(f"/name a kernel 'step'/.test({state})")
    replace(page, white)
    running(page)
    return check_link(page, address, editor)


def check_link(page, address, editor):
    page.click("#share")
    link = page.wait("location.hash.startsWith('#p=') && location.href")
    page.open("about:blank")
    page.look(390, 844)
    page.open(link)
    page.wait(f"{state} === 'running view'")
    assert text(page).strip() == white.strip(), text(page)
    assert page.evaluate("document.getElementById('size').value") == "128"
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), "wider than a phone"
    look(page, f"{editor}_phone")
    page.open("about:blank")
    page.open(f"{address}#p=broken")
    page.wait(f"/the link is broken/.test({state})")
    assert not page.messages, page.messages


def try_page(page, share, editor):
    with playground.served(sk, skc, share=share) as (host, port):
        page.look(1280, 800)
        check(page, f"http://{host}:{port}/", editor)


chromium.need()
if not os.path.exists(f"{share}/package/dist/index.js"):
    print("skipped: the npm package is not built (--target web_package); './dev test web' builds it")
    sys.exit(chromium.skipped)
with tempfile.TemporaryDirectory() as folder, devtools.page() as page:
    page.slow_frames(200)
    os.symlink(f"{source}/runtime/web/playground", f"{folder}/playground")
    os.symlink(f"{share}/package", f"{folder}/package")
    began = time.monotonic()
    if os.path.exists(f"{share}/editor/editor.js"):
        os.symlink(f"{share}/editor", f"{folder}/editor")
        try_page(page, folder, "codemirror")
        os.unlink(f"{folder}/editor")
    else:
        print("CodeMirror is not built (--target playground): the plain editor alone is tested")
    try_page(page, folder, "plain")
print(f"the playground edits, reports, draws and shares ({time.monotonic() - began:.0f} s)")
