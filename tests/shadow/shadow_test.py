# SPDX-License-Identifier: MIT
#
# shadow_test.py PROGRAM DEVICE SOURCE: runs programs with one bad kernel under a shadow, whose first line must name the kernel;
# and programs that end in odd ways, whose own results must not change.
import json
import math
import os
import subprocess
import sys
import tempfile
import zipfile

program, device, source = os.path.realpath(sys.argv[1]), sys.argv[2], os.path.realpath(sys.argv[3])
folder = tempfile.TemporaryDirectory()
failures = []


def check(holds, text):
    if not holds:
        failures.append(text)
        print(f"FAILED: {text}")


def run(name, shadow="report.html", **variables):
    """The finished process of a program, and its report; None if there is none."""
    environment = {**os.environ, "SK_DEVICE": device, **variables}
    environment.pop("SK_SHADOW", None)
    if shadow:
        environment["SK_SHADOW"] = shadow
    report = os.path.join(folder.name, "report.json")
    for file in (report, os.path.join(folder.name, "report.html")):
        if os.path.exists(file):
            os.remove(file)
    done = subprocess.run([program, name], capture_output=True, text=True, cwd=folder.name, env=environment)
    if not os.path.exists(report):
        return done, None
    with open(report) as file:
        return done, json.load(file)


def first(report):
    return report["verdicts"][0] if report["verdicts"] else {"kind": "none", "kernel": "", "text": "no verdict"}


# One bad kernel each, and what the first line of the report says.
faults = {
    "half": ("error", "faults::advance"),
    "stored": ("storage", "faults::advance"),
    "nan": ("nan", "faults::root"),
    "floatnan": ("nan", "faults::angle"),
    "infinity": ("infinity", "faults::square"),
    "flush": ("flush", "faults::vanish"),
    "flip": ("decision", "faults::flip"),
    "cell": ("decision", "faults::cell"),
    "table": ("error", "faults::response"),
    "cancel": ("error", "faults::spread"),
    "mixed": ("error", "faults::advance"),
    "late": ("error", "faults::spread"),
    "unstable": ("unstable", "faults::diffuse"),
    "watched": ("unstable", "faults::diffuse"),
    "sorted": ("decision", "sk::sort"),
    "ordered": ("decision", "sk::order"),
    "unique": ("decision", "sk::unique"),
    "counted": ("decision", "faults::keep"),
    "nearest": ("error", "faults::measure"),
    "sum": ("error", "faults::pairs"),
    "push": ("decision", "faults::keep"),
}
for name, (kind, kernel) in faults.items():
    plain, _ = run(name, shadow=None)
    done, report = run(name)
    check((done.returncode, done.stdout, done.stderr) == (plain.returncode, plain.stdout, plain.stderr),
          f"{name}: the program's own output changes: {done.stdout[:200]} {done.stderr[:200]} / {plain.stdout[:200]}")
    verdict = first(report)
    check(verdict["kind"] == kind and verdict["kernel"] == kernel and (kernel in verdict["text"]),
          f"{name}: the first line is {verdict}, not {kind} of {kernel}; all: {report['verdicts']}")
    if name == "stored":
        stored = next(k for k in report["kernels"] if k["name"] == kernel)
        part = stored["storage"]["largest"] / stored["own"]["largest"]
        check("storing 'v' in halves" in verdict["text"] and "store it in floats" in verdict["text"], f"stored: {verdict}")
        check(0.9 < part < 1.1, f"stored: {part} of the own error is storing")
    if name == "counted":
        count = next((r for r in report["results"] if r["name"].endswith("(number of elements)")), None)
        check(count is not None and count["differs"] == 1, f"counted: {report['results']}")
    if name == "unique":
        count = next((r for r in report["results"] if "sk::unique" in r["name"]), None)
        check(count is not None and count["differs"] == 1, f"unique: {report['results']}")
    if name == "nan":
        check(verdict["call"] == 3002, f"nan: in call {verdict['call']}")  # ramp, then 1,000 steps of three calls

# Doubles that floats store: not where a kernel computes in floats, too.
if device == "native":
    done, report = run("widened")
    check(first(report)["kind"] == "storage" and "store it in doubles" in first(report)["text"], f"widened: {report['verdicts']}")
    check(all(k["storage"] is None for k in report["kernels"] if k["name"] != "faults::advance"), f"widened: {report['kernels']}")
_, report = run("half")
check(all(k["storage"] is None for k in report["kernels"]), f"half: {report['kernels']}")

# Calls that are not compared: what they add is not what others do.
_, report = run("unseen", shadow="report.html,every=2")
check(first(report)["kernel"] == "faults::advance", f"unseen: {report['verdicts']}")
total = next(r for r in report["results"] if r["name"] == "faults::total")
check(total["reads"] == 2 and total["error"]["last"] > 1e-6, f"unseen: {total}")
check(max(total["shares"], key=lambda each: each["share"])["kernel"] == "(calls that were not compared)", f"unseen: {total}")
_, report = run("unseen", shadow="report.html,kernels=faults::smooth")
check("faults::advance or faults::gain or faults::ramp, which are not compared" in first(report)["text"], f"unseen: {report['verdicts']}")
_, report = run("unseen", shadow="report.html,kernels=faults::smooth,kernels=faults::gain,kernels=faults::ramp")
check("arises in, or is magnified by, faults::advance, which is not compared" in first(report)["text"], f"unseen: {report['verdicts']}")
# A kernel of which no call is compared may add errors, magnify them or drop them: what passes through it is nobody else's.
for name, kernels, unknown in (("hidden", [], None), ("steep", [], None), ("hidden", ["spread"], "offset"), ("hidden", ["offset"], None),
                               ("steep", ["offset"], "slope"), ("steep", ["spread"], "slope or faults::offset"),
                               ("steep", ["spread", "offset"], "slope"), ("steep", ["spread", "offset", "slope"], None)):
    _, report = run(name, shadow="report.html" + "".join(f",kernels=faults::{kernel}" for kernel in kernels))
    text, of_spread = first(report)["text"], next(k for k in report["kernels"] if k["name"] == "faults::spread")["share"]
    expected = f"arises in, or is magnified by, faults::{unknown}, which" if unknown else "faults::offset adds"
    check(expected in text and of_spread < 0.1, f"{name}, {kernels}: {of_spread} {report['verdicts']}")
    if unknown:
        check(text.endswith("too: kernels=faults::" + unknown.replace(" or ", ",kernels=")), f"{name}, {kernels}: {text}")
for every in (1, 2, 4, 7):
    _, report = run("steady", shadow=f"report.html,every={every}")
    check(first(report)["kind"] == "error" and first(report)["kernel"] == "faults::advance", f"steady: {report['verdicts']}")

# Orders: the reference has its own, or takes over the device's.
for name in ("sorted", "ordered", "unique"):
    for decisions, isFollowed in (("own", False), ("follow", True)):
        _, report = run(name, shadow=f"report.html,decisions={decisions}")
        read = [r["error"]["largest"] for r in report["results"] if "number of elements" not in r["name"]]
        check(all((error < 1e-6) == isFollowed for error in read), f"{name}, {decisions}: {report['results']}")
        check(report["decisions"] and report["decisions"][0]["kernel"].startswith("sk::"), f"{name}: {report['decisions']}")

# What an element was computed from, where its index does not say.
_, report = run("everything")
sources = {k["name"]: k["worst"].get("source", "") for k in report["kernels"] if k["worst"]}
inputs = {k["name"]: k["worst"]["inputs"] for k in report["kernels"] if k["worst"]}
check(sources["everything::relax"].startswith("of a gather"), f"{sources}")
check(any(i["parameter"] == "u" and len(i["at"]) == 2 for i in inputs["everything::relax"]), f"{inputs['everything::relax']}")
check(sources["everything::spread"].startswith("which elements were scattered"), f"{sources}")
check(sources["everything::prefix"].startswith("it was computed from all elements up to"), f"{sources}")
check(sources["everything::sum"].startswith("it was computed from several elements: of 97 of x"), f"{sources}")
check(sources["everything::split"] == "" and "at" not in inputs["everything::split"][0], f"{sources}")

# A number in the place of one element changes no other, also of a stream that holds more digits than floats.
plain, _ = run("wide", shadow=None)
done, report = run("wide", shadow="report.html,set=faults::gain.x[7]:nan")
before, after = plain.stdout.split(), done.stdout.split()
check([i for i, (a, b) in enumerate(zip(before, after)) if a != b] == [7], f"wide: {done.stdout[:200]}")
done, report = run("wide", shadow="report.html,set=faults::gain.x[7]:0.7,given=list")
check(abs(float.fromhex(done.stdout.split()[7]) - (0.7 + 0.125)) < 1e-13, f"wide: {done.stdout.split()[7]}")
given = next(g for g in report["given"] if g["parameter"] == "x")
check(abs(given["low"] - 0.1) < 1e-13, f"wide: {given}")

done, report = run("fine")
check(first(report)["kind"] == "fine", f"fine: {report['verdicts']}")
_, report = run("narrowed")
check(first(report)["kernel"] == "" and "the host has written or copied brings 100 %" in first(report)["text"], f"narrowed: {report['verdicts']}")
check(not report["notes"], f"fine: {report['notes']}")

# Every kind of call: the same bits, and all of them are followed.
plain, _ = run("everything", shadow=None)
done, report = run("everything")
check(plain.returncode == 0 and plain.stdout == done.stdout and done.stderr == "",
      f"everything: {plain.stderr}{done.stderr}")
check(report["calls"] == report["followed"] and not report["notes"],
      f"everything: {report['followed']} of {report['calls']} calls are followed; {report['notes']}")
worst = max((result["error"]["largest"] for result in report["results"]), default=1)
check(worst < 2e-3, f"everything: {report['results']}")  # halves


def own_errors(report, name):
    """The own error of each call of a kernel."""
    kernel = next(k for k in report["kernels"] if k["name"] == name)
    return [point[1] for point in kernel["outputs"][0]["points"]]


# The own error of each call is what the program finds by itself, whatever has changed the elements that the call reads.
for name in ("replay", "changes"):
    done, report = run(name)
    expected = [float(line) for line in done.stdout.split()]
    found = own_errors(report, "faults::advance")
    check(done.returncode == 0 and not report["notes"], f"{name}: {done.stderr} {report['notes']}")
    check(len(found) == len(expected), f"{name}: {len(found)} points for {len(expected)} calls")
    for call, (a, b) in enumerate(zip(found, expected)):
        check(math.isclose(a, b, rel_tol=1e-6), f"{name}: the own error of call {call} is {a}, not {b}")

# The worst element of a call, and what it should be.
for threads in ("1", "4"):
    done, report = run("worst", OMP_NUM_THREADS=threads)
    worst = next(k for k in report["kernels"] if k["name"] == "faults::square")["worst"]
    square = (1.1 + 2.384185791015625e-08) ** 2  # of the float that is nearest to 1.1
    check(worst["element"] == [456, 789] and math.isclose(float.fromhex(worst["reference"]["hex"]), square, rel_tol=1e-15),
          f"worst with {threads} threads: {worst}")

# Doubles that are wrong in the same way on the reference: only quadruple precision shows it.
if device == "native":
    done, report = run("precise")
    check(own_errors(report, "precise::spread") == [0], f"precise: {own_errors(report, 'precise::spread')} in double")
    done, report = run("precise", shadow="report.html,quad=precise::*")
    found, expected = own_errors(report, "precise::spread"), float(done.stdout)
    check(expected > 0.1 and math.isclose(found[0], expected, rel_tol=1e-6), f"precise: {found}, not {expected}")
    check(not report["notes"], f"precise: {report['notes']}")
    done, report = run("replay", shadow="report.html,quad=faults::advance")
    check(any("faults::advance" in note and "--quad" in note for note in report["notes"]), f"quad: {report['notes']}")

# The reference and all copies for it take at most twice the doubles of the program's streams, and what one call needs at once:
# its inputs, and the results of the device and of the reference. A tenth is for the heap and the report.
if device == "native":
    done, report = run("memory", shadow=None)
    plain = int(done.stdout.split()[2])
    done, report = run("memory")
    doubles, largest, used = (int(word) for word in done.stdout.split())
    most = 2 * doubles + 3 * largest
    check(used - plain <= 1.1 * most, f"memory: {(used - plain) / doubles:.2f} times the doubles, allowed {1.1 * most / doubles:.2f}")
    check(used - plain >= doubles, f"memory: {used - plain} bytes are less than the reference takes")

# Ways to end.
for name, status in {"exit": 3, "abort": -6, "fork": 0}.items():
    plain, _ = run(name, shadow=None)
    done, report = run(name)
    check(done.returncode == status and done.stdout == plain.stdout and done.stderr == plain.stderr,
          f"{name}: {done.returncode} {done.stderr}")
    check(report is not None and (report["ended"] == "normally") == (name != "abort"),
          f"{name}: {report and report['ended']}")
done, report = run("throw")
check(done.returncode == -6 and report["calls"] == 7 and report["ended"] == "early: an exception after 7 calls",
      f"throw: {done.returncode} {report['calls']} {report['ended']}")
done, report = run("abort")
check(report["calls"] > 0, f"abort: {report['calls']}")
check(report["results"] or first(report)["text"] == "the program has read no result up to this report", f"abort: {first(report)}")
calls = f"after {report['calls']} call" + ("" if report["calls"] == 1 else "s")
check(report["ended"].endswith(calls), f"abort: {report['ended']}")
done, report = run("chdir")
check(report["ended"] == "normally" and done.stderr == "", f"chdir: {report['ended']} {done.stderr}")
plain, _ = run("fine", shadow=None, SK_DEVICE="reference")
done, report = run("fine", SK_DEVICE="reference")
text = "the reference device has no shadow"
check(done.stdout == plain.stdout and done.stderr.startswith(f"SK_SHADOW: {text}"), f"reference: {done.stderr}")
check(first(report)["text"] == "no call was compared; the notes say why" and report["notes"][0].startswith(text),
      f"reference: {report['verdicts']} {report['notes']}")
done, report = run("nothing")
check(done.stdout == "1\n" and first(report)["text"] == "the program has called no kernel", f"nothing: {first(report)}")
done, report = run("devices")
check(first(report)["kernel"] == "faults::square", f"devices: {first(report)}")
done, report = run("overwrite")
own, other = (os.path.join(folder.name, name) for name in ("report.html", "report-2.html"))
with open(own) as file:
    check(file.read() == "the program's own\n", "overwrite: the program's own file was replaced")
check(os.path.exists(other) and "report-2.html" in done.stderr, f"overwrite: {done.stderr}")
names = sorted(name for name in os.listdir(folder.name) if name.startswith("report"))
check(names == ["report-2.html", "report-2.json", "report.html"], f"overwrite: {names}")
for name in names[:2]:
    os.remove(os.path.join(folder.name, name))

# Two processes whose reports have one name: the page and the JSON of each stay together.
environment = {**os.environ, "SK_DEVICE": device, "SK_SHADOW": "report.html"}
with subprocess.Popen([program, "wait"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                      cwd=folder.name, env=environment) as waiting:
    waiting.stdout.readline()
    subprocess.run([program, "nothing"], stdout=subprocess.DEVNULL, cwd=folder.name, env=environment)
    _, said = waiting.communicate("\n")
reports = {}
for name in sorted(name for name in os.listdir(folder.name) if name.startswith("report")):
    with open(os.path.join(folder.name, name)) as file:
        text = file.read()
    os.remove(os.path.join(folder.name, name))
    reports[name] = next(mode for mode in ("wait", "nothing") if f'"program":"shadow_program {mode}"' in text)
check(reports == {"report-2.html": "wait", "report-2.json": "wait", "report.html": "nothing", "report.json": "nothing"},
      f"two processes: {reports} {said}")

# What cannot be followed is said, and changes nothing.
plain, _ = run("fine", shadow=None)
for shadow, text in {
    "report.txt": "SK_SHADOW: the report is 'report.txt'; give a file whose name ends in .html",
    "nowhere/report.html": "SK_SHADOW: cannot write 'nowhere/report.html'",
    "report.html,evry=2": "SK_SHADOW: there is no option 'evry'; did you mean 'every'?",
    "report.html,every=0": "SK_SHADOW: every is '0'; give a number of calls from 1 on",
    "report.html,memory=8Q": "SK_SHADOW: memory is '8Q'",
    "report.html,decisions=mine": "SK_SHADOW: decisions is 'mine'; give own or follow",
}.items():
    done, report = run("fine", shadow=shadow)
    check(done.returncode == 0 and done.stdout == plain.stdout and done.stderr.startswith(text),
          f"{shadow}: {done.stderr}")
    check("the program runs without a shadow" in done.stderr, f"{shadow}: {done.stderr}")
done, report = run("fine", shadow="report.html,memory=1K")
check(done.stdout == plain.stdout and any("memory" in note for note in report["notes"]), f"memory: {report['notes']}")
check(first(report)["kind"] == "nothing", f"memory: {report['verdicts']}")
done, report = run("fine", shadow="report.html,kernels=faults::adv*,every=2")
check([k["followed"] for k in report["kernels"] if k["name"] == "faults::advance"] == [1], "kernels=: not followed")
check(all(k["followed"] == 0 for k in report["kernels"] if k["name"] != "faults::advance"), "kernels=: others are followed")
done, report = run("fine", shadow="report.html,kernels=faults::advanse,kernels=faults::gain")
text = "kernels=faults::advanse matches no kernel that the program has called; did you mean 'faults::advance'?"
check(done.stdout == plain.stdout and done.stderr == f"SK_SHADOW: {text}\n" and text in report["notes"],
      f"kernels=: {done.stderr} {report['notes']}")
done, report = run("cell", shadow="report.html,decisions=follow")
check(all(result["error"]["largest"] < 1e-6 for result in report["results"]), f"follow: {report['results']}")
done, report = run("fine", SK_CHECK="written")
check(done.stdout == plain.stdout and "SK_CHECK=written" in report["notes"][0], f"written: {report['notes']}")

# Names of files may have commas, backslashes and percent signs; a backslash keeps the first two, and %% stands for a percent sign.
odd = os.path.join(folder.name, r"a, b=c\d")
os.mkdir(odd)
done, _ = run("half", shadow=r"a\, b=c\\d/100%%p x.html,every=1,inputs=a\, b=c\d/in\,puts=.npz")
check(done.stderr == "" and sorted(os.listdir(odd)) == ["100%p x.html", "100%p x.json", "in,puts=.npz"],
      f"odd names: {done.stderr} {os.listdir(odd)}")
# A name may be as long as the system lets it.
long = "r" * 250
done, _ = run("half", shadow=f"{long}.html")
check(done.stderr == "" and os.path.exists(os.path.join(folder.name, long + ".json")), f"long name: {done.stderr}")
done, _ = run("half", shadow=f"{long}r.html")
check("File name too long; the program runs without a shadow" in done.stderr, f"too long name: {done.stderr}")

# The inputs of the worst calls, which sk accuracy takes.
done, report = run("half", shadow="report.html,inputs=recorded.npz")
with zipfile.ZipFile(os.path.join(folder.name, "recorded.npz")) as archive:
    names = set(archive.namelist())
expected = {"faults::advance/dt.npy", "faults::advance/u.npy", "faults::advance/r.shape.npy", "faults::smooth/u.npy"}
check(expected <= names, f"inputs: {sorted(names)}")

sys.exit(1 if failures else 0)
