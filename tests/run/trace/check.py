# SPDX-License-Identifier: MIT
#
# check.py PROGRAM: runs trace_program's scenarios and reads their traces back. The device is that of SK_DEVICE.
import json
import os
import subprocess
import sys
import tempfile

failures = []


def check(what, holds, *found):
    if not holds:
        failures.append(f"{what}: {found}")


def run(folder, scenario, **environment):
    """The events of a scenario, and whether its process ended well."""
    file = os.path.join(folder, f"{scenario}.json")
    ended = subprocess.run(
        [sys.argv[1], scenario],
        env={**os.environ, "SK_TRACE": file, "SK_CACHE": os.path.join(folder, "cache"), **environment},
        stderr=subprocess.DEVNULL,
    )
    with open(file) as trace:
        return json.load(trace)["traceEvents"], ended.returncode == 0


def slices(events, category, name=None):
    found = [e for e in events if e["ph"] == "X" and e["cat"] == category]
    return [e for e in found if name in (None, e["name"])]


def tracks(events):
    return {e["tid"]: e["args"]["name"] for e in events if e["name"] == "thread_name"}


def is_inside(inner, outer):
    slack = 0.002  # decimals of both times
    return (
        outer["ts"] <= inner["ts"] + slack
        and inner["ts"] + inner["dur"] <= outer["ts"] + outer["dur"] + slack
    )


def check_nesting(events):
    """Two slices of a track lie one in the other, or beside each other."""
    for track in tracks(events):
        open_slices = []
        for e in sorted(slices_of(events, track), key=lambda e: (e["ts"], -e["dur"])):
            while open_slices and open_slices[-1]["ts"] + open_slices[-1]["dur"] <= e["ts"] + 0.002:
                open_slices.pop()
            check("nesting", not open_slices or is_inside(e, open_slices[-1]), e, open_slices)
            open_slices.append(e)


def slices_of(events, track):
    return [e for e in events if e["ph"] == "X" and e["tid"] == track]


def check_calls(events, clock):
    host = [t for t, name in tracks(events).items() if name.startswith("host thread")]
    device = [t for t, name in tracks(events).items() if not name.startswith("host thread")]
    check("one track each", len(host) == 1 and len(device) == 1, tracks(events))
    calls = slices(events, "call")
    check("calls", [c["name"] for c in calls] == ["saxpy", "saxpy", "blur", "saxpy", "total", "pick"], calls)
    check("domain of a call", calls[0]["args"]["domain"] == "{512, 512}", calls[0])

    def passes(name, track):
        return sorted((p for p in slices(events, "pass", name) if p["tid"] == track), key=lambda p: p["ts"])

    mebibyte = 1 << 20
    for track in host + device:
        found = passes("saxpy", track)
        check("passes of saxpy", len(found) == 3, found)
        for p in found:
            check("bytes read", p["args"]["bytes read"] == 2 * mebibyte, p)
            check("bytes written", p["args"]["bytes written"] == mebibyte, p)
            check("kernel", p["args"]["kernel"] == "saxpy" and p["args"]["domain"] == "{512, 512}", p)
        blur = passes("blur", track)[0]["args"]
        check("bytes of views", blur["bytes read"] == blur["bytes written"] == 64 * 64 * 4, blur)
        fold = passes("total: fold", track)[0]["args"]
        check("bytes of a fold", fold["bytes read"] == mebibyte, fold)
    for call, p in zip(slices(events, "call", "saxpy"), passes("saxpy", host[0])):
        check("a host pass is in its call", is_inside(p, call), p, call)
    for p in passes("saxpy", device[0]):
        check("clock", p["args"]["clock"] == clock, p)
        rate = 3 * mebibyte / (p["dur"] * 1000)
        check("GB/s", abs(p["args"]["GB/s"] - rate) < 0.01 * rate, p)
        check("of copy bandwidth", p["args"]["of copy bandwidth"] > 0, p)
    whole = [t for t in slices(events, "transfer") if t["args"].get("shape") == "{512, 512}"]
    writes, reads = [[t for t in whole if t["name"] == name] for name in ("write", "read")]
    check("writes", [w["args"]["bytes"] for w in writes] == 2 * [mebibyte], writes)
    check("name of a stream", [w["args"]["stream"] for w in writes] == ["x", ""], writes)
    check("reads", [r["args"]["bytes"] for r in reads] == [mebibyte], reads)
    in_use = [e["args"]["in use"] for e in events if e["ph"] == "C"]
    check("bytes of streams", max(in_use) >= 3 * mebibyte and in_use[-1] == 0, in_use)
    programs = slices(events, "program", "saxpy")
    if os.environ.get("SK_DEVICE") == "native":
        check("programs", not programs, programs)
    else:
        check("saxpy is compiled once", len(programs) == 1 and is_inside(programs[0], calls[0]), programs)
        compiled = [p["args"]["cache"] for p in slices(events, "program", "compile")]
        check("first time or not", all(c == compiled[0] for c in compiled), compiled)
        check("compiling", len(slices(events, "program", "compile")) >= 4, programs)
    check("waiting", len(slices(events, "wait", "finish")) == 1)


def main():
    is_native = os.environ.get("SK_DEVICE") == "native"
    with tempfile.TemporaryDirectory() as folder:
        clock = "wall clock" if is_native else "wall clock around glFinish"
        events, ended = run(folder, "calls")
        check("calls end", ended)
        check_calls(events, clock)
        check_nesting(events)
        if not is_native:
            events, ended = run(folder, "calls", SK_TRACE_CLOCK="timer")
            check("calls end, timed by queries", ended)
            check_calls(events, "GL timer query")
            check_nesting(events)
            # As what is drawn, whatever a trial would choose: a fold, in software one of long columns, and what combines.
            events, ended = run(folder, "shapes", SK_PROFILE="glsl330")
            programs = [len(slices(events, "program", name)) for name in ("saxpy", "total")]
            check("no shape makes a program", ended and programs[0] == 1 and programs[1] in (2, 3), programs)
        events, ended = run(folder, "exit")
        check("what was before an exit", ended and len(slices(events, "call", "saxpy")) == 1, events)
        events, ended = run(folder, "throw")
        check("what was before an exception", not ended and len(slices(events, "call", "saxpy")) == 1, events)
        events, ended = run(folder, "threads")
        check("threads", ended and len(tracks(events)) == 4, tracks(events))
        check("calls of threads", len(slices(events, "call", "saxpy")) == 40, events)
        check_nesting(events)
    for failure in failures:
        print(failure)
    sys.exit(1 if failures else 0)


main()
