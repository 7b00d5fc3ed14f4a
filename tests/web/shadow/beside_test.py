# SPDX-License-Identifier: MIT
#
# beside_test.py SKC SOURCE BUILD: what device.shadow() says of pages with one fault, in Chromium. Its reports have the schema of SK_SHADOW.
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

import jsonschema

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
import chromium
import package

skc, source, build = sys.argv[1], os.path.realpath(sys.argv[2]), os.path.realpath(sys.argv[3])
here = os.path.dirname(os.path.realpath(__file__))
seconds = 200  # a few, on a machine that has nothing else to do

chromium.need()
with open(os.path.join(source, "docs/shadow.schema.json")) as file:
    validator = jsonschema.Draft202012Validator(json.load(file))
with tempfile.TemporaryDirectory() as folder:
    package.build(source, f"{folder}/streamkernel", build)
    shutil.copy(f"{here}/beside.sk", f"{folder}/without.sk")
    subprocess.run([skc, "--emit=js", "--shadow", "-o", folder, f"{here}/beside.sk"], check=True)
    subprocess.run([skc, "--emit=js", "-o", folder, f"{folder}/without.sk"], check=True)
    for name in ("index.html", "beside.mjs"):
        os.symlink(f"{here}/{name}", f"{folder}/{name}")
    report = chromium.report_of(folder, "index.html", seconds)

mistakes = report["mistakes"]
for name, found in report["reports"].items():
    mistakes += [f"the report '{name}' is not what the schema says: {error.json_path}: {error.message}" for error in validator.iter_errors(found)]
embedded = re.search(r"const report = (.*?);</script>", report.get("html", ""), re.S)
mistakes += [] if embedded and json.loads(embedded[1])["calls"] == 8 else ["the page has no report, or another one"]
for mistake in mistakes:
    print(mistake)
print(f"{report['checks']} checks, {len(report['reports'])} reports, {len(mistakes)} mistakes")
sys.exit(1 if mistakes or report["checks"] < 40 else 0)
