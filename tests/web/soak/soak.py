# SPDX-License-Identifier: MIT
#
# soak.py SKC SOURCE BUILD [CALLS [SEED]]: makes calls of all kinds in Chromium in random order. The context's objects, the page's heap
# and the memory of Chromium's processes must not become more in the second half, and results keep their bits.
import os
import subprocess
import sys
import tempfile
import threading

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.realpath(__file__))))
import chromium
import package

skc, source, build = sys.argv[1], os.path.realpath(sys.argv[2]), os.path.realpath(sys.argv[3])
calls, seed = (int(given) for given in [*sys.argv[4:6], *["100000", "1"][len(sys.argv) - 4:]])
here = os.path.dirname(os.path.realpath(__file__))
seconds = 600  # of silence, for a hundredth of the calls
MOST_OBJECTS = 2300  # the idle textures that the package keeps, each with a framebuffer, and what lives beside them
MOST_HEAP = 2 << 20  # what the page's heap may have more in the second half, in bytes
MOST_MEMORY = 1.1  # what Chromium may have at the end, relative to the middle: its own caches come and go


def memory_of_children():
    """The bytes that are resident for this process's descendants."""
    parents, resident = {}, {}
    for entry in os.listdir("/proc"):
        try:
            with open(f"/proc/{entry}/stat") as stat, open(f"/proc/{entry}/statm") as statm:
                parents[int(entry)] = int(stat.read().rsplit(")", 1)[1].split()[1])
                resident[int(entry)] = int(statm.read().split()[1]) * os.sysconf("SC_PAGESIZE")
        except (OSError, ValueError):
            continue
    mine = {os.getpid()}
    while True:
        more = {process for process, parent in parents.items() if parent in mine} - mine
        if not more:
            break
        mine |= more
    return sum(resident.get(process, 0) for process in mine - {os.getpid()})


chromium.need()
os.environ["SK_CHROMIUM_OPTIONS"] = os.environ.get("SK_CHROMIUM_OPTIONS", "") + " --js-flags=--expose-gc --enable-precise-memory-info"
samples, ended = [], threading.Event()


def watch():
    while not ended.wait(2):
        samples.append(memory_of_children())


threading.Thread(target=watch, daemon=True).start()
with tempfile.TemporaryDirectory() as folder:
    package.build(source, f"{folder}/streamkernel", build)
    for file in ("calls/calls.sk", "soak/soak.sk"):
        subprocess.run([skc, "--emit=js", "-o", folder, f"{here}/../{file}"], check=True)
    for name in ("index.html", "soak.mjs"):
        os.symlink(f"{here}/{name}", f"{folder}/{name}")
    report = chromium.report_of(folder, f"index.html?calls={calls}&seed={seed}", seconds)
ended.set()

mistakes = report["mistakes"]
for one in report["samples"]:
    print(f"{100 * one['done'] / calls:4.0f} %: {one['objects']} GL objects, {one['heap'] / 2**20:.1f} MiB of the page's heap")
if len(report["samples"]) >= 10:
    # idle textures come and go within their limit
    objects, heap = ([max(one[what] for one in half) for half in (report["samples"][:5], report["samples"][5:])] for what in ("objects", "heap"))
    if objects[1] > max(MOST_OBJECTS, objects[0] * 1.1):
        mistakes.append(f"there were up to {objects[0]} GL objects in the first half, and {objects[1]} in the second")
    if heap[1] > heap[0] + MOST_HEAP:
        mistakes.append(f"the page's heap had up to {heap[0]} bytes in the first half, and {heap[1]} in the second")
if len(samples) >= 20:
    tenth = len(samples) // 10
    middle, end = (max(samples[i - tenth:i]) / 2**20 for i in (len(samples) // 2, len(samples)))
    print(f"Chromium's processes: {middle:.0f} MiB in the middle, {end:.0f} MiB at the end")
    if end > MOST_MEMORY * middle:
        mistakes.append(f"Chromium's memory grows from {middle:.0f} to {end:.0f} MiB")
if report.get("left"):
    mistakes.append(f"{report['left']} GL objects are left after dispose()")
for mistake in mistakes:
    print(mistake)
print(f"{calls} calls of seed {seed}, {len(mistakes)} mistakes")
sys.exit(1 if mistakes else 0)
