# SPDX-License-Identifier: MIT
"""Charts by gnuplot: how contenders compare at each program's largest size, and what an element costs at every size."""
import math
import os
import shutil
import subprocess
import sys

# Ours are round and full, peers have shapes of their own. Whoever is not named here gets one of the last.
LOOKS = {
    "native": (7, "#1b5e9b"),
    "fragment": (7, "#e07b00"),
    "compute": (7, "#2a8c4a"),
    "OpenMP": (2, "#444444"),
    "PoCL": (8, "#9467bd"),
    "GLSL": (4, "#c23b3b"),
    "GLSL packed": (5, "#c23b3b"),
    "OpenBLAS": (12, "#7f6000"),
    "FFTW": (12, "#7f6000"),
    "Eigen": (12, "#7f6000"),
    "ViennaCL": (12, "#7f6000"),
    "PyTorch": (10, "#b8322a"),
    "CUB": (12, "#5a9e00"),
    "copy": (1, "#888888"),
}
OTHERS = [(3, "#888888"), (6, "#888888"), (14, "#888888")]


def look_of(contender, number=0):
    return LOOKS.get(contender, OTHERS[number % len(OTHERS)])


def quoted(text):
    return "'" + text.replace("'", "''") + "'"


def draw(found, folder):
    if shutil.which("gnuplot") is None:
        sys.exit("report.py: there is no gnuplot to draw charts (Debian: gnuplot-nox)")
    for name, script in (("performance", ratios_script(found)), ("performance-sizes", sizes_script(found))):
        if script is None:
            continue
        size, body = script
        for kind, terminal in (("svg", "svg noenhanced"), ("png", "pngcairo noenhanced")):
            points = 12 if kind == "svg" else 9  # pixels, or points: the same
            head = (f"set terminal {terminal} size {size[0]},{size[1]} font 'sans,{points}' background '#ffffff'\n"
                    f"set output {quoted(os.path.join(folder, name + '.' + kind))}\n")
            subprocess.run(["gnuplot"], input=head + body, text=True, check=True)


def baseline_of(found):
    """Whom the others are compared with: OpenMP, or PyTorch where a GPU was measured."""
    peers = [peer for peer in ("PyTorch", "OpenMP") if peer in found.peers()] or found.peers()
    return peers[0] if peers else None


def ratios_script(found):
    baseline = baseline_of(found)
    rows = []
    for program in found.programs():
        sizes = [log2 for log2 in found.sizes(program) if baseline in found.problems[(program, log2)]
                 and any(name in found.problems[(program, log2)] for name in found.ours())]
        if sizes:
            rows.append((program, sizes[-1]))
    if not rows:
        return None
    contenders = [name for name in found.ours() + found.peers() if name != baseline]
    blocks, plots, least, most = "", [], 1.0, 1.0
    for number, contender in enumerate(contenders):
        points = ""
        for i, problem in enumerate(rows):
            ratios = found.ratios(problem, contender, baseline)
            if ratios:
                points += f"{ratios[1]:.6g} {len(rows) - i}\n"
                least, most = min(least, ratios[1]), max(most, ratios[1])
        if not points:
            continue
        shape, color = look_of(contender, number)
        blocks += f"$c{number} << END\n{points}END\n"
        size = 1.3 if contender in found.ours() else 1.0
        plots.append(f"$c{number} using 1:2 with points pt {shape} ps {size} lw 1.5 lc rgb '{color}' title {quoted(contender)}")
    step = next(step for step in (2, 4, 8, 16, 32, 64) if math.log(most / least, step) < 11 or step == 64)
    ticks = []
    for power in range(math.floor(math.log(least, step)) - 1, math.ceil(math.log(most, step)) + 2):
        value = step ** abs(power)
        ticks.append(f"'{f'1/{value}' if power < 0 else value}' {float(step) ** power:.10g}")
    labels = ", ".join(f"{quoted(f'{program}, 2^{log2}')} {len(rows) - i}" for i, (program, log2) in enumerate(rows))
    body = blocks + (
        f"set title {quoted(f'Speed over that of {baseline} (its time over theirs; further right is faster)')}\n"
        f"set logscale x 2\nset xrange [{least / 1.6:.6g}:{most * 1.6:.6g}]\nset yrange [0.4:{len(rows) + 0.6}]\n"
        f"set xtics ({', '.join(ticks)})\nset ytics ({labels})\nset tics nomirror scale 0 textcolor rgb '#333333'\nset border 1 lc rgb '#888888'\n"
        "set grid xtics ytics lt 1 lc rgb '#e4e4e4'\n"
        "set key outside right center reverse Left samplen 1 spacing 1.4\n"
        f"set arrow from 1,0.4 to 1,{len(rows) + 0.6} nohead lw 2 lc rgb '#444444' back\n"
        f"plot {', '.join(plots)}\n")
    return (940, 110 + 32 * len(rows)), body


def sizes_script(found):
    programs = [program for program in found.programs() if len(found.sizes(program)) > 1]
    if not programs:
        return None
    columns = min(3, len(programs))
    rows = (len(programs) + columns - 1) // columns
    width, height, top = columns * 340, rows * 250 + 90, 90
    contenders = found.ours() + found.peers()
    body = ("set key off\nset logscale y\nset format y '%g'\nset grid lt 1 lc rgb '#e4e4e4'\n"
            "set border 3 lc rgb '#888888'\nset tics nomirror textcolor rgb '#333333'\n"
            "set multiplot title 'Nanoseconds an element, over the logarithm (base 2) of their number'\n")
    body += legend(contenders, width, height)
    for number, program in enumerate(programs):
        body += margins(number, columns, rows, width, height, top)
        body += panel(found, program, contenders, number)
    return (width, height), body + "unset multiplot\n"


def legend(contenders, width, height):
    """Names in their colours below the title, in place of a key in each panel."""
    text, x = "", 70
    for number, contender in enumerate(contenders):
        shape, color = look_of(contender, number)
        y = 1 - 48 / height
        text += (f"set label {2 * number + 1} '' at screen {x / width:.4f},{y:.4f} point pt {shape} ps 1 lc rgb '{color}'\n"
                 f"set label {2 * number + 2} {quoted(contender)} at screen {(x + 10) / width:.4f},{y:.4f} left\n")
        x += 40 + 8 * len(contender)
    # An empty plot draws them once.
    text += ("set lmargin at screen 0\nset rmargin at screen 0.001\nset tmargin at screen 0.001\nset bmargin at screen 0\n"
             "unset tics\nunset border\nset xrange [0:1]\nset yrange [1:2]\nplot NaN\n"
             "unset label\nset tics nomirror textcolor rgb '#333333'\nset border 3 lc rgb '#888888'\n")
    return text


def margins(number, columns, rows, width, height, top):
    column, row = number % columns, number // columns
    panel_height = (height - top) / rows
    left = (column * width / columns + 62) / width
    right = ((column + 1) * width / columns - 14) / width
    upper = 1 - (top + row * panel_height + 22) / height
    lower = 1 - (top + (row + 1) * panel_height - 32) / height
    return (f"set lmargin at screen {left:.4f}\nset rmargin at screen {right:.4f}\n"
            f"set tmargin at screen {upper:.4f}\nset bmargin at screen {lower:.4f}\n")


def panel(found, program, contenders, panel_number):
    sizes = found.sizes(program)
    blocks, plots = "", []
    for number, contender in enumerate(contenders):
        points = [(log2, found.seconds((program, log2), contender)) for log2 in sizes]
        points = [(log2, 1e9 * seconds / 2 ** log2) for log2, seconds in points if seconds]
        if not points:
            continue
        name = f"$p{panel_number}_{number}"
        blocks += f"{name} << END\n" + "".join(f"{x} {y:.6g}\n" for x, y in points) + "END\n"
        shape, color = look_of(contender, number)
        weight = 2 if contender in found.ours() else 1
        plots.append(f"{name} using 1:2 with linespoints pt {shape} ps 0.7 lw {weight} lc rgb '{color}'")
    return (blocks + f"set title {quoted(program)} offset 0,-0.6\nset xrange [{sizes[0] - 0.5}:{sizes[-1] + 0.5}]\n"
            f"set yrange [*:*]\nset xtics {max(2, (sizes[-1] - sizes[0]) // 6 // 2 * 2)}\nplot {', '.join(plots)}\n")
