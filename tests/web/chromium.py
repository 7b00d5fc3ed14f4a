# SPDX-License-Identifier: MIT
#
# Starts Chromium without a window, with WebGL2 by SwiftShader, so that no GPU is needed. All of its processes end with
# the test.
import contextlib
import functools
import http.server
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

skipped = 77
path = shutil.which("chromium")


def need():
    if not path:
        print("skipped: chromium is not installed; './dev test web' installs it")
        sys.exit(skipped)


def command(folder, *arguments):
    """Chromium's command line; `folder` is for its profile."""
    options = "--headless=new --use-angle=swiftshader --enable-unsafe-swiftshader --disable-gpu-sandbox"
    options += " --disable-gpu-watchdog --disable-quic --no-first-run --disable-background-networking"
    options += " --disable-component-update --disable-sync --disable-dev-shm-usage"
    options += " " + os.environ.get("SK_CHROMIUM_OPTIONS", "")  # the last of two that differ counts
    options += " --no-sandbox" if os.geteuid() == 0 else ""  # root has no sandbox
    return [path, *options.split(), f"--user-data-dir={folder}/profile", *arguments]


@contextlib.contextmanager
def started(arguments):
    """A running Chromium, by its command line."""
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    browser = subprocess.Popen(arguments, **pipes, text=True, errors="replace", start_new_session=True)
    try:
        yield browser
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(browser.pid, signal.SIGKILL)
        browser.wait()


class Silent(SystemExit):
    """A page reports nothing. Ends the test that does not catch it."""


class Pages(http.server.SimpleHTTPRequestHandler):
    """Serves a folder, and takes the report of a page. What it posts to `progress` says only that it does not hang."""

    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".mjs": "text/javascript", ".js": "text/javascript"}

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if self.path != "/progress":
            self.server.report = json.loads(body)
        self.send_response(204)
        self.end_headers()
        self.server.heard.set()

    def log_message(self, *arguments):
        pass


def report_of(folder, page, seconds):
    """What a page of this folder posts, as JSON. Raises Silent if it posts nothing for so long."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Pages, directory=folder))
    server.report, server.heard = None, threading.Event()
    threading.Thread(target=server.serve_forever, daemon=True).start()
    address = f"http://127.0.0.1:{server.server_address[1]}/{page}"
    with tempfile.TemporaryDirectory() as profile, started(command(profile, "--remote-debugging-port=0", address)):
        while server.report is None and server.heard.wait(seconds):
            server.heard.clear()
    server.shutdown()
    if server.report is None:
        raise Silent(f"{page} reports nothing within {seconds} s")
    return server.report
