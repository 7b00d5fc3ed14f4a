#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# `sk scale`: halos come from the file, numbers agree with sums by hand, and what cannot be distributed is refused with a way
# out. Rates are given, but for one run that measures; no time is tested.
# Usage: sk_scale_test.sh SK SKC
set -euo pipefail
sk=$(realpath "$1")
skc=$(realpath "$2")
tested=("$sk" scale)
source "$(dirname "${BASH_SOURCE[0]}")/frame.sh"
unset SK_PROFILE SK_INCLUDE CXX SK_DEVICE
export SK_SKC=$skc SK_CACHE=$place/cache

# json EXPRESSION: what Python makes of all.json.
json() { python3 -c "
import json
all = json.load(open('all.json'))
$1" || broken "the JSON is not as expected: $1"; }

cat >step.sk <<'EOF'
namespace flow {
kernel void diffuse(float k, [[wrap]] float u[][], out float v<>) {
  v = u[indexof(v).y][indexof(v).x] + k * (neighbor(u, 1, 0) + neighbor(u, -1, 0) + neighbor(u, 0, 1) + neighbor(u, 0, -1));
}
}
kernel void smear(spec int radius, float2 u[][], float weight[], out float r<>) {
  r = 0;
  for (int k = -radius; k <= 0; ++k) r += weight[-k] * neighbor(u, k, 0).x;
}
kernel void carry(float2 at<>, float dye[][], out float r<>) { r = sample(dye, at); }
kernel void keep(float x<>, vout float r<>) { if (x > 0) push(r, x); }
kernel void both(float x<>, out float r<>, reduce float total<> = 0) { r = 2 * x; total += r; }
reduce void sum(float x<>, reduce float total<> = 0) { total += x; }
EOF
grid=(step.sk --grid 1000x1000)
rate=(--rate diffuse=1e9/s,5us)
diffuse=("${grid[@]}" "${rate[@]}" --kernel diffuse)

# Halos, messages and times of the README's kernel, by hand: 250 rows, 2 messages of 4 kB.
run 0 "${diffuse[@]}" --gpus 4 --network 25GB/s,2us --every 1 --json all.json --chart all.svg
prints 'halo u: y 1+1, x 1+1'
matches '^ +4  4 x 1 +250 x 1000 '
prints '4 GPU(s) pay, split 4 x 1, an exchange for every call'
grep -q '<svg' all.svg || broken 'no chart'
json "
best = all['rows'][0]['best']
assert all['calls'][0]['gathers'] == [{'name': 'u', 'bytes': 4, 'halo': [[1, 1], [1, 1]]}], all['calls']
assert all['periodic'] == [True, True] and all['device'] is None and all['pays'] == 4
assert best['parts'] == [4, 1] and best['messages'] == 2 and best['bytes'] == 8000, best
assert abs(best['compute'] - (250e3 / 1e9 + 3 * 5e-6)) < 1e-9 and best['waiting'] == 0, best
assert all['rows'][0]['byDimensions'][1]['messages'] == 8, all['rows']  # with corners
"
# Values of spec parameters, tables and constants.
run 0 "${grid[@]}" --kernel smear --rate smear=1e9/s --set radius=3 --gpus 2 --json all.json
prints 'halo u: x 3+0'
json "assert all['calls'][0]['gathers'][0]['bytes'] == 8 and all['periodic'] == [False, False], all"
run 0 "${grid[@]}" --kernel smear --rate smear=1e9/s --constant smear.u --gpus 2
prints 'halo none'
# A step of several calls, and what nobody named is left out with its reason. Folded outputs need a rate.
run 0 "${grid[@]}" "${rate[@]}" --rate both=1e9/s --rate smear=1e9/s --rate sum=1e9/s --gpus 1..8
prints "keep: 'r' is a variable output"
prints 'carry: '"'dye' is read along x"
prints '4 bytes combined'
# Measured here.
run 0 "${grid[@]}" --kernel sum --kernel diffuse --size 16384 --device native --gpus 1,3
matches 'flow::diffuse +[0-9.e+]+ elements/s and .* \(measured, 16384 elements\)'
prints 'measured on '
# More devices than elements, and too little memory.
run 0 step.sk --grid 3x4 "${rate[@]}" --kernel diffuse --gpus 1,4096 --memory 50B
prints 'every block is thinner than its halo'
prints 'too much'

# refuses TEXT ARGUMENT...: ends with this message and a status of 1.
refuses() {
  run 1 "${@:2}"
  says "$1"
}
refuses "'dye' is read along x at indices that are not near the element's; promise how far with [[halo(N)]]" "${grid[@]}" --kernel carry
refuses "'r' is a variable output" "${grid[@]}" --kernel keep
refuses "'u' has 2 dimension(s), but --grid has 3" step.sk --grid 9x9x9 --kernel diffuse
refuses "'both' folds beside its outputs" "${grid[@]}" --kernel both
refuses "the file has no kernel 'none'; it has flow::diffuse" "${grid[@]}" --kernel none
refuses "no kernel of the step has a gather 'w'" "${diffuse[@]}" --constant w
refuses "'0x5' is no grid" step.sk --grid 0x5
refuses "the grid '1e12x1e12' has 2^62 elements or more" step.sk --grid 1e12x1e12
refuses "'25' is no bandwidth" "${diffuse[@]}" --network 25,2us
refuses "'2parsecs' is no time" "${diffuse[@]}" --network 25GB/s,2parsecs
refuses "'0' is no number of GPUs" "${diffuse[@]}" --gpus 0
refuses "'diffuse=fast' is no rate" "${grid[@]}" --kernel diffuse --rate diffuse=fast
refuses 'step.txt' step.txt --grid 5x5
refuses 'its name must end in .svg or .png' "${diffuse[@]}" --chart all.txt
refuses '--grid is required' step.sk
