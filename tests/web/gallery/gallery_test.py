# SPDX-License-Identifier: MIT
#
# gallery_test.py SITE [--update] [PAGE...]: opens every page of the gallery in Chromium at a small size, drives it by pointer, finger and keys, and compares
# its picture with a stored one. --update stores the pictures.
import base64
import functools
import http.server
import json
import os
import sys
import threading

here = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.dirname(here))
sys.path.insert(0, here)
import chromium
import devtools
from driven import Driven, cpu_seconds

site, is_update = sys.argv[1], "--update" in sys.argv
chosen = [name for name in sys.argv[2:] if name != "--update"]
# Drivers contract products and sums as they like, and SwiftShader compiles for the machine's CPU: after some steps fields differ in their last
# bits, and so do codes of colours, by 1. Boiling and reactions make more of it: a cell may boil a step earlier. A page that paints
# nothing, or another place, differs by 10 and more.
most_difference = 1.5  # mean over the picture, in codes of 256
pages = {
    "heat": "size=96&frames=4&steps=4",
    "convection": "size=96&frames=3&steps=8",
    "boiling": "size=96&frames=3&steps=4",
    "cloth": "size=160&frames=2&steps=4",
    "edges": "size=160&frames=1",
    "rays": "size=96&frames=2&steps=2",
    "reaction": "size=96&frames=3&steps=8",
    "classic_boiling": "size=80&frames=2&steps=4",
    "classic_convection": "size=72&frames=2&steps=4",
    "classic_cloth": "size=64&frames=2&steps=4",
    "reduction": "size=72&frames=2&steps=1",
    "one_source": "size=64&frames=2&steps=1",
    "streaming_rays": "size=32&frames=1&steps=1",
    "banded": "size=96&frames=1&steps=2",
    "points": "size=96&frames=2&steps=1",
    "multigrid": "size=48&frames=2&steps=2",
    "sparse": "size=96&frames=1&steps=1",
}
mistakes = []


def check(holds, what):
    if not holds:
        mistakes.append(what)


def difference(tab, name, shown):
    """The mean difference between two pictures, data URLs; None if they have other sizes."""
    return tab.evaluate(f"""(async () => {{
        const pixels = async (url) => {{
            const picture = await createImageBitmap(await (await fetch(url)).blob());
            const drawing = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
            drawing.drawImage(picture, 0, 0);
            return drawing.getImageData(0, 0, picture.width, picture.height);
        }};
        const [a, b] = [await pixels({json.dumps(name)}), await pixels({json.dumps(shown)})];
        if (a.width !== b.width || a.height !== b.height) return null;
        return a.data.reduce((sum, x, i) => sum + Math.abs(x - b.data[i]), 0) / (0.75 * a.data.length);
    }})()""")


def compare(tab, name, shown):
    stored = f"{here}/{name}.png"
    if is_update:
        with open(stored, "wb") as file:
            file.write(base64.b64decode(shown.split(",")[1]))
        return
    if not os.path.exists(stored):
        return check(False, f"there is no {stored}; --update stores one")
    with open(stored, "rb") as file:
        wanted = "data:image/png;base64," + base64.b64encode(file.read()).decode()
    far = difference(tab, wanted, shown)
    print(f"{name}: {far:.3f} of 256 from the stored picture" if far is not None else f"{name}: another size")
    check(far is not None and far <= most_difference, f"{name}: the picture differs by {far} of 256, more than {most_difference}; it is {shown}")


def state(tab):
    return tab.evaluate("document.documentElement.dataset.state ?? ''")


def wait_done(tab):
    tab.wait("['done', 'failed'].includes(document.documentElement.dataset.state)")
    check(state(tab) == "done", f"the page shows: {tab.evaluate('document.getElementById(`message`).innerText')}")


def shown(tab):
    return tab.evaluate("document.getElementById('picture').toDataURL('image/png')")


def steps(tab, count):
    """Presses the button for one frame, by the keyboard."""
    for _ in range(count):
        before = tab.evaluate("gallery.loop.count")
        tab.evaluate("document.getElementById('step').focus()")
        tab.key("Enter", text="\r")
        tab.wait(f"gallery.loop.count > {before} && !gallery.loop.isBusy")


def place(tab, x, y):
    """A place in the picture, from 0 to 1, in the viewport."""
    left, top, width, height = tab.evaluate("(({left, top, width, height}) => [left, top, width, height])(document.getElementById('picture').getBoundingClientRect())")
    return left + x * width, top + y * height


def check_code(tab, name):
    tabs = tab.evaluate("[...document.querySelectorAll('#tabs button')].map((b) => b.textContent)")
    check(any(t.endswith(".sk") for t in tabs) and any(t.endswith("(GLSL)") for t in tabs), f"{name}: the tabs are {tabs}")
    tab.wait("document.querySelectorAll('#text .k').length > 3")  # highlighted
    tab.evaluate("document.querySelector('#tabs button').focus()")
    tab.key("ArrowLeft")  # round to the last one, a program
    tab.wait("document.getElementById('text').textContent.includes('#version 300 es')")


def check_accuracy(tab, name):
    tab.evaluate("document.getElementById('measure').click()")
    tab.wait("document.getElementById('measure').textContent === 'Measure again'")
    rows = tab.evaluate("[...document.querySelectorAll('#accuracy-rows tr')].map((r) => [r.cells[0].textContent, Number(r.dataset.ms), Number(r.dataset.error)])")
    check(len(rows) >= 2 and all(ms > 0 for _, ms, _ in rows), f"{name}: the accuracy table has {rows}")
    errors = [error for _, _, error in rows]
    check(errors[0] < 2e-5, f"{name}: floats differ from the reference in JavaScript by {errors[0]}")
    check(errors[1] > 8 * errors[0], f"{name}: the less accurate choice is not worse: {rows}")
    if "doubles" in str(rows):
        check(errors[2] < 1e-9, f"{name}: doubles differ by {errors[2]}")


def check_phone(tab, name):
    """Fits on a phone, dark, and answers to a finger."""
    tab.viewport(390, 844, scheme="dark")
    width, shade = tab.evaluate("[document.documentElement.scrollWidth, getComputedStyle(document.body).backgroundColor]")
    check(width <= 390, f"{name}: {width} pixels wide on a phone of 390")
    check(shade == "rgb(14, 18, 22)", f"{name}: the ground is {shade} where dark is wanted")
    if name in ("index", "edges"):  # nothing to touch
        return
    tab.evaluate("document.getElementById('picture').scrollIntoView({block: 'center'})")
    before = tab.evaluate("gallery.touched = 0, gallery.simulation.point && (() => { const own = gallery.point.bind(gallery); gallery.point = (e) => { ++gallery.touched; own(e); }; })(), 0")
    tab.touch(place(tab, 0.3, 0.3), place(tab, 0.5, 0.5), place(tab, 0.7, 0.4))
    check(tab.evaluate("gallery.touched") >= 3, f"{name}: a finger gives {tab.evaluate('gallery.touched')} events, after {before}")


def drive(tab, name):
    """Paints or drags with the mouse, and with the keys."""
    before = shown(tab)
    tab.evaluate("document.getElementById('picture').scrollIntoView({block: 'nearest'})")
    tab.drag(place(tab, 0.3, 0.35), place(tab, 0.4, 0.45), place(tab, 0.5, 0.5))
    if name == "edges":  # there is nothing to drag
        tab.evaluate("gallery.controls.put('sigma', 3), gallery.changed('sigma')")
    steps(tab, 1)
    painted = shown(tab)
    check(difference(tab, before, painted) > 0.3, f"{name}: dragging changes nothing")
    tab.evaluate("document.getElementById('picture').focus()")
    for key in ["ArrowRight"] * 6:
        tab.key(key)
    tab.key(" ", text=" ", kinds=["keyDown"])
    for key in ["ArrowRight", "ArrowDown"] * 2:
        tab.key(key)
    tab.key(" ", kinds=["keyUp"])
    check(not tab.evaluate("document.getElementById('cursor').hidden"), f"{name}: keys show no cursor")
    steps(tab, 1)
    if name != "edges":
        check(difference(tab, painted, shown(tab)) > 0.1, f"{name}: keys change nothing")


# A picture file, dark on the left and light on the right, and one that is none, dropped as a visitor does.
drop = """(async (isPicture) => {
    const canvas = new OffscreenCanvas(64, 48), drawing = canvas.getContext('2d');
    drawing.fillStyle = 'black'; drawing.fillRect(0, 0, 32, 48);
    drawing.fillStyle = 'white'; drawing.fillRect(32, 0, 32, 48);
    const blob = isPicture ? await canvas.convertToBlob() : new Blob(['no picture']);
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([blob], 'dropped.png', { type: 'image/png' }));
    const frame = document.getElementById('frame');
    const send = (name) => frame.dispatchEvent(new DragEvent(name, { dataTransfer, bubbles: true, cancelable: true }));
    send('dragover');
    const isMarked = frame.classList.contains('dropping');
    return [isMarked, !send('drop'), frame.classList.contains('dropping')];
})"""
# Where the picture is not as in its corner, from 0 to 1 in x: the mean, and the largest distance from it.
inked = """(() => {
    const picture = document.getElementById('picture'), { width, height } = picture;
    const drawing = new OffscreenCanvas(width, height).getContext('2d');
    drawing.drawImage(picture, 0, 0);
    const { data } = drawing.getImageData(0, 0, width, height);
    const places = [];
    for (let i = 0; i < data.length; i += 4) if (Math.abs(data[i] - data[0]) + Math.abs(data[i + 1] - data[1]) > 60) places.push((i / 4) % width / width);
    const mean = places.reduce((a, b) => a + b, 0) / places.length;
    return places.length === 0 ? null : [mean, Math.max(...places.map((x) => Math.abs(x - mean)))];
})()"""


def check_sources(tab):
    """Pictures of the visitor's, and the camera."""
    marks = tab.evaluate(f"{drop}(true)")
    check(marks == [True, True, False], f"edges: a file that is dragged over the picture gives {marks}")
    found = tab.wait(f"(({inked} ?? [])[1] ?? 1) < 0.05 && {inked}")
    check(abs(found[0] - 0.5) < 0.05, f"edges: the only edge of a dropped picture is at {found[0]}")
    tab.evaluate(f"{drop}(false)")
    tab.wait("document.getElementById('help').innerText.includes(\"'dropped.png' is no picture that this browser reads\")")
    camera = "[...document.querySelectorAll('#controls button')].find((b) => b.textContent.includes('camera'))"
    before = tab.evaluate("gallery.loop.count")
    tab.evaluate(f"{camera}.click()")
    tab.wait(f"{camera}.textContent === 'Stop the camera' && gallery.loop.count > {before + 1}")
    first, count = shown(tab), tab.evaluate("gallery.loop.count")
    tab.wait(f"gallery.loop.count > {count + 2}")
    check(difference(tab, first, shown(tab)) > 0.01, "edges: the camera's picture does not move")
    tab.evaluate(f"{camera}.click()")
    tab.wait(f"{camera}.textContent === 'Use the camera'")
    tab.evaluate("gallery.loop.pause()")


def check_page(tab, address, name, query):
    tab.viewport(1040, 700)
    tab.open(f"{address}/{name}.html?{query}&seed=1")
    wait_done(tab)
    drive(tab, name)
    compare(tab, name, shown(tab))
    check_code(tab, name)
    check_accuracy(tab, name)
    check_phone(tab, name)
    if name == "edges":
        check_sources(tab)


def check_index(tab, address):
    tab.viewport(1280, 900)
    tab.open(f"{address}/")
    names = tab.evaluate("[...document.querySelectorAll('.cards a')].map((a) => a.getAttribute('href'))")
    check(names == [f"{name}.html" for name in pages], f"the index has {names}")
    tab.evaluate("document.querySelectorAll('img').forEach((i) => i.loading = 'eager')")
    tab.wait("[...document.querySelectorAll('img')].every((i) => i.complete)")
    check(tab.evaluate("[...document.querySelectorAll('img')].every((i) => i.naturalWidth > 0 && i.alt !== '')"), "the index lacks a picture")
    check_phone(tab, "index")


def check_trouble(tab, address):
    """Less motion, a context that is lost, an address that asks for nonsense, and no WebGL2."""
    tab.viewport(1280, 900, reduced_motion=True)
    tab.open(f"{address}/heat.html?size=64")
    tab.wait("document.documentElement.dataset.state === 'ready'")
    check(not tab.evaluate("gallery.loop.isPlaying"), "the picture moves where less motion is wanted")
    check(tab.messages == [], f"the console says {tab.messages}")

    tab.evaluate("gallery.device.context.getExtension('WEBGL_lose_context').loseContext()")
    tab.wait("!document.getElementById('message').hidden")
    check("taken the graphics context away" in tab.evaluate("document.getElementById('message').innerText"), "a lost context is not told")
    tab.evaluate("document.querySelector('#message button').click()")
    tab.wait("document.documentElement.dataset.state === 'ready' && document.getElementById('message').hidden")

    tab.open(f"{address}/heat.html?size=many")
    tab.wait("!document.getElementById('message').hidden")
    check("no whole number from 16 to 4096" in tab.evaluate("document.getElementById('message').innerText"), "an address with size=many is not told")

    tab.send("Page.addScriptToEvaluateOnNewDocument", source="OffscreenCanvas.prototype.getContext = HTMLCanvasElement.prototype.getContext = () => null")
    tab.open(f"{address}/heat.html?size=64")
    tab.wait("!document.getElementById('message').hidden")
    check("use one with WebGL2" in tab.evaluate("document.getElementById('message').innerText"), "a browser without WebGL2 is not told what to do")


class Server(chromium.Pages):
    """Serves the site below a path, as some hosts do."""

    def translate_path(self, path):
        return super().translate_path(path.removeprefix("/some/where"))


chromium.need()
if not os.path.exists(f"{site}/index.html"):
    sys.exit(f"{site} has no gallery; build it by cmake --build --preset release --target gallery")
server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Server, directory=site))
threading.Thread(target=server.serve_forever, daemon=True).start()
where = f"http://127.0.0.1:{server.server_address[1]}/some/where"
with devtools.page(Driven, "--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream") as tab:
    check_index(tab, where)
    for page, query in pages.items():
        if chosen and page not in chosen:
            continue
        spent = cpu_seconds()
        check_page(tab, where, page, query)
        print(f"{page}: {cpu_seconds() - spent:.1f} s of CPU")
        check(tab.messages == [], f"{page}: the console says {tab.messages}")
        tab.messages.clear()
    check_trouble(tab, where)
    print(f"all: {cpu_seconds():.1f} s of CPU")
for mistake in mistakes:
    print(mistake)
sys.exit(1 if mistakes else 0)
