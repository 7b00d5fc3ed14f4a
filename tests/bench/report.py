#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Tells what benchmarks have measured: report.py RESULTS.json ... [--json FILE] [--chart DIR] [--document FILE [--machine NAME]].

The files are what sk_race, sk_bench and torch_peer.py write; together they are one set of results. Prints a table for each
of our contenders, and which bars hold. A ratio here is a peer's time over ours: how many times as fast we are.
"""
import argparse
import datetime
import json
import os
import re
import sys

import bars
import charts
import results


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", metavar="RESULTS.json")
    parser.add_argument("--json", metavar="FILE", help="write all results to one file")
    parser.add_argument("--chart", metavar="DIR", help="draw performance.svg, performance-sizes.svg and the same as .png")
    parser.add_argument("--document", metavar="FILE",
                        help="write the tables between the marks <!-- bench NAME --> and <!-- /bench -->")
    parser.add_argument("--machine", metavar="NAME", default="",
                        help="of the document's tables, write those of this machine: <!-- bench NAME ... -->")
    parser.add_argument("--date", metavar="YYYY-MM-DD", type=datetime.date.fromisoformat, default=datetime.date.today(),
                        help="the day of the measurements, for the document (default: today)")
    arguments = parser.parse_args()
    found = results.read(arguments.files)
    print_tables(found)
    held = bars.judge(found)
    measured = [row for row in held if row[2] != bars.NOT_MEASURED]
    if measured:
        print("\n" + results.plain(bars.head, measured))
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(found.document, file, indent=1)
            file.write("\n")
    if arguments.chart:
        os.makedirs(arguments.chart, exist_ok=True)
        charts.draw(found, arguments.chart)
    if arguments.document:
        update(arguments.document, arguments.machine, found, held, arguments.date)
    return 0


def print_tables(found):
    head, rows = results.steps_table(found)
    if rows:
        print("\n" + results.plain(head, rows))
    for ours in found.ours():
        head, rows = results.table_of(found, ours)
        print(f"\n{ours}: its time, and the peers' over that (above 1: {ours} is faster)\n")
        print(results.plain(head, rows))


def update(path, machine, found, held, date):
    """Replaces what is between the marks; a mark names a table: `bars`, or `held`, those of them that were measured; `machine`, `steps`, `rates`, `views`, `loops`, or
    one of our contenders, behind the name of another machine if that is given. Tables say when they were measured."""
    with open(path, encoding="utf-8") as file:
        text = file.read()

    def replaced(match):
        mark = match.group(1)
        if machine and not mark.startswith(machine + " "):
            return match.group(0)  # measured here
        name = mark[len(machine):].strip()
        if name == "bars":
            body = results.markdown(bars.head, held)
        elif name == "held":
            body = results.markdown(bars.head, [row for row in held if row[2] != bars.NOT_MEASURED])
        elif name == "rates":
            body = results.markdown(*results.rates_table(found))
        elif name == "machine":
            body = found.machine_text() + "\n"
        elif name == "steps":
            body = results.markdown(*results.steps_table(found))
        elif name in ("views", "loops"):
            head, rows = results.views_table(found) if name == "views" else results.loops_table(found)
            if not rows:
                return match.group(0)  # sk_bench was left out
            body = results.markdown(head, rows)
        elif name in found.ours():
            body = results.markdown(*results.table_of(found, name, largest_only=True))
        else:
            return match.group(0)  # measured elsewhere
        if name != "machine":
            body += f"\nMeasured on {date}.\n"
        return f"<!-- bench {mark} -->\n{body}<!-- /bench -->"

    text, count = re.subn(r"<!-- bench ([\w -]+?) -->\n.*?<!-- /bench -->", replaced, text, flags=re.S)
    if count == 0:
        sys.exit(f"report.py: '{path}' has no <!-- bench NAME --> and <!-- /bench -->")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    sys.exit(main())
