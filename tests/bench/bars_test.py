#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Promises: bars about loops hold and fail where they should; a ratio is a peer's time over ours."""
import unittest

import bars
import results


def found(seconds):
    """Results with these times, of (program, log2, contender)."""
    runs = [{"program": program, "log2": log2, "contender": contender, "ours": contender.startswith("native"), "element": "cells",
             "operations": 1.0, "bytes": 1.0, "seconds": [time, time, time], "file": 0}
            for (program, log2, contender), time in seconds.items()]
    return results.Results({"machines": [], "runs": runs})


def verdicts(seconds):
    """Whether bars hold, by their names, of those that were measured."""
    return {row[0]: row[3] for row in bars.judge(found(seconds)) if row[2] != bars.NOT_MEASURED}


class Loops(unittest.TestCase):
    def loop(self, program, ours, calls, peer, log2=24):
        return verdicts({(program, log2, "native"): ours, (program, log2, "native calls"): calls, (program, log2, "OpenMP"): peer})

    def test_least_ratios(self):
        for program, least in (("heat loop", 2.5), ("wave loop", 2.5), ("gray-scott loop", 2.0)):
            calls, peer = f"{program}: native against native calls", f"{program}: native against OpenMP"
            held = self.loop(program, 1.0, least + 0.1, least - 0.1)
            self.assertEqual((held[calls], held[peer]), ("yes", "NO"))
            held = self.loop(program, 1.0, least - 0.1, least + 0.1)
            self.assertEqual((held[calls], held[peer]), ("NO", "yes"))

    def test_streams_that_fit_in_caches_are_not_judged(self):
        self.assertFalse([name for name in self.loop("heat loop", 1.0, 1.0, 1.0, log2=20) if name.startswith("heat loop")])

    def test_chain(self):
        name = "chain of four: native's time over that in one kernel"
        for taken, holds in ((1.1, "yes"), (1.2, "NO")):
            held = verdicts({("chain of four", 24, "native"): taken, ("chain of four", 24, "native in one kernel"): 1.0})
            self.assertEqual(held[name], holds)

    def test_compensated_sums(self):
        name = "a compensated sum's time over a plain one's, native"
        for taken, holds in ((1.05, "yes"), (1.2, "NO")):
            held = verdicts({("sum", 24, "native"): 1.0, ("sum", 24, "native compensated"): taken})
            self.assertEqual(held[name], holds)

    def test_ways_against_peers(self):
        name = "sgemm: native contracted against OpenBLAS"
        for taken, holds in ((1.6, "yes"), (1.7, "NO")):
            held = verdicts({("sgemm", 20, "native"): 3.0, ("sgemm", 20, "native contracted"): taken, ("sgemm", 20, "OpenBLAS"): 1.0})
            self.assertEqual(held[name], holds)


if __name__ == "__main__":
    unittest.main()
