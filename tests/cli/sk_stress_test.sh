#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# `sk stress`: finds where programs break at the ends of what they are given, and nothing where they hold.
# Usage: sk_stress_test.sh SK PROGRAM (tests/cli/stress/program.cpp)
set -euo pipefail
sk=$(realpath "$1")
program=$(realpath "$2")
tested=("$sk" stress)
source "$(dirname "${BASH_SOURCE[0]}")/frame.sh"
unset SK_PROFILE SK_CONFIG SK_RESULTS SK_CHECK SK_SHADOW
export SK_DEVICE=native SK_CACHE=$place/cache OMP_NUM_THREADS=1

# json EXPRESSION: what Python makes of all.json; `kinds` has the kinds of findings by the text of the case.
json() { python3 -c "
import json
all = json.load(open('all.json'))
kinds = {r['text']: [f['kind'] for f in r['findings']] for r in all['runs']}
texts = {r['text']: ' '.join(f['text'] for f in r['findings']) for r in all['runs']}
broken = {r['text'] for r in all['runs'] if r['breaks']}
$1" || broken "the JSON is not as expected: $1"; }

for number in -1 nan 0 1e-400; do
  run 1 --limit $number -- "$program" step 20
  says "--limit: '$number' is no number from 0.001 to 1e+07"
done
run 1 --json no/such.json -- "$program" step 20
says "cannot write 'no/such.json'"
run 0 --help
for option in --only --sizes --limit --json --keep --all --any-status; do prints "$option"; done

# An unstable step within its range is named with its factor; the same step with the right range holds.
run 1 --json all.json -- "$program" step 100
json "
import re
cases = [r for r in all['runs'] if r['kind'] != 'asItIs' or r['findings']]  # those that --all lists
assert '''$err'''.strip().endswith(f'breaks in 1 of {len(cases)} cases'), '''$err'''"
prints 'stressed::step.k = 1, the upper end of its range'
matches 'unstable time step: the error grows by a factor of (2\.[89]|3)[0-9.]* with each call of stressed::step'  # 3 for the shortest wave
json "
assert all['format'] == 'streamkernel-stress' and all['version'] == 1 and all['broken'] == 1, all
assert broken == {'stressed::step.k = 1, the upper end of its range'}, broken
assert 'unstable' in kinds['stressed::step.k = 1, the upper end of its range'], kinds
assert kinds['stressed::step.x = 0 everywhere'] == [], kinds
assert kinds['stressed::step.x[50] = nan'] == ['spread'], kinds"
run 0 --all --json all.json -- "$program" stable 100
prints 'stressed::stableStep.k = 0.5, the upper end of its range'
json "assert not broken and all['broken'] == 0 and any('stableStep.x' in text for text in kinds), kinds"

# Division by the end of a range, with where the infinity comes from.
run 1 --json all.json -- "$program" divide 20
prints 'stressed::reciprocal.x = 0 everywhere, the lower end of its range'
prints "20 of 20 elements of 'v' are NaN or infinite; the infinity comes from stressed::reciprocal, call 1"
json "
assert broken == {'stressed::reciprocal.x = 0 everywhere, the lower end of its range'}, broken
assert not any('nan' in text for text in kinds), kinds"

# Without ranges, nothing breaks; but what changes is said. Values that kernels share change together.
run 0 --all --json all.json -- "$program" plain 20
prints 'changes where no range is declared'
json "
assert 'notFinite' in kinds['factor of stressed::scale and stressed::offset = 3.40282347e+38, huge'], kinds
assert kinds['stressed::scale.shift = 1'] == [] and not broken, kinds"
run 0 --only 'stressed::scale.shift' --json all.json -- "$program" plain 20
json "assert len(kinds) == 3 and all['runs'][2]['settings'] == ['stressed::scale.shift:1'], all['runs']"
run 1 --only 'stressed::nothing' -- "$program" plain 20
says '--only stressed::nothing matches nothing that the host gives; it gives stressed::scale.factor, stressed::scale.shift, '

# What grows as it should is no unstable step; what vanishes need not have digits; vectors are counted by numbers.
run 0 --all --json all.json -- "$program" accrue 20
json "
assert 'unstable' in kinds['stressed::accrue.rate = 0.2, the upper end of its range'], kinds
assert 'and so does what it computes' in texts['stressed::accrue.rate = 0.2, the upper end of its range'], texts"
run 1 --json all.json -- "$program" vectors 20
json "
assert broken == {'stressed::directions.d = 0 everywhere, the lower end of its range'}, broken
assert '60 of 60 numbers of' in texts['stressed::directions.d = 0 everywhere, the lower end of its range'], texts"
# Infinite results have no digits.
run 1 --json all.json -- "$program" far 20
json "
assert broken == {'stressed::far.x = 1e+30 everywhere, the upper end of its range'}, broken
assert all['runs'][2]['results'][0]['error'] == 'inf' and 'where double has a number' in texts[all['runs'][2]['text']], all['runs'][2]"

# Loops that do not converge, those of the device and those of the program.
run 1 --only 'stressed::approach.keep' --json all.json -- "$program" loop 20
json "
assert broken == {'stressed::approach.keep = 1, the upper end of its range'}, broken
assert 'stops at its limit: 500 iterations, ' in texts['stressed::approach.keep = 1, the upper end of its range'], texts"
run 1 --only 'stressed::approach.keep' --json all.json -- "$program" host 20
json "
assert broken == {'stressed::approach.keep = 1, the upper end of its range'}, broken
assert 'calls stressed::approach 500 times' in texts['stressed::approach.keep = 1, the upper end of its range'], texts"

# Sizes: a crash breaks the program, a refusal does not.
run 1 --only 'stressed::scale.shift' --sizes 1,2,17 --json all.json -- "$program" crash '{20}'
json "assert broken == {'size 1'} and kinds['size 1'] == ['crash'] and kinds['size 17'] == [], kinds"
run 0 --only 'stressed::scale.shift' --sizes 1,2 --json all.json -- "$program" refuse '{20}'
json "assert kinds['size 1'] == ['status'] and 'the size 1 is odd' in texts['size 1'] and kinds['size 2'] == [], texts"
run 0 --only 'stressed::scale.shift' -- "$program" plain 20
prints 'put one in braces, --size={256}'

# A limit ends a run, and the pages of all runs can be kept.
run 0 --only 'stressed::scale.shift' --keep pages -- "$program" plain 20
[[ -s pages/000.html && -s pages/002.json ]] || broken 'the pages are not kept'
# Whatever the names of folders have that SK_SHADOW's value has, too.
for name in 'a,every=2' 'a b=c%p' '%%p\,d' "$(printf 'n%.0s' {1..240})"; do
  run 0 --only 'stressed::scale.shift' --keep "$name" -- "$program" plain 20
  [[ $(ls "$name") == $(ls pages) ]] || broken "the pages are not kept in '$name': $(ls "$name")"
  mkdir "temporary $name"
  TMPDIR="$place/temporary $name" run 0 --only 'stressed::scale.shift' -- "$program" plain 20
done
# The files of the program are in the end those of the program as it is.
"$program" store results.txt
cp results.txt before.txt
run 0 --only 'stressed::scale.*' -- "$program" store results.txt
cmp -s results.txt before.txt || broken 'the results are those of an extreme'

# A run that hangs has told what it did, and a run that is interrupted leaves nothing behind.
run 0 --only 'stressed::offset.x' --limit 3 --json all.json -- "$program" hang 20
json "
hung = next(text for text in kinds if 'e+38 everywhere, huge' in text and '-3' not in text)
assert kinds[hung] == ['unended'] and 'it had made ' in texts[hung] and 'made 0 calls' not in texts[hung], texts"
mkdir temporary
(TMPDIR=$place/temporary exec "$sk" stress -- "$program" hang 20 >/dev/null 2>interrupted) & search=$!
sleep 0.3
kill -TERM $search
wait $search && broken 'an interrupted search ends with status 0'
grep -q 'interrupted by signal 15' interrupted || broken 'an interrupted search does not say so'
[[ -z $(ls temporary) ]] || broken "an interrupted search leaves $(ls temporary)"

# What cannot be stressed is refused.
refuses() {
  run 1 "${@:2}"
  says "$1"
}
refuses "as it is, '$program' ends with status 3" -- "$program" status
run 0 --any-status --only 'stressed::scale.shift' -- "$program" status
refuses 'reads no result from its streams' -- "$program" silent
refuses "'$program' starts 2 processes with devices" -- "$program" twice
SK_CHECK=written refuses 'SK_CHECK=written is set' -- "$program" plain
refuses "there is no program ''" -- ""
refuses 'calls no kernel' -- "$program" nothing
refuses 'leaves no report of a shadow' -- true
refuses "there is no program './missing'" -- ./missing
refuses '--sizes' --sizes 0 -- "$program" plain
refuses "cannot write '/nowhere/all.json'" --json /nowhere/all.json -- "$program" plain
refuses 'program is required'
# A setting that is not valid leaves the program as it is.
SK_SHADOW=report.json,set=scale:1 "$program" plain 2>messages || broken 'an invalid setting ends the program'
grep -q "set is 'scale:1'; give KERNEL.PARAMETER:NUMBER" messages || broken 'an invalid setting is not named'
# One that names nothing is told in the report.
SK_SHADOW=report.json,set=stressed::scale.fact:1 "$program" plain
grep -q 'set=stressed::scale.fact has changed nothing' report.json || broken 'a setting without effect is not told'
# Names of files and programs may be any bytes.
cp "$program" $'odd\xff'
run 0 --only '*.shift' -- "./"$'odd\xff' plain
echo ok
