# SPDX-License-Identifier: MIT
#
# Drives a page in Chromium by its DevTools protocol, over pipes: types, clicks, evaluates, takes pictures.
import base64
import contextlib
import json
import os
import signal
import subprocess
import tempfile
import time

import chromium


class Page:
    """A page of a browser that has no other."""

    def __init__(self, reading, writing):
        self.reading, self.writing = reading, writing
        self.number, self.rest = 0, b""
        self.session = None
        self.messages = []  # what the page wrote to its console, and exceptions that nobody caught
        target = next(one for one in self.send("Target.getTargets")["targetInfos"] if one["type"] == "page")
        self.session = self.send("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime"):
            self.send(f"{domain}.enable")

    def send(self, method, **parameters):
        """The result of a command."""
        self.number += 1
        command = {"id": self.number, "method": method, "params": parameters}
        if self.session is not None:
            command["sessionId"] = self.session
        os.write(self.writing, json.dumps(command).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") == self.number:
                assert "error" not in answer, f"{method}: {answer['error']['message']}"
                return answer["result"]
            self.note(answer)

    def receive(self):
        while b"\0" not in self.rest:
            some = os.read(self.reading, 1 << 20)
            assert some, "Chromium has ended"
            self.rest += some
        text, self.rest = self.rest.split(b"\0", 1)
        return json.loads(text)

    def note(self, event):
        said = event.get("params", {})
        if event.get("method") == "Runtime.consoleAPICalled":
            self.messages.append(" ".join(str(one.get("value", one.get("description"))) for one in said["args"]))
        elif event.get("method") == "Runtime.exceptionThrown":
            details = said["exceptionDetails"]
            self.messages.append(details.get("exception", {}).get("description", details["text"]))

    def slow_frames(self, milliseconds):
        """Pages that are opened from now on draw frames this far apart: while a test waits, moving pictures take the CPU."""
        wait = f"const own = requestAnimationFrame; window.requestAnimationFrame = (draw) => setTimeout(() => own(draw), {milliseconds});"
        self.send("Page.addScriptToEvaluateOnNewDocument", source=f"{{ {wait} }}")

    def open(self, address):
        answer = self.send("Page.navigate", url=address)
        assert "errorText" not in answer, f"{address}: {answer.get('errorText')}"

    def evaluate(self, expression):
        """The value of an expression of JavaScript, which may be a promise."""
        answer = self.send("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise AssertionError(f"{expression}: {details.get('exception', {}).get('description', details['text'])}")
        return answer["result"].get("value")

    def wait(self, expression, seconds=120):
        """The value of an expression as soon as it is true. While a page loads, its parts may be missing."""
        end = time.monotonic() + seconds
        last = None
        while time.monotonic() < end:
            try:
                if value := self.evaluate(expression):
                    return value
            except AssertionError as error:
                last = error
            time.sleep(0.1)
        raise AssertionError(f"not within {seconds} s: {expression}\n{last or ''}\nthe page said: {self.messages}")

    def type(self, text):
        """Types into what has the focus."""
        self.send("Input.insertText", text=text)

    def press(self, key, code, modifiers=0):
        for kind in ("keyDown", "keyUp"):
            self.send("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, modifiers=modifiers)

    def click(self, selector):
        box = self.evaluate(f"(({{x, y, width, height}}) => [x + width / 2, y + height / 2])(document.querySelector({json.dumps(selector)}).getBoundingClientRect())")
        for kind in ("mousePressed", "mouseReleased"):
            self.send("Input.dispatchMouseEvent", type=kind, x=box[0], y=box[1], button="left", buttons=1, clickCount=1)

    def look(self, width, height, scheme="light"):
        """Sets the size of the page, and whether it is dark or light."""
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def picture(self, file):
        with open(file, "wb") as png:
            png.write(base64.b64decode(self.send("Page.captureScreenshot")["data"]))


@contextlib.contextmanager
def page(kind=Page, *options):
    """A page of a new Chromium with these options, which ends with the test; `kind` may know more of it than Page."""
    theirs_in, ours_out = os.pipe()
    ours_in, theirs_out = os.pipe()

    def descriptors():  # Chromium reads commands from 3 and answers to 4
        moved_in, moved_out = os.dup(theirs_in), os.dup(theirs_out)
        os.dup2(moved_in, 3)
        os.dup2(moved_out, 4)

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        # The page itself is drawn without SwiftShader, which would take most of the time.
        software = ["--disable-gpu-rasterization", "--disable-gpu-compositing"]
        command = chromium.command(folder, "--remote-debugging-pipe", *software, *options, "about:blank")
        nowhere = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        browser = subprocess.Popen(command, **nowhere, preexec_fn=descriptors, close_fds=False, start_new_session=True)
        os.close(theirs_in)
        os.close(theirs_out)
        try:
            yield kind(ours_in, ours_out)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(browser.pid, signal.SIGKILL)
            browser.wait()
            os.close(ours_in)
            os.close(ours_out)
