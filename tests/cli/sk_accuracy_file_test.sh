#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# `sk accuracy FILE.sk`: worst inputs are where theory has them, extremes are told apart, and what cannot be measured is
# refused with a way out. Errors, never times.
# Usage: sk_accuracy_file_test.sh SK SKC
set -euo pipefail
sk=$(realpath "$1")
skc=$(realpath "$2")
tested=("$sk" accuracy)
source "$(dirname "${BASH_SOURCE[0]}")/frame.sh"
export SK_DEVICE=gl   # which has more modes than native code
unset SK_PROFILE SK_INCLUDE CXX
export SK_SKC=$skc SK_CACHE=$place/cache

# json EXPRESSION: what Python makes of the JSON in all.json, `kernels` being its records by program and mode.
json() {
  python3 -c "
import json, math
all = json.load(open('all.json'))
kernels = {(r['program'], r['mode']): r for r in all['records']}
$1"
}

cat >kernels.sk <<'EOF'
#include "scale.sk"
namespace math {
// 0 instead of 1/2 where cos(x) rounds to 1, that is below 2^-12, and up to twice as much a little above.
kernel void cancel(float x<>, out float r<>) { r = (1 - cos(x)) / (x * x); }
kernel void roots(float x<>, out float r<>) { r = sqrt(x + 1) - sqrt(x); }
// Loses all digits next to the root of 2 alone.
kernel void pole(float x<>, out float r<>, out float s<>) {
  r = 1 / (x * x - 2);
  s = x;
}
kernel void overflow(float x<>, out float r<>) { r = x * 1e38 * 10 / 1e38; }
}
struct Body { float2 at; int kind; };
// The sum of squares overflows where its root does not.
kernel void pull(float g, spec bool far, Body b<>, [[wrap]] float w[][], out Body n<>, out float e<>) {
  n.at = b.at * (g * SCALE);
  n.kind = b.kind + 1;
  e = sqrt(b.at.x * b.at.x + b.at.y * b.at.y) - neighbor(w, 1, 0);
  if (far) e = 2 * e;
}
[[table(0, 1, 16, linear)]] float curve(float x) { return x * x; }
[[tables(on)]] kernel void look(float x<>, out float r<>) { r = curve(x); }
kernel void ramp(iter float t<>, float c[2], out float r<>) { r = c[0] + c[1] * t; }
reduce void sum(float x<>, reduce float total<> = 0) { total += x; }
reduce void largest(float x<>, reduce float most<>) { most = max(most, x); }
kernel void promised([[range(0.25, 4)]] float x<>, [[range(0, 1.0 / 0.0)]] float y<>, [[range(3, 5)]] spec int n, out float r<>) {
  r = x > 4 || !(y >= 0) ? x * y * 1e38 * 10 / 1e38 : x * sqrt(y) * n;
}
kernel void parity(int n<>, out bool odd<>) { odd = (n & 1) == 1; }
kernel void keep(float x<>, vout float r<>) { if (x > 0) push(r, x); }
EOF
mkdir include
echo '#define SCALE FACTOR' >include/scale.sk
few=(-Iinclude -DFACTOR=1 --rounds 2)
small=("${few[@]}" --size 4096)

# What --help has.
run 0 --help
for option in --kernel --range --set --inputs --no-extremes -I -D --skc; do prints "  $option"; done

# The worst inputs of cancellations, on native code and on the best device.
for device in native ''; do
  run 0 kernels.sk "${small[@]}" ${device:+--device "$device"} --kernel cancel --range x=0:1 --json all.json
  matches '^math::cancel, drawn: 4096 elements; x in \[0, 1\]$'
  matches '^    single +x = [0-9.e-]+ \(0x1.*p-[0-9]+\): r is [0-9.e-]+ \(0x'
  json "
worst = kernels['math::cancel', 'single']['worst']
x = worst['inputs']['x']
assert float.fromhex(x['hex']) == x['value'] and 0 < x['value'] < 1e-3, x
assert worst['result'] == 'r' and abs(worst['wanted']['value'] - 0.5) < 1e-6, worst
double = kernels['math::cancel', 'double']  # below 1e-5 it loses all but a third of its digits: the reference is no double
assert double['metrics']['rel err'] > 1e-5 and double['worst']['inputs']['x']['value'] < 1e-4, double
assert kernels['math::cancel', 'single']['metrics']['rel err'] >= 1"
done
run 0 kernels.sk "${small[@]}" --device native --kernel math::roots --range x=0:1e6 --json all.json
json "
assert kernels['math::roots', 'single']['worst']['inputs']['x']['value'] > 1e4
assert kernels['math::roots', 'single']['metrics']['rel err'] > 1e-4
assert kernels['math::roots', 'double']['metrics']['rel err'] < 1e-7
# Every mode is within its bound, and near it.
for mode in 'single', 'extended', 'double', 'half':
    one = kernels['math::roots', mode]
    if mode == 'half':   # 1e6 is infinite
        assert 'bound' not in one, one
        continue
    assert one['bounded'] == 'abs err' and one['within_bound'], one
    assert one['bound'] / 5 < one['metrics']['abs err'] <= one['bound'], one"
matches 'wrong class +bound  ok$'

# Near the worst of the drawn numbers there are worse ones, which are found; the errors of each result stand apart.
run 0 kernels.sk "${small[@]}" --device native --kernel pole --range x=1:2 --json all.json
matches '^  of each result$'
matches '^    single +s +0 +0 +0 +0 +0$'
json "
single = kernels['math::pole', 'single']
assert 'bound' not in single, single   # 1 / 0 is between 1 and 2
assert single['metrics']['rel err'] > 0.02, single['metrics']   # 6e-4 is the largest error of 4,096 numbers
assert abs(single['worst']['inputs']['x']['value'] - 2 ** 0.5) < 1e-6, single['worst']
r, s = (single['outputs'][name]['metrics'] for name in 'rs')
assert s['max ulp'] == 0 and r['max ulp'] == single['metrics']['max ulp'] and r['rel err'] == single['metrics']['rel err'], (r, s)"

# Where every result is of another class, no error is 0.
run 0 kernels.sk "${small[@]}" --device native --kernel overflow --range x=1:2 --no-extremes --json all.json
json "
single = kernels['math::overflow', 'single']['metrics']
assert single['wrong class'] > 4096 and single['max ulp'] is None and single['rel err'] is None, single
assert kernels['math::overflow', 'double']['metrics']['max ulp'] < 1"

# The reference loses its digits, too: MPFR says so (with g++ on x86-64, and where libmpfr is installed).
if [[ $(uname -m) == x86_64 ]] && echo '#include <mpfr.h>' | "${CXX:-c++}" -E -x c++ - >/dev/null 2>&1; then
  run 0 kernels.sk "${small[@]}" --device native --kernel cancel --range x=0:1 --json all.json
  prints 'but MPFR has 0.5 (0x1p-1): the reference is wrong here'
  json "
example = kernels['math::cancel', 'single']['extremes']['example']
assert example['reference_differs'] and example['by_mpfr']['value'] == 0.5 and example['wanted']['value'] == 0, example
worst = kernels['math::cancel', 'single']['worst']
assert not worst['reference_differs'] and abs(worst['by_mpfr']['value'] - worst['wanted']['value']) < 1e-15, worst"
fi

# A function with a table, computed and looked up: off by h^2 / 4 at most, in the middle of an interval.
run 0 kernels.sk "${small[@]}" --kernel look --range x=0.5:1 --json all.json
json "
assert kernels['look', 'single']['metrics']['max ulp'] <= 0.5
assert 0.0005 < kernels['look', 'single, tables']['metrics']['rel err'] < 1 / 1024 / 0.25 + 1e-6"

# All of the file: structs, gathers, uniforms, spec parameters, arrays, iterators; what cannot be measured is told.
run 0 kernels.sk "${small[@]}" --json all.json --chart all.svg --set far=false --range b.at=1:2 --range c=3:4
for kernel in math::cancel math::roots pull ramp sum largest; do matches "^$kernel, drawn: 4096 elements; b\.at in \[1, 2\]"; done
prints "  parity: there are no floats in its results"
prints "  keep: 'r' is a variable output"
grep -q 'math::cancel, drawn' all.svg || broken "the chart lacks a kernel"
json "
assert all['file'] == 'kernels.sk' and all['size'] == 4096
pull = kernels['pull', 'single']
names = pull['worst']['inputs']
assert {'g', 'far', 'b.at.x', 'b.at.y', 'b.kind'} < set(names) and any(n.startswith('w[') for n in names), names
assert names['far']['hex'] == 'false' and 1 <= names['b.at.y']['value'] <= 2
assert pull['metrics']['wrong int'] == 0 and pull['metrics']['wrong class'] == 0
ramp = kernels['ramp', 'single']['worst']['inputs']
assert 3 <= ramp['c[1]']['value'] <= 4 and ramp['t']['index']
assert kernels['sum', 'exact']['metrics']['max ulp'] <= 0.5
assert 'no sum of floats' in kernels['largest', 'exact']['refused']
assert kernels['largest', 'tree']['metrics']['rel err'] == 0
for record in all['records']: assert 'refused' in record or record['extremes']['tried'] > 100, record"

# Declared ranges are drawn from, and no extremes outside of them; --range is for what is outside, too.
run 0 kernels.sk "${small[@]}" --device native --kernel promised --json all.json
matches '^promised, drawn: 4096 elements; x in \[0.25, 4\] as declared, y in \[0, inf\] as declared, n in \[3, 5\] as declared$'
json "
single = kernels['promised', 'single']
inputs = single['worst']['inputs']
assert 0.25 <= inputs['x']['value'] <= 4 and inputs['y']['value'] >= 0 and inputs['n']['value'] == 3, inputs
assert single['extremes']['tried'] > 100 and single['extremes']['other_class'] == 0, single['extremes']"
run 0 kernels.sk "${small[@]}" --device native --kernel promised --range x=1:8 --json all.json
matches '^promised, drawn: 4096 elements; x in \[1, 8\], y in'
json "assert kernels['promised', 'single']['extremes']['other_class'] > 0"

# Recorded inputs take the place of drawn ones: their elements, their shape.
# record FILE ARRAYS: writes a .npz file, as numpy.savez does; ARRAYS are lines of NAME: TYPE, SHAPE, VALUES.
record() {
  python3 -c "
import struct, sys, zipfile
codes = {'<f4': 'f', '<f8': 'd', '<i4': 'i', '<i8': 'q', '|b1': '?', '<u4': 'I'}
with zipfile.ZipFile(sys.argv[1], 'w', zipfile.ZIP_DEFLATED if 'deflated' in sys.argv[1] else zipfile.ZIP_STORED) as file:
    for line in sys.argv[2].strip().splitlines():
        name, array = line.strip().split(': ', 1)
        type, shape, values = eval(array)
        count = 1
        for extent in shape: count *= extent
        values = [values(i) for i in range(count)] if callable(values) else values
        assert len(values) == count, line
        text = str({'descr': type, 'fortran_order': False, 'shape': tuple(shape)})
        text += ' ' * (63 - (10 + len(text)) % 64) + chr(10)
        head = b'\\x93NUMPY' + bytes([1, 0]) + struct.pack('<H', len(text)) + text.encode()
        with file.open(name + '.npy', 'w', force_zip64=True) as entry:
            entry.write(head + struct.pack('<%d%s' % (count, codes[type]), *values))" "$1" "$2"
}
roots="math::roots/x: ('<f4', (6, 50), lambda i: 1000 + i)
math::roots/r.shape: ('<i8', (2,), [6, 50])"
pull="pull/g: ('<f4', (), [2])
pull/far: ('|b1', (), [True])
pull/b.at: ('<f4', (4, 5, 2), lambda i: 1 + i % 7)
pull/b.kind: ('<i4', (4, 5), lambda i: i)
pull/w: ('<f4', (4, 5), lambda i: 0.5)
pull/n.shape: ('<i8', (2,), [4, 5])
pull/e.shape: ('<i8', (2,), [4, 5])"
others="ramp/t: ('<f4', (2,), [0, 8])
ramp/c: ('<f4', (2,), [3, 4])
ramp/r.shape: ('<i8', (1,), [16])
sum/x: ('<f4', (300,), lambda i: 0.1)"
record all.npz "$roots
$pull
$others
another::file/u: ('<f4', (1,), [1])"
run 0 kernels.sk "${few[@]}" --device native --inputs all.npz --json all.json
matches '^math::roots, recorded: 300 elements of all\.npz$'
matches '^pull, recorded: 20 elements of all\.npz$'
matches '^ramp, recorded: 16 elements'
matches '^sum, recorded: 300 elements'
prints "'all.npz' has no inputs of 'largest'"
json "
assert all['records'][0]['data'] == 'recorded'
worst = kernels['math::roots', 'single']['worst']
row, column = (int(i) for i in worst['index'].split(', '))
assert worst['inputs']['x']['value'] == 1000 + 50 * row + column, worst
x = worst['inputs']['x']['value']
assert abs(worst['wanted']['value'] - 1 / (math.sqrt(x + 1) + math.sqrt(x))) < 1e-12, worst
inputs = kernels['pull', 'single']['worst']['inputs']
assert inputs['g']['value'] == 2 and inputs['far']['hex'] == 'true' and inputs['b.at.x']['value'] >= 1, inputs
number = int(inputs['b.kind']['value'])
assert [inputs['b.at.' + c]['value'] for c in 'xy'] == [1 + (2 * number + k) % 7 for k in (0, 1)], inputs
assert kernels['sum', 'tree']['metrics']['rel err'] < 1e-6 and 'extremes' not in kernels['sum', 'tree'], kernels['sum', 'tree']"
# Results next to 0 that no mode gets right: errors are compared with the root mean square of all.
cat >warm.sk <<'EOF2'
kernel void radiate(float room, float u<>, out float r<>) {
  float t = room + u;
  r = t * t - room * room;
}
EOF2
record warm.npz "radiate/room: ('<f4', (), [300])
radiate/u: ('<f4', (1000,), lambda i: 10 ** (i / 40 - 28))
radiate/r.shape: ('<i8', (1,), [1000])"
run 0 warm.sk --rounds 2 --device native --inputs warm.npz --tolerance 1e-5 --json all.json
matches ' err/rms +rel err '
matches '^  the cheapest within 1e-05: (extended|double)$'
json "
single, double = (kernels['radiate', mode] for mode in ('single', 'double'))
assert single['metrics']['rel err'] == double['metrics']['rel err'] == 1, (single, double)
assert 0.01 < single['metrics']['err/rms'] < 10 and double['metrics']['err/rms'] < 1e-6, (single, double)
# The inputs of the largest error are those that matter.
u, wanted = single['worst']['inputs']['u']['value'], single['worst']['wanted']['value']
assert u > 1e-6 and abs(single['worst']['got']['value'] - wanted) == single['metrics']['abs err'], single['worst']"
# A row that all rows of the domain read.
record some.npz "$(sed '1s/(6, 50)/(1, 50)/' <<<"$roots")"
run 0 kernels.sk "${few[@]}" --device native --inputs some.npz --kernel math::roots --json all.json
matches '^math::roots, recorded: 300 elements'
json "
worst = kernels['math::roots', 'single']['worst']
assert worst['inputs']['x']['value'] == 1000 + int(worst['index'].split(', ')[1]), worst"
# What is not there, or is something else, is told.
# refuses ARRAYS EDIT MESSAGE [OPTION]...: of the arrays, after an edit by sed.
refuses() {
  record some.npz "$(sed "$2" <<<"$1")"
  run 1 kernels.sk "${few[@]}" --device native --inputs some.npz "${@:4}"
  says "$3"
}
refuses "$roots" 's/roots/rots/' "'some.npz' has no inputs of 'math::roots'; did you mean 'math::rots'?" --kernel math::roots
refuses "$roots" 's|/x|/y|' "'math::roots/y' is of no parameter; did you mean 'x'?"
refuses "$roots" '/shape/d' "'math::roots/r.shape' is missing"
refuses "$roots" 's/<f4/<f8/' "'math::roots/x' has elements of type '<f8', but 'float x' needs '<f4'"
refuses "$pull" "/w:/s/(4, 5)/(20,)/" "'pull/w' has shape (20,), but 'float w' needs 2 dimension(s)"
refuses "$pull" 's/(4, 5, 2)/(4, 10)/' "'pull/b.at' has shape (4, 10), but 'Body b' needs 1 to 4 dimension(s), and then (2,)"
refuses "$pull" '/kind/s/(4, 5)/(4, 4)/' "'pull/b.kind' is for streams of another shape than the members before it, (4, 5)"
refuses "$pull" '/g:/s/()/(1,)/' "'pull/g' has shape (1,), but 'float g' needs ()"
refuses "$roots" 's|.*/||' "'r.shape' is not named KERNEL/PARAMETER, such as 'heat::diffuse/u'"
record deflated.npz "$roots"
run 1 kernels.sk "${few[@]}" --inputs deflated.npz
says "'math::roots/x.npy' is compressed, and only arrays as they are can be read; save it by numpy.savez"
run 1 kernels.sk "${few[@]}" --inputs none.npz
says "'none.npz': it cannot be read"
run 1 kernels.sk "${few[@]}" --inputs all.npz --range x=0:1
says "--inputs has the elements, the values and the shapes; leave out --range, --set and --size"

# Extremes stand apart: of ordinary numbers nothing overflows.
run 0 kernels.sk "${small[@]}" --device native --kernel pull --json all.json
matches '^  of [0-9]+ results of extreme inputs$'
json "
single = kernels['pull', 'single']
assert single['metrics']['wrong class'] == 0 and single['extremes']['other_class'] > 0, single
example = single['extremes']['example']
assert example['got']['hex'] == 'inf' and math.isfinite(float.fromhex(example['wanted']['hex'])), example
double = kernels['pull', 'double']['extremes']  # overflows nowhere, but cancels, too
assert double['other_class'] < single['extremes']['other_class'], (double, single)"
run 0 kernels.sk "${small[@]}" --device native --kernel pull --no-extremes
[[ $out != *extreme* ]] || broken "extremes in spite of --no-extremes"

# The same figures in another run, in the shape that is asked for, whatever the times are.
figures() { sed -E 's/ +[0-9.]+ \[[0-9.]+ [0-9.]+\]/ /; s/ +PARETO$//; s/ +/ /g; /cheapest/d' out.txt; }
run 0 kernels.sk "${few[@]}" --size 32x64 --kernel pull --device native --tolerance 1e-6
matches '^pull, drawn: 2048 elements'
matches '^  the cheapest within 1e-06: (extended|double)$'
figures >first.txt
run 0 kernels.sk "${few[@]}" --size 32x64 --kernel pull --device native --tolerance 1e-6
figures | cmp -s first.txt - || broken "other errors than the first time"

# Values that are set are all that there is.
run 0 kernels.sk "${small[@]}" --device native --kernel cancel --set x=0.5 --json all.json
json "
single = kernels['math::cancel', 'single']
assert single['worst']['inputs']['x']['value'] == 0.5 and 'extremes' not in single, single"

# What makes no sense, and what is missing.
run 1 kernels.sk "${small[@]}" --kernel nosuch
says "the file has no kernel 'nosuch'; it has math::cancel, math::roots, math::pole, math::overflow, pull, look, ramp, promised, parity, keep, sum, largest"
run 1 kernels.sk "${small[@]}" --kernel parity
says "parity: there are no floats in its results"
run 1 kernels.sk "${small[@]}" --kernel keep
says "'r' is a variable output, whose elements belong to no inputs"
run 1 kernels.sk "${small[@]}" --kernel pull --range q=0:1
says "there is no parameter 'q' to draw or set; there are g, far, b, w"
run 1 kernels.sk "${small[@]}" --kernel pull --set b.at=1,2,3
says "'b.at' has 2 scalar(s), but 3 values are given"
for range in x x=1 x=2:1 x=a:b =1:2:; do
  run 1 kernels.sk --range "$range"
  says "--range '$range' says nothing; write PARAM=LO:HI"
done
run 1 kernels.sk --set g
says "--set 'g' says nothing; write PARAM=VALUE"
run 1 kernels.sk --size 0x4
says '--size'
run 1 kernels.sk sum
says "a .sk file is measured by itself; leave out 'sum'"
run 1 sum --kernel pull
says '--kernel is for a .sk file; name one'
run 1 nosuch.sk
says "skc does not take 'nosuch.sk'"
run 1 kernels.sk --kernel pull -DFACTOR=1
says "'scale.sk'"
says "skc does not take 'kernels.sk'"
run 1 kernels.sk "${small[@]}" --skc "$place/nosuch"
says "there is no '$place/nosuch' to compile 'kernels.sk'; name one by --skc FILE or SK_SKC"
rm -r cache
CXX=$place/nosuch run 1 kernels.sk "${small[@]}"
says 'there is no C++ compiler'
CXX=false run 1 kernels.sk "${small[@]}"
says "'false' cannot compile"
run 0 kernels.sk "${small[@]}" --kernel ramp
CXX=false run 1 kernels.sk "${few[@]}" --size 64 --kernel ramp   # what another compiler made is not taken
SK_INCLUDE=$place run 1 kernels.sk "${small[@]}"
says "there are no headers of StreamKernel in '$place'"

echo "sk accuracy measures the kernels of files"
