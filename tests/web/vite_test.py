# SPDX-License-Identifier: MIT
#
# vite_test.py SKC SOURCE PACKAGE.tgz: the commands that docs/browser.md gives to a web developer turn an empty folder into a
# moving picture, with the real Vite and a real browser; an edited .sk file is taken while the picture goes on, and an error in it is
# shown in the page. Skipped where npm reaches no registry.
import contextlib
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import chromium
import devtools

skc, source, packed = (os.path.realpath(path) for path in sys.argv[1:4])
most_commands = 5

# The mean red of the canvas: that of heat alone in the colours of magma.
red = """(() => {
  const { width, height } = document.querySelector('canvas');
  const context = new OffscreenCanvas(width, height).getContext('2d');
  context.drawImage(document.querySelector('canvas'), 0, 0);
  const { data } = context.getImageData(0, 0, width, height);
  return data.reduce((sum, value, i) => (i % 4 === 0 ? sum + value : sum), 0) / (data.length / 4);
})()"""
overlay = "document.querySelector('vite-error-overlay')?.shadowRoot?.querySelector('.window')?.textContent"


def commands():
    """What the document says to type."""
    with open(os.path.join(source, "docs/browser.md")) as document:
        block = re.search(r"^## From an empty folder\n.*?^```sh\n(.*?)^```", document.read(), re.M | re.S)[1]
    lines = [line.split("#")[0].strip() for line in block.splitlines()]
    assert len(lines) <= most_commands, lines
    words = [re.sub(r"\S+\.tgz", packed, line).split() for line in lines]
    assert words[-1] == ["npx", "vite"], words
    return words


def typed(words, folder):
    quick = {"npm_config_fetch_retries": "0", "npm_config_audit": "false", "npm_config_fund": "false", "npm_config_update_notifier": "false"}
    result = subprocess.run(words, cwd=folder, env={**os.environ, **quick, "npm_config_prefer_offline": "true"}, capture_output=True, text=True)
    if result.returncode and re.search(r"npm (?:error|ERR!) (?:code|errno) (?:E(NOTFOUND|AI_AGAIN|CONN\w+|TIMEDOUT|HOSTUNREACH|NETUNREACH|403)|ERR_SOCKET_TIMEOUT|\w*CERT\w*)", result.stderr):
        print(f"skipped: npm reaches no registry: {result.stderr.splitlines()[0]}")
        sys.exit(chromium.skipped)
    assert result.returncode == 0, f"{' '.join(words)}: {result.stdout}{result.stderr}"


@contextlib.contextmanager
def served(folder):
    """The address of the page, as Vite prints it."""
    log = os.path.join(folder, "vite.log")
    with open(log, "w") as out:
        environment = {**os.environ, "SKC": skc, "NO_COLOR": "1", "FORCE_COLOR": "0"}
        vite = subprocess.Popen(["npx", "vite", "--port", "0"], cwd=folder, env=environment, stdout=out, stderr=out, start_new_session=True)
    try:
        end = time.monotonic() + 120
        found = None
        while found is None:
            with open(log) as text:
                found = re.search(r"http://localhost:\d+/", text.read())
            assert vite.poll() is None and time.monotonic() < end, open(log).read()
            time.sleep(0.1)
        yield found[0]
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(vite.pid, signal.SIGKILL)
        vite.wait()


def write(file, text):
    with open(file, "w") as opened:
        opened.write(text)


def check_page(page, folder):
    first = page.wait(f"{red} > 5 && {red}")
    page.wait(f"Math.abs({red} - {first}) > 0.001")  # heat that spreads changes the colours
    page.evaluate("window.isFirst = true")

    file = os.path.join(folder, "heat.sk")
    with open(file) as opened:
        text = opened.read()
    assert "v = here + " in text
    write(file, text.replace("v = here + ", "v = 1; float w = here + "))
    page.wait(f"{red} > 240")
    write(file, text.replace("v = here + ", "v = hear + "))
    said = page.wait(overlay)
    assert "use of undeclared identifier 'hear'" in said and re.search(r"heat\.sk:13:", said), said
    write(file, text)
    page.wait(f"!({overlay})")
    assert page.evaluate("window.isFirst"), "the page was loaded again"


chromium.need()
if not shutil.which("npm"):
    print("skipped: npm is not installed")
    sys.exit(chromium.skipped)
with tempfile.TemporaryDirectory() as folder:
    for words in commands()[:-1]:
        typed(words, folder)
    with served(folder) as address, devtools.page() as page:
        page.slow_frames(200)
        page.open(address)
        check_page(page, folder)
print("a moving picture from an empty folder, hot reload, and skc's messages in the page")
