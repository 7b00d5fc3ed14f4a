# SPDX-License-Identifier: MIT
"""What must hold. A ratio is a peer's time over ours; it is judged at the size where it is worst, of those that are large
enough for the work, and not what surrounds it, to be what takes the time."""
import results

head = ["bar", "needed", "measured", "holds"]

NOT_MEASURED = "not measured"
LARGE = 20  # log2

HUGE = 26

# Our contender, programs, peers (the fastest of them counts at each size), least ratio, from which size on. Rows whose peers are
# not there are left out: `copy`, PyTorch and CUB are on GPUs.
RATIOS = [
    ("native", ["saxpy", "sum", "5-point stencil"], ["OpenMP"], 0.95, LARGE),
    ("fragment", ["saxpy", "sum", "5-point stencil"], ["GLSL", "GLSL packed"], 1.0, LARGE),
    ("compute", ["saxpy", "5-point stencil"], ["copy"], 0.95, HUGE),
    ("compute", ["sum"], ["PyTorch", "CUB"], 0.95, HUGE),
]
PRIMARY = ["rays: interior, primary", "rays: organic mesh, primary"]
DIFFUSE = ["rays: interior, diffuse", "rays: organic mesh, diffuse"]
RATIOS += [
    ("native", PRIMARY, ["Embree"], 0.6, LARGE),
    ("native", DIFFUSE, ["Embree"], 0.35, LARGE),
    ("compute", PRIMARY + DIFFUSE, ["CUDA"], 1.0, LARGE),
]
# Our contender, programs, another way of ours, peers, least ratio, from which size on.
WAY_RATIOS = [("native", ["sgemm"], "contracted", ["OpenBLAS"], 0.6, LARGE)]
# Our contender, programs, elements a second in millions, whether the renderer is in software.
RATES = [
    ("fragment", PRIMARY, 3, True),
    ("fragment", DIFFUSE, 1, True),
    ("compute", PRIMARY, 2000, False),
    ("compute", DIFFUSE, 1000, False),
]
BEST_OF_ALL = ("mandelbrot", ["OpenMP", "PoCL", "OpenCL", "GLSL"], 1.0)
RATIOS += [
    ("native", ["power-law matrix"], ["Eigen", "OpenMP"], 1.0, LARGE),
    ("native", ["conjugate gradients"], ["Eigen"], 4.0, 24),
]
LOOPS = ["heat loop", "wave loop"]
RATIOS += [
    ("native", LOOPS, ["OpenMP"], 2.5, 24),
    ("native", ["gray-scott loop"], ["OpenMP"], 2.0, 24),
]
# Our contender, programs, another way of ours, least ratio of its time over the first's, from which size on.
OWN_RATIOS = [
    ("native", LOOPS, "calls", 2.5, 24),
    ("native", ["gray-scott loop"], "calls", 2.0, 24),
    ("compute", ["heat loop", "gray-scott loop"], "calls", 1.5, 24),  # on GPUs
]
# Our contender, program, another way of ours, most that the first takes of its time, from which size on.
OWN_COSTS = [("native", name, "in one kernel", 1.15, 24) for name in ("chain of four", "pipeline of four")]
OWN_COSTS += [("compute", name, "in one kernel", 1.15, 24) for name in ("chain of four", "pipeline of four")]  # on GPUs
# Our contender, program, the program whose bytes a second it is measured by, least part of them, log2 of the size of both.
BANDWIDTHS = [("native", "5-point matrix", "saxpy", 0.9, 24)]
# Our contender, program, log2 of the size, what a run is so many of, most seconds for one.
TIMES = [
    ("native", "conjugate gradients", 16, (128, "iteration"), 60e-6),
    ("native", "conjugate gradients", 24, (16, "iteration"), 1 / 47),
    ("native", "full multigrid on a cube", 21, (1, "run"), 0.25),
    ("native", "multigrid-CG, 150^3", 22, (1, "run"), 1.0),
]
COMPENSATED = 1.1  # times the plain sum's time, natively and on a GPU
LINEAR = ["saxpy", "sum", "5-point stencil"]
EXPONENT = 1.1  # of the size, in the time, from LARGE on: caches end on the way
GROWS_BESIDE = {"native": "OpenMP", "fragment": "GLSL packed", "compute": "copy"}  # whose exponent is told, too


def judge(found):
    """Rows for `head`; one without a measurement says so."""
    rows = []
    for ours, programs, peers, least, smallest in RATIOS:
        if ours in found.ours() and set(peers) & set(found.peers()):
            for program in programs:
                rows.append(ratio_row(found, program, [ours], peers, least, smallest))
    for ours, programs, way, peers, least, smallest in WAY_RATIOS:
        if ours in found.ours() and set(peers) & set(found.peers()):
            rows += [ratio_row(found, program, [f"{ours} {way}"], peers, least, smallest) for program in programs
                     if found.sizes(program)]
    for ours, programs, least, in_software in RATES:
        rows += [rate_row(found, program, ours, least) for program in programs
                 if found.sizes(program) and ours in found.ours() and is_software(found) == in_software]
    program, peers, least = BEST_OF_ALL
    rows.append(ratio_row(found, program, found.ours(), peers, least, LARGE))
    rows += [bandwidth_row(found, *bar) for bar in BANDWIDTHS if found.sizes(bar[1])]
    rows += [time_row(found, *bar) for bar in TIMES if found.sizes(bar[1])]
    for ours, programs, way, least, smallest in OWN_RATIOS:
        rows += [ratio_row(found, program, [ours], [f"{ours} {way}"], least, smallest) for program in programs
                 if found.sizes(program) and has_bars(found, ours)]
    rows += [own_cost_row(found, *bar) for bar in OWN_COSTS if found.sizes(bar[1]) and has_bars(found, bar[0])]
    rows.append(compensated_row(found, "native"))
    if "PyTorch" in found.peers():
        rows.append(compensated_row(found, "compute"))
    for program in LINEAR:
        rows += [linear_row(found, program, ours) for ours in found.ours()]
    for figure in found.document.get("results", []):
        if "bar" in figure:
            unit = figure["unit"]
            rows.append([figure["name"], f"at most {figure['bar']:g} {unit}", f"{results.three_digits(figure['median'])} {unit}",
                         verdict(figure["passed"])])
    return rows


def verdict(holds):
    return "yes" if holds else "NO"


def large_sizes(found, program, smallest=LARGE):
    return [log2 for log2 in found.sizes(program) if log2 >= smallest]


def ratio_row(found, program, ours, peers, least, smallest):
    """The fastest of `ours` against the fastest of `peers`, at the size that is worst for us."""
    worst = None
    for log2 in large_sizes(found, program, smallest):
        problem = (program, log2)
        mine = [name for name in ours if found.seconds(problem, name)]
        theirs = [name for name in peers if found.seconds(problem, name)]
        if mine and theirs:
            fastest = min(mine, key=lambda name: found.seconds(problem, name))
            peer = min(theirs, key=lambda name: found.seconds(problem, name))
            low, median, high = found.ratios(problem, fastest, peer)
            if worst is None or median < worst[0]:
                worst = (median, f"{median:.2f} ({low:.2f}-{high:.2f}) at 2^{log2}, {fastest} against {peer}")
    name = f"{program}: {'the best of ours' if len(ours) != 1 else ours[0]} against {' or '.join(peers)}"
    if worst is None:
        return [name, f"at least {least}", NOT_MEASURED, ""]
    return [name, f"at least {least}", worst[1], verdict(round(worst[0], 2) >= least)]


def is_software(found):
    return any("llvmpipe" in (machine.get("renderer") or "") for machine in found.document["machines"])


def has_bars(found, ours):
    """Whether one of our contenders is judged against another way of ours."""
    return ours == "native" or (ours in found.ours() and not is_software(found))


def rate_row(found, program, ours, least):
    """Elements a second at the largest size, in millions."""
    name, needed = f"{program}: {ours}'s rate", f"at least {least} M/s"
    log2 = found.sizes(program)[-1]
    seconds = found.seconds((program, log2), ours)
    if seconds is None:
        return [name, needed, NOT_MEASURED, ""]
    rate = 2.0 ** log2 / seconds / 1e6
    return [name, needed, f"{results.three_digits(rate)} M/s at 2^{log2}", verdict(rate >= least)]


def bandwidth_row(found, ours, program, yardstick, least, log2):
    """The bytes of a program in a second, as a part of those of another one."""
    name, needed = f"{program}: {ours}'s bandwidth over that of {yardstick}", f"at least {least}"
    rates = []
    for each in (program, yardstick):
        seconds = found.seconds((each, log2), ours)
        if seconds is None:
            return [name, needed, NOT_MEASURED, ""]
        rates.append(found.problems[(each, log2)][ours]["bytes"] / seconds)
    part = rates[0] / rates[1]
    return [name, needed, f"{part:.2f} at 2^{log2}", verdict(round(part, 2) >= least)]


def time_row(found, ours, program, log2, parts, most):
    """Seconds of a part of a run."""
    count, part = parts
    name, needed = f"{program}: {ours}'s time for one {part}, 2^{log2}", f"at most {results.time_text(most)}"
    seconds = found.seconds((program, log2), ours)
    if seconds is None:
        return [name, needed, NOT_MEASURED, ""]
    return [name, needed, results.time_text(seconds / count), verdict(seconds / count <= most)]


def compensated_row(found, ours):
    return cost_row(found, "sum", f"a compensated sum's time over a plain one's, {ours}", f"{ours} compensated", ours, COMPENSATED, LARGE)


def own_cost_row(found, ours, program, way, most, smallest):
    return cost_row(found, program, f"{program}: {ours}'s time over that {way}", ours, f"{ours} {way}", most, smallest)


def cost_row(found, program, name, dear, cheap, most, smallest):
    """The time of a contender over that of another one, at the size where that is most."""
    needed = f"at most {most}"
    worst = None
    for log2 in large_sizes(found, program, smallest):
        ratios = found.ratios((program, log2), cheap, dear)
        if ratios and (worst is None or ratios[1] > worst[0]):
            worst = (ratios[1], f"{ratios[1]:.2f} ({ratios[0]:.2f}-{ratios[2]:.2f}) at 2^{log2}")
    if worst is None:
        return [name, needed, NOT_MEASURED, ""]
    return [name, needed, worst[1], verdict(round(worst[0], 2) <= most)]


def growth(found, program, contender):
    """The exponent that fits a contender's times from 2^20 elements on, and these; None where there is one at most."""
    points = [(2.0 ** log2, found.seconds((program, log2), contender)) for log2 in large_sizes(found, program)]
    points = [point for point in points if point[1]]
    return (results.slope(points), points) if len(points) >= 2 else (None, points)


def linear_row(found, program, ours):
    name = f"{program}: {ours}'s cost grows linearly"
    needed = f"as n^{EXPONENT} at most"
    exponent, points = growth(found, program, ours)
    if len(points) < 3:
        return [name, needed, NOT_MEASURED, ""]
    peer = GROWS_BESIDE.get(ours)
    beside, besides = growth(found, program, peer)
    first, last = points[0], points[-1]
    return [name, needed,
            f"n^{exponent:.2f}; {1e9 * first[1] / first[0]:.3g} ns an element of 2^{int(first[0]).bit_length() - 1}, "
            f"{1e9 * last[1] / last[0]:.3g} of 2^{int(last[0]).bit_length() - 1}"
            + (f"; {peer}'s n^{beside:.2f} to 2^{int(besides[-1][0]).bit_length() - 1}" if beside is not None else ""),
            verdict(exponent <= EXPONENT)]
