# SPDX-License-Identifier: MIT
#
# programs_test.py SKC SOURCE PRECISIONS FILE...: every program that skc prints for these .sk files, or for all of a
# folder, compiles and links in Chromium's WebGL2. PRECISIONS are skc's, with commas between. Chromium draws with
# SwiftShader, so that no GPU is needed. A program that WebGL forbids must be rejected, which shows that the test can fail.
import concurrent.futures
import html
import json
import os
import re
import resource
import subprocess
import sys
import tempfile

import chromium

sys.path.append(os.path.join(os.path.dirname(__file__), "../support"))
import sk_files

skc, source, precisions = sys.argv[1], os.path.realpath(sys.argv[2]), sys.argv[3].split(",")
named = sys.argv[4:]
programs_of_a_page = 400  # Chromium starts as long as it compiles some fifty
seconds_of_a_page = 1500  # some 5 of CPU time, on a machine that has much else to do



page = """<!DOCTYPE html><meta charset="utf-8"><pre id="report"></pre><script>
"use strict";
const programs = %s;
const corners = `
void main() { gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0, float(gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);`;

// The vertex program of a draw: a strip of corners, or, for a program of points, one that hands on their number.
function vertexProgram(fragment) {
  const relayed = [...fragment.matchAll(/^flat in (\\w+) (\\w+);/gm)];
  const outputs = relayed.map(([, type, name]) => `flat out ${type} ${name};\\n`).join("");
  const values = relayed.map(([, type, name]) => ` ${name} = ${type}(gl_VertexID);`).join("");
  return "#version 300 es\\n" + outputs + corners + values + " }\\n";
}

function compiled(gl, stage, text) {
  const shader = gl.createShader(stage);
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  return shader;
}

// Why a program does not compile or link; "" if it does.
function mistake(gl, text) {
  const shaders = [compiled(gl, gl.VERTEX_SHADER, vertexProgram(text)), compiled(gl, gl.FRAGMENT_SHADER, text)];
  const program = gl.createProgram();
  for (const shader of shaders) gl.attachShader(program, shader);
  gl.linkProgram(program);
  let log = "";
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    log = shaders.map((shader) => gl.getShaderInfoLog(shader)).join("") + gl.getProgramInfoLog(program);
    if (gl.isContextLost()) log += "the context is lost";
    log = log.replace(/\\0/g, "") || "no reason given";
  }
  for (const shader of shaders) gl.deleteShader(shader);
  gl.deleteProgram(program);
  return log;
}

const gl = document.createElement("canvas").getContext("webgl2");
const report = gl ? { mistakes: programs.map((text) => mistake(gl, text)) } : { why: "there is no WebGL2" };
document.getElementById("report").textContent = JSON.stringify(report);
</script>
"""


def printed(file, precision, profile):
    """The programs that skc prints for a file: {text: name}. None for a file without kernels, which others include."""
    command = [skc, "--emit=glsl", f"--profile={profile}", f"--precision={precision}", *sk_files.options(source), file]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode:
        if "declares no kernel, no reduce and no scan" in result.stderr:
            return {}
        sys.exit(f"skc rejects {file}:\n{result.stderr}")
    texts = re.split(r"^(?=#version )", result.stdout, flags=re.M)
    name = os.path.relpath(file, source)
    return {text: f"{name}, {precision}: {text.splitlines()[1][3:]}" for text in texts if text.startswith("#version")}


def gathered():
    """All programs, each once: {text: name}."""
    jobs = [(file, precision, "webgl2") for file in sk_files.files(source, named) for precision in precisions]
    programs = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for some in pool.map(lambda job: printed(*job), jobs):
            for text, name in some.items():
                programs.setdefault(text, name)
    return programs


def browsed(command):
    """Status, output and messages of Chromium."""
    with chromium.started(command) as browser:
        try:
            output, errors = browser.communicate(timeout=seconds_of_a_page)
            return browser.returncode, output, errors
        except subprocess.TimeoutExpired:
            sys.exit(f"Chromium did not end within {seconds_of_a_page} s")


def mistakes(texts):
    """What Chromium says of each program: "" if it compiles and links."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "programs.html")
        with open(file, "w") as opened:
            opened.write(page % json.dumps(texts).replace("<", "\\u003c"))
        # Linking alone: SwiftShader would generate code for each program, which takes seconds for pairs of floats.
        linking = "--disable-angle-features=warmUpPipelineCacheAtLink"
        command = chromium.command(folder, "--dump-dom", linking, f"file://{file}")
        status, output, errors = browsed(command)
    report = re.search(r'<pre id="report">(.+?)</pre>', output, re.S)
    if not report:
        sys.exit(f"Chromium ended with status {status} and no report:\n{errors[-2000:]}")
    answer = json.loads(html.unescape(report[1]))
    if "why" in answer:
        sys.exit(f"Chromium: {answer['why']}\n{errors[-2000:]}")
    return answer["mistakes"]


chromium.need()
programs = gathered()
if not programs:
    sys.exit("no program was printed")
texts = list(programs)
# The same choices of structs as ES allows them.
forbidden = list(printed(os.path.join(source, "tests/run/programs/bitonic_sort.sk"), "single", "essl300"))
texts += [text for text in forbidden if text not in programs]
pages = [texts[first : first + programs_of_a_page] for first in range(0, len(texts), programs_of_a_page)]
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:  # each Chromium compiles in one thread
    found = [why for answer in pool.map(mistakes, pages) for why in answer]
bad = [(programs[text], why) for text, why in zip(texts, found) if why and text in programs]
for name, why in bad:
    print(f"{name}\n  {why.strip()}")
rejected = [text for text, why in zip(texts, found) if text in forbidden and "ternary operator" in why]
if not rejected:
    print("WebGL no longer rejects '?:' of structs: the profile webgl2 needs no expand-selects, or nothing was compiled")

used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(f"{len(programs) - len(bad)} of {len(programs)} programs compile and link ({used.ru_utime + used.ru_stime:.0f} s of CPU time)")
sys.exit(1 if bad or not rejected else 0)
