# SPDX-License-Identifier: MIT
#
# node_test.py SOURCE SKC DECISIONS BUILD: the tests of runtime/web that need no browser, run by Node. DECISIONS prints what the C++
# runtime decides.
import os
import shutil
import subprocess
import sys
import tempfile

import package

source, skc, decisions, build = os.path.realpath(sys.argv[1]), os.path.realpath(sys.argv[2]), sys.argv[3], sys.argv[4]
here = os.path.dirname(os.path.realpath(__file__))

node = shutil.which("node")
if not node:
    print("skipped: node is not installed; './dev test web' installs it")
    sys.exit(package.skipped)
with tempfile.TemporaryDirectory() as folder:
    package.build(source, f"{folder}/streamkernel", build)
    with open(f"{folder}/streamkernel/package.json", "w") as marker:
        marker.write('{"type": "module"}')
    with open(f"{folder}/decisions.json", "w") as corpus:
        subprocess.run([decisions], stdout=corpus, check=True)
    environment = {"SK_WEB": folder, "SK_SKC": skc, "SK_SOURCE": source}
    tests = [os.path.join(here, "node", name) for name in sorted(os.listdir(f"{here}/node"))]
    sys.exit(subprocess.run([node, "--test", *tests], env={**os.environ, **environment}).returncode)
