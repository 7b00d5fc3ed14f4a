# SPDX-License-Identifier: MIT
#
# shadow_test.py SK SOURCE: the pages of the sample reports, and of a large one, in a real browser, from files. Nothing is written to the
# console, the first verdict is seen, tables sort, rows open, charts are drawn and tell their numbers; nothing sticks out of a narrow page.
# SK_PICTURES: a folder for what the pages look like.
import json
import os
import subprocess
import sys
import tempfile
import time

import chromium
import devtools

sk, source = (os.path.realpath(path) for path in sys.argv[1:3])
samples = os.path.join(source, "tests/cli/shadow")
pictures = os.environ.get("SK_PICTURES")

ready = "document.readyState === 'complete' && document.querySelector('#main > *') !== null"
rows = "[...document.querySelectorAll('#kernels tbody tr:not(.more) .opens')].map((name) => name.textContent).join()"


def text_of(selector):
    return f"document.querySelector({json.dumps(selector)})?.innerText ?? ''"


def number_of(selector):
    return f"document.querySelectorAll({json.dumps(selector)}).length"


def opened(page, folder, name, width=1280, scheme="light", anchor=""):
    page.look(width, 900, scheme)
    page.open("about:blank")
    page.open(f"file://{folder}/{name}.html{anchor}")
    page.wait(ready, 60)
    assert not page.messages, f"{name}: {page.messages}"


def healthy(page, folder):
    opened(page, folder, "healthy")
    assert page.evaluate(text_of("#verdict .text")).startswith("All results keep 5.8 digits"), page.evaluate(text_of("#verdict"))
    assert page.evaluate("document.querySelector('#verdict').getBoundingClientRect().bottom < innerHeight")
    assert page.evaluate("document.title") == "Shadow report: heat 512"
    for part in ("lives", "decisions", "account"):
        assert page.evaluate(number_of(f"#{part}")) == 0, part
    assert "no NaN" in page.evaluate(text_of("#foot"))
    # By share, then by calls, upwards.
    assert page.evaluate(rows) == "heat::diffuse,heat::sum", page.evaluate(rows)
    calls = "#kernels thead th:nth-child(7) button"
    page.evaluate(f"document.querySelector('{calls}').click()")
    page.evaluate(f"document.querySelector('{calls}').click()")
    assert page.evaluate(rows) == "heat::sum,heat::diffuse"
    assert page.evaluate("document.querySelector('#kernels thead th:nth-child(7)').ariaSort") == "ascending"


def exceptional(page, folder):
    opened(page, folder, "exceptional", 400, "dark", "#kernel-0")
    # The link has opened the row of the first kernel.
    worst = page.wait(text_of("#kernels tr.more:not([hidden])"))
    assert "v[17][4]" in worst and "-0x1.8000000000000p+0" in worst, worst
    assert page.evaluate("document.documentElement.scrollWidth") == 400
    # A chart is drawn when it comes into view, with a line for each kind and a mark for the first NaN; arrow keys choose a point.
    page.evaluate("document.querySelector('#kernels .chart').scrollIntoView({ behavior: 'instant' })")
    page.wait("document.querySelector('#kernels .chart svg') !== null")
    assert page.evaluate("document.querySelector('#kernels .chart .mark text').textContent") == "NaN"
    for kind in ("own", "inherited", "total"):
        assert page.evaluate(number_of(f"#kernels .chart path.{kind}")) > 0, kind
    page.evaluate("document.querySelector('#kernels .chart svg').focus({ preventScroll: true })")
    page.press("End", 35)
    told = page.evaluate(text_of("#tip"))
    assert told.split("\n")[0] == "call 1\u202f200" and "total NaN" in told, told
    assert "in call 1000" in page.evaluate("document.querySelector('#kernels .chart svg').getAttribute('aria-label')")
    page.evaluate("document.querySelector('#kernels .numbers summary').click()")
    assert page.wait(number_of("#kernels .numbers tbody tr")) == 20
    # The other parts, and no text of a report as HTML.
    for part, text in (("lives", "Where it went"), ("decisions", "its own, the first"), ("account", "residual"), ("run", "<itself>")):
        assert text in page.evaluate(text_of(f"#{part}")), part
    assert page.evaluate(number_of("itself")) == 0
    # The charts of the kernels' outputs take the place of the streams'.
    page.evaluate("document.querySelectorAll('input[name=kind]')[1].click()")
    assert "flow::project, v" in page.evaluate(text_of("#pictures .charts"))


def others(page, folder):
    opened(page, folder, "empty")
    assert "called no kernel" in page.evaluate(text_of("#verdict"))
    opened(page, folder, "ranks")
    assert "exhausted in call 501" in page.evaluate(text_of("#top .warning"))
    assert page.evaluate(number_of("#run tbody tr")) == 2
    for name, text in (("unknown", "version 1"), ("none", "empty page")):
        opened(page, folder, name)
        assert text in page.evaluate(text_of("#main")), name
    # A part that is damaged leaves the others as they are.
    page.open(f"file://{folder}/damaged.html")
    page.wait(f"({ready}) && document.querySelector('#run') !== null")
    assert "is damaged" in page.evaluate(text_of("#run")) and "3 NaN" in page.evaluate(text_of("#kernels"))
    assert len(page.messages) == 1 and "TypeError" in page.messages.pop(), page.messages


def large(page, folder):
    """500 kernels and 2,000 streams: rows and charts come as they are asked for, within a second."""
    opened(page, folder, "large")
    assert page.evaluate(number_of("*")) < 4000
    start = time.monotonic()
    page.evaluate("location.hash = '#kernel-499'")
    page.wait("document.querySelector('#kernel-499.open') !== null")
    page.evaluate("(() => { const field = document.querySelector('#pictures input[type=search]'); field.value = 'field1999'; field.dispatchEvent(new Event('input')); })()")
    page.evaluate("document.querySelector('#pictures').scrollIntoView({ behavior: 'instant' })")
    page.wait("document.querySelectorAll('#pictures .chart svg').length === 1")
    # A fifth of a second here; a machine that is busy may take longer, but not the time of drawing all.
    assert time.monotonic() - start < 5, "the page is slow"


def large_report():
    with open(os.path.join(samples, "exceptional.json")) as file:
        report = json.load(file)
    kernel, stream = report["kernels"][1], report["streams"][1]
    points = [[call, 1e-7, 1e-6 * call, 1e-6 * call] for call in range(1, 301)]
    report["kernels"] = [dict(kernel, name=f"k{i}", share=1 / (i + 1), outputs=[dict(kernel["outputs"][0], points=points)]) for i in range(500)]
    report["streams"] = [dict(stream, name=f"field{i}", points=[[call, total] for call, _, _, total in points]) for i in range(2000)]
    report["decisions"] = report["decisions"] * 1000
    report["exceptions"] = report["exceptions"] * 100
    report["notes"] = report["notes"] * 100
    return report


def write_pages(folder):
    for name in ("healthy", "exceptional", "empty", "ranks"):
        subprocess.run([sk, "shadow", f"{samples}/{name}.json", "--html", f"{folder}/{name}.html"], check=True, stdout=subprocess.DEVNULL)
    with open(f"{folder}/large.json", "w") as file:
        json.dump(large_report(), file)
    subprocess.run([sk, "shadow", f"{folder}/large.json", "--html", f"{folder}/large.html"], check=True, stdout=subprocess.DEVNULL)
    with open(f"{folder}/empty.html") as file:
        page = file.read()
    start, end = page.index("const report = ") + len("const report = "), page.index(";</script>")
    with open(f"{samples}/exceptional.json") as file:
        damaged = json.dumps(json.load(file) | {"options": {"kernels": 5}})
    for name, report in (("unknown", '{"format": "streamkernel-shadow", "version": 9, "results": 5}'), ("none", "null"), ("damaged", damaged)):
        with open(f"{folder}/{name}.html", "w") as file:
            file.write(page[:start] + report + page[end:])


def take_pictures(page, folder):
    for name in ("healthy", "exceptional", "ranks", "large"):
        for width in (400, 1280, 1600):
            for scheme in ("light", "dark"):
                opened(page, folder, name, width, scheme, "#kernel-0")
                page.look(width, min(6000, page.evaluate("document.documentElement.scrollHeight")), scheme)
                time.sleep(1)
                page.picture(os.path.join(pictures, f"{name}_{width}_{scheme}.png"))


chromium.need()
with tempfile.TemporaryDirectory() as folder, devtools.page() as page:
    write_pages(folder)
    for check in (healthy, exceptional, others, large):
        check(page, folder)
    assert not page.messages, page.messages
    if pictures:
        take_pictures(page, folder)
print("the pages of shadow reports show what they should")
