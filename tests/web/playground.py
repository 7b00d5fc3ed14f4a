# SPDX-License-Identifier: MIT
#
# Starts `sk serve` on a port that is free.
import contextlib
import os
import re
import signal
import subprocess

import chromium


@contextlib.contextmanager
def served(sk, skc, *arguments, share=None):
    """Host and port of a server, and what it says in its terminal."""
    environment = {**os.environ, **({"SK_SHARE": share} if share else {})}
    words = [sk, "serve", "--port", "0", "--skc", skc, *arguments]
    server = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
    try:
        line = server.stdout.readline()
        found = re.search(r"http://(127\.0\.0\.1):(\d+)/", line)
        if found is None:
            said = server.communicate()[1]
            if "without cpp-httplib" in said:
                print(f"skipped: {said.strip()}")
                os._exit(chromium.skipped)
            raise AssertionError(f"{' '.join(words)}: {line}{said}")
        yield found[1], int(found[2])
        server.send_signal(signal.SIGINT)
        assert server.wait(60) == 0, "Ctrl-C does not end the server"
    finally:
        server.kill()
        server.wait()
