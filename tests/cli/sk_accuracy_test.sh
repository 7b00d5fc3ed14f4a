#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# What `sk accuracy` measures, in small sizes: errors, never times.
# Usage: sk_accuracy_test.sh SK
set -euo pipefail
sk=$(realpath "$1")
tested=("$sk" accuracy)
accuracy=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../docs/accuracy.md")
source "$(dirname "${BASH_SOURCE[0]}")/frame.sh"
export SK_DEVICE=gl   # which has more modes than native code
unset SK_PROFILE

# figures FILE: of a table, all but times and what follows from them.
figures() { sed -E 's/ +[0-9.]+ \[[0-9.]+ [0-9.]+\]/ /; s/ +PARETO$//; s/ +/ /g; /cheapest/d' "$1"; }

# errorOf MODE: the relative error in the first row of that mode.
errorOf() { sed -nE "s/^  $1 +[0-9.]+ \[[0-9.]+ [0-9.]+\] +([^ ]+) .*/\1/p" out.txt | head -n 1; }
# below A B: numbers.
below() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a < b) }' || broken "$1 is not below $2"; }

# Command lines that make no sense.
run 0 --help
for option in --device --profile --size --rounds --data --tolerance --json --chart; do prints "$option"; done
run 1 nosuch
says "there is no program 'nosuch': it is one of sum, dot, moments, diffusion, polynomial, transcendentals, tables"
run 1 sum --data lumpy
says 'lumpy'
run 1 sum --size 0
says '--size'
run 1 sum --rounds 0
says '--rounds'
run 1 sum --tolerance=-1
says '--tolerance'
run 1 sum --device abacus
says "sk: no device 'abacus' was found"
run 1 sum --profile glsl999
says "there is no profile 'glsl999'; choose one of glsl330"
run 1 sum --chart picture.gif
says "no chart can be 'picture.gif': its name must end in .svg or .png"
run 1 sum --size 64 --json no/such/folder.json
says "cannot write 'no/such/folder.json'"

small=(--size 4096 --rounds 2)

# Functions of one float over every K-th float, beside their bounds; others, and those of doubles, over drawn numbers.
run 0 --exhaustive exp,atan --every 1000003 --device native,software --profile glsl330,essl300 --json all.json
for profile in native glsl330 essl300; do matches "^  exp +$profile +4295 +[0-9.]+ +[0-9.]+  yes (x = |no result but the nearest)"; done
[[ $out != *' NO '* ]] || broken "a function breaks its bound"
python3 -c "
import json
records = json.load(open('all.json'))['records']
assert [r['function'] for r in records] == 3 * ['exp'] + 3 * ['atan'], records
for r in records:
    assert r['arguments'] == 4295 and r['every'] == 1000003 and 0.4 < r['largest'] <= r['bound'] and r['within_bound'], r
    assert not r['worst'] or r['worst'][0]['error'] == r['largest'] > 0.5, r"
run 0 --exhaustive pow,tan --precision double --draws 1000 --device software --profile glsl330
for function in pow tan; do matches "^  $function +glsl330 +[0-9]+ +[0-9.]+ +[0-9.]+  yes x = "; done
run 0 --exhaustive tanh --precision double --draws 1000 --device native   # the C library's
matches '^  tanh +native +[0-9]+ +[0-9.]+ +-  - +x = '
run 1 --exhaustive exp,pow
says "there is no function 'pow' to try: it is one of all, sin, cos, "
run 1 sum --exhaustive exp
says '--exhaustive tries functions, no programs or files; leave them out'

# Sums: what each mode keeps, natively and with GL; each within its bound.
for device in native ''; do
  run 0 sum ${device:+--device "$device"} --data illconditioned "${small[@]}"
  for mode in tree compensated extended; do [[ -n $(errorOf $mode) ]] || broken "no row of $mode"; done
  below "$(errorOf compensated)" "$(errorOf tree)"
  below 0.9 "$(errorOf tree)"
  below "$(errorOf compensated)" 0.1
  [[ $out != *' NO'* ]] || broken "a mode breaks its bound"
  run 0 sum dot moments ${device:+--device "$device"} --data tiny "${small[@]}"
  [[ $out != *' NO'* ]] || broken "a mode breaks its bound where numbers are tiny"
done

# Every program.
run 0 "${small[@]}" --json all.json --chart all.svg
for program in sum dot moments diffusion polynomial transcendentals tables; do matches "^$program, [a-z 0-9]+: "; done
for data in uniform signed wide illconditioned tiny; do matches "^sum, $data: 4096 numbers"; done
matches '^  mode +time \[quartiles\] +rel err +scaled +bound  ok$'
matches '^  single +1\.00 \[1\.00 1\.00\]'
matches 'PARETO$'
for key in schema streamkernel device seed size rounds records program data mode baseline time ratio lower_quartile \
  upper_quartile ratios metrics bound bounded within_bound pareto worst bits; do
  grep -q "\"$key\":" all.json || broken "the JSON lacks $key"
done
grep -qE '"bits": "0x[0-9a-f]{8}"' all.json || broken "no bits of the worst input"

# Doubles are not judged by doubles: near a root they lose all digits, and diffusion is off by some of their last ones.
python3 -c "
import json
records = {(r['program'], r['data'], r['mode']): r for r in json.load(open('all.json'))['records']}
root = records['polynomial', 'root', 'double']['metrics']
assert root['rel err'] > 1 and records['polynomial', 'exponential', 'double']['metrics']['max ulp'] < 0.501, root
for storage in ('double', 'double storage'):
    if 'metrics' in records['diffusion', 'random', storage]:
        assert 1e-18 < records['diffusion', 'random', storage]['metrics']['rel err'] < 1e-6, storage"

# The same figures in another run.
run 0 sum diffusion "${small[@]}"
figures out.txt >first.txt
run 0 sum diffusion "${small[@]}"
figures out.txt >second.txt
cmp -s first.txt second.txt || broken "other errors than the first time"

# A tolerance: the cheapest mode that keeps it, or none.
run 0 sum --data illconditioned "${small[@]}" --tolerance 0.1
matches '^  the cheapest within 0\.1: (compensated|extended|double|exact)$'
run 0 polynomial "${small[@]}" --tolerance 0
matches '^  no mode is within 0$'

# The chart is SVG with a point for each mode that can be drawn, and a PNG is one.
grep -q '<svg ' all.svg && grep -q '</svg>' all.svg || broken "no SVG"
for text in compensated 'sum, illconditioned' 'diffusion, random' 'half storage'; do
  grep -q "$text" all.svg || broken "the chart lacks: $text"
done
# No name is on another, sums of equal errors included. (Only names begin where they are; letters are 6 to 8 pixels wide.)
python3 - all.svg <<'EOF' || broken "names in the chart touch"
import re, sys
at = r'translate\(([\d.]+),([\d.]+)\)"[^>]*text-anchor="start">\s*<text>([^<]*)</text>'
names = [(float(x), float(y), text) for x, y, text in re.findall(at, open(sys.argv[1]).read())]
assert len(names) > 50, names
for i, (x, y, text) in enumerate(names):
    for x2, y2, text2 in names[:i]:
        assert abs(y - y2) > 12 or x + 6 * len(text) < x2 or x2 + 6 * len(text2) < x, (text, text2, y, y2)
EOF
run 0 sum --data wide "${small[@]}" --chart wide.png
[[ $(head -c 8 wide.png | od -An -tx1 | tr -d ' ') == 89504e470d0a1a0a ]] || broken "no PNG"
for number in -1 nan inf; do
  run 1 sum --tolerance $number
  says "--tolerance: '$number' is no number from 0 on"
done
run 1 sum --chart no/such.svg
says "cannot write 'no/such.svg'"
PATH=/nonexistent run 1 sum --data wide "${small[@]}" --chart wide.svg
says 'there is no gnuplot to draw the chart; install it'

# The errors that the documentation shows: each table behind <!-- sk accuracy ARGUMENTS -->, of the device that it names.
run 0 sum --data wide "${small[@]}"
device=${out%%;*}
while IFS= read -r comment; do
  arguments=${comment#'<!-- sk accuracy '}
  read -ra arguments <<<"${arguments%' -->'}"
  shown=$(sed -n "/^$comment\$/,/^\`\`\`\$/p" "$accuracy" | sed '1,2d;$d')
  [[ -n $shown && $shown == "$device"* ]] || continue
  run 0 "${arguments[@]}" --rounds 1
  figures out.txt >figures.txt
  while IFS= read -r text; do
    grep -qxF -- "$text" figures.txt || broken "docs/accuracy.md shows what it does not print: $text"
  done < <(tail -n +2 <<<"$shown" >shown.txt; figures shown.txt)
done < <(grep '^<!-- sk accuracy ' "$accuracy")

echo "sk accuracy tells what it should"
