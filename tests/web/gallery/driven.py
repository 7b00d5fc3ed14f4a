# SPDX-License-Identifier: MIT
#
# A page that is driven as visitors do: by mouse, fingers and keys, at any viewport. `messages` has what the browser complains of, too.
import contextlib
import json
import os

import devtools

codes = {"Tab": 9, "Enter": 13, " ": 32, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}


class Driven(devtools.Page):
    def __init__(self, reading, writing):
        super().__init__(reading, writing)
        self.send("Log.enable")

    def note(self, event):
        super().note(event)
        if event.get("method") == "Log.entryAdded" and event["params"]["entry"]["level"] in ("error", "warning"):
            entry = event["params"]["entry"]
            if "GPU stall due to ReadPixels" in entry["text"]:  # Chromium's advice about speed, where it draws pages without the GPU
                return
            self.messages.append(f"{entry['text']} {entry.get('url', '')}")

    def wait(self, expression, seconds=400):
        """A few suffice on a machine that has nothing else to do."""
        return super().wait(expression, seconds)

    def open(self, address):
        super().open(address)
        self.wait(f"location.href === {json.dumps(address)} && document.readyState === 'complete'")

    def viewport(self, width, height, scheme="light", reduced_motion=False):
        self.look(width, height, scheme)
        motion = "reduce" if reduced_motion else "no-preference"
        features = [{"name": "prefers-color-scheme", "value": scheme}, {"name": "prefers-reduced-motion", "value": motion}]
        self.send("Emulation.setEmulatedMedia", features=features)

    def drag(self, *places):
        for i, (x, y) in enumerate([*places, places[-1]]):
            kind = "mousePressed" if i == 0 else "mouseMoved" if i < len(places) else "mouseReleased"
            buttons = 0 if kind == "mouseReleased" else 1
            self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=buttons, clickCount=1)

    def touch(self, *places):
        for i, (x, y) in enumerate(places):
            self.send("Input.dispatchTouchEvent", type="touchMove" if i else "touchStart", touchPoints=[{"x": x, "y": y}])
        self.send("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def key(self, name, text="", kinds=("keyDown", "keyUp")):
        for kind in kinds:
            more = {"text": text} if text and kind == "keyDown" else {}
            self.send("Input.dispatchKeyEvent", type=kind, key=name, code="Space" if name == " " else name, windowsVirtualKeyCode=codes[name], **more)


def cpu_seconds():
    """CPU time of the browsers that this process has started, with all of their processes, so far."""
    ticks, parents, spent = 0, {}, {}
    for process in filter(str.isdigit, os.listdir("/proc")):
        with contextlib.suppress(OSError):
            with open(f"/proc/{process}/stat") as file:
                fields = file.read().rsplit(")", 1)[1].split()  # from the state on
            parents[int(process)] = int(fields[1])
            spent[int(process)] = int(fields[11]) + int(fields[12])
    for process in parents:
        ancestor = parents[process]
        while ancestor not in (0, os.getpid()):
            ancestor = parents.get(ancestor, 0)
        ticks += spent[process] if ancestor else 0
    return ticks / os.sysconf("SC_CLK_TCK")
