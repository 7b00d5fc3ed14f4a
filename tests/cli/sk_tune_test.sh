#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# `sk tune`: finds what can be cheaper and what must be raised, verifies it on other inputs, and says why where it cannot. Errors are
# compared; times only where one choice takes less than half of another's.
# Usage: sk_tune_test.sh SK PROGRAM (tests/cli/tune/program.cpp)
set -euo pipefail
sk=$(realpath "$1")
program=$(realpath "$2")
tested=("$sk" tune)
source "$(dirname "${BASH_SOURCE[0]}")/frame.sh"
unset SK_PROFILE SK_CONFIG SK_RESULTS SK_CHECK
export SK_DEVICE=native SK_CACHE=$place/cache OMP_NUM_THREADS=1

# json EXPRESSION: what Python makes of all.json; `tuned` has the choices of the result by name and key, `tried` those of all trials.
json() { python3 -c "
import json
all = json.load(open('all.json'))
choices = lambda trial: {(c['name'], c['key']): c['value'] for c in trial['setting']}
tuned = choices(all['tuned'])
tried = [choices(t) for t in all['trials']]
$1" || broken "the JSON is not as expected: $1"; }
# has FILE TEXT, lacks FILE TEXT
has() { grep -qF -- "$2" "$1" || broken "$1 lacks: $2"; }
lacks() { ! grep -qF -- "$2" "$1" || broken "$1 has: $2"; }
# busy: other work has hidden, three times, what takes less than half of the time.
busy() { echo 'skipped: the machine is too busy to measure times'; exit 77; }
# refuses TEXT ARGUMENT...: ends with this message and a status of 1.
refuses() {
  run 1 "${@:2}"
  says "$1"
}

run 0 --help
for option in --tolerance --metric --result --result-file --psnr --result-json --verify --budget --output --json --chart \
  --allow-decisions --any-status --continue --fresh; do prints "$option"; done

# Cheaper: the kernel in doubles, which needs none, and nothing that is less exact than asked. The times of a busy machine may
# hide that once.
for attempt in 1 2 3; do
  run 0 --tolerance 1e-3 --budget 100s --json all.json --chart all.svg --verify "'$program' both 3000" -- "$program" both 12000
  grep -qF '[kernels."tuned::settle"]' tuned.toml && break
  ((attempt < 3)) || busy
done
has tuned.toml 'precision = "single"'
has tuned.toml '# results that count: tuned::state, tuned::rest, tuned::total (l2 0.001)'
has tuned.toml '# verified: '
has all.svg '<svg'
prints 'verified: '
json "
assert tuned['tuned::settle', 'precision'] == 'single', tuned
assert {(e['name'], e['key']) for e in all['evidence']} == set(tuned), all['evidence']
assert all['tuned']['ofTolerance'] <= 1 and all['verified'][0]['holds'], all
assert {('tuned::state', 'storage'): 'half'} in tried, tried
assert {r['name'] for r in all['results']} == {'tuned::state', 'tuned::rest', 'tuned::total'}, all['results']"
# The file does to the program what the search has measured: it runs, with other results than before.
SK_RESULTS=plain "$program" both 500 >/dev/null
SK_RESULTS=changed SK_CONFIG=tuned.toml "$program" both 500 >/dev/null
! cmp -s plain changed || broken 'the file changes nothing'

# On devices that queue calls, too, kernels are timed, and not the half second that the host works meanwhile.
SK_DEVICE=llvmpipe run 0 --tolerance 1e-3 --budget 100s -o busy.toml --json all.json -- "$program" busy 500
json "assert max(all['asItIs']['seconds']) < 0.4, all['asItIs']"

# More exact: the kernel that loses digits in floats, and no other. The right results come from the cache.
run 0 --tolerance 1e-6 --budget 100s --json all.json -- "$program" both 12000
prints 'raised, and none of them can be left out: tuned::subtract'
json "
assert all['raised'] == ['tuned::subtract'], all['raised']
assert tuned['tuned::subtract', 'precision'] == 'double' and all['asItIs']['ofTolerance'] > 100, all
without = [e['ofToleranceWithout'] for e in all['evidence'] if e['name'] == 'tuned::subtract']
assert len(without) == 1 and without[0] > 100, without
# One ratio: of the times in the first lines, in the JSON, and of the only choice.
import re
text = open('tuned.toml').read()
asItIs = float(re.search(r'as it is: (\S+) s', text)[1])
seconds, ratio = map(float, re.search(r'tuned: (\S+) s, (\S+) of the time', text).groups())
assert abs(seconds / asItIs - ratio) < 0.02 * ratio + 0.01 and abs(ratio - all['timeRatio']) < 0.006, (text, all['timeRatio'])
saved = [e['saved'] for e in all['evidence']]
assert len(tuned) > 1 or abs(1 - saved[0] - all['timeRatio']) < 1e-9, (saved, all['timeRatio'])"
# Goes on from the state, which has all trials, so that only times are measured again.
run 0 --tolerance 1e-6 --budget 100s --continue -- "$program" both 12000
prints 'raised, and none of them can be left out: tuned::subtract'
refuses 'is of another program, other arguments, or other results that count' --tolerance 1e-7 --continue -- "$program" both 12000
refuses "there is no state 'no.toml.state'" --tolerance 1e-7 -o no.toml --continue -- "$program" both 500
refuses 'nothing reaches the tolerance: the best is error ' --tolerance 1e-12 --budget 100s -- "$program" both 500
# The program gets its results as floats, whose rounding no choice can take away.
[[ $err =~ "'tuned::state' is read as floats: the right numbers have an error of "([0-9.e-]+)" (l2) when they are rounded to floats" ]] ||
  broken 'no word of the rounding of results'
python3 -c "assert 2e-9 < ${BASH_REMATCH[1]} < 2**-24" || broken 'rounding adds at most half a unit in the last place'
# What is written as text is not read as floats here.
run 0 --tolerance 1e-6 --budget 100s --result-json sums.json:run.sums.0 -- "$program" text sums.json 500
[[ $err != *'rounded to floats'* ]] || broken 'numbers of files are taken for floats'

# Only what is asked for counts, each by its own metric.
run 0 --result 'tuned::rest=ulp:4' --result tuned::total=relative:1e-3 --budget 100s --json all.json -- "$program" both 500
json "
assert [(r['name'], r['metric'], r['tolerance']) for r in all['results']] == [('tuned::rest', 'ulp', 4), ('tuned::total', 'relative', 1e-3)]
assert all['raised'] == ['tuned::subtract'], all['raised']"
run 0 --tolerance 1e-3 --budget 100s --result-json sums.json:run.sums.0 --json all.json -- "$program" text sums.json 500
json "assert [r['name'] for r in all['results']] == ['sums.json:run.sums.0'], all['results']"

# A choice of the call itself gives way.
for attempt in 1 2 3; do
  run 0 --tolerance 1e-5 --budget 100s -o called.toml -- "$program" called 12000
  grep -qF 'force = true' called.toml && break
  ((attempt < 3)) || busy
done
has called.toml 'precision = "single"'

# The folder for temporary files may have any name.
mkdir 'a,times %p%%'
TMPDIR=$place/'a,times %p%%' run 0 --tolerance 1e-3 --budget 100s -- "$program" both 100

# All ways to read, each by its name.
run 0 --tolerance 1e-3 --budget 100s --json all.json -- "$program" reads 100
json "
assert {r['name'] for r in all['results']} == {'hits.t', 'hits.id', 'tuned::state', 'stream 3', 'stream 5', 'scalar',
                                               'tuned::extremes.least', 'tuned::extremes.most'}, all['results']"
run 0 --tolerance 1e-3 --budget 100s -- "$program" fork 100
prints 'note: the program has forked 1 time(s)'

# What does not hold on other inputs is no result: with numbers of 1e30, floats overflow where doubles do not.
for attempt in 1 2 3; do
  "$sk" tune --tolerance 1e-3 --budget 100s -o wide.toml --verify "'$program' settle 100 1e30" -- "$program" settle 12000 \
    >out.txt 2>err.txt || break
  ((attempt < 3)) || busy
  rm wide.toml
done
line='sk tune ... wide.toml' out=$(<out.txt) err=$(<err.txt)
says "it is kept as 'wide.toml.rejected'"
prints 'rejected: '
has wide.toml.rejected 'precision = "single"'
[[ ! -e wide.toml ]] || broken 'the rejected file has its own name'

# A command line that cannot serve is refused before the search.
early() { refuses "$1" --tolerance 1e-3 --verify "$2" "${@:3}" -- "$program" both 500; }
early "--verify 'nothere 4' ends with status 127" 'nothere 4'
early "ends with status 3" "'$program' status 50"
early "has recorded no results: it opens no device" true
early "reads no 'tuned::rest', 'tuned::total', as the program does; it reads tuned::state" "'$program' settle 50"
early "calls no kernel of the program, such as tuned::settle" "'$program' light 50"
early "cannot be judged: '/bin/sh' runs tuned::settle on 'native' even with SK_DEVICE=reference" "'$program' named 50"
early "reads no 'tuned::rest', as the program does" "'$program' settle 50" --result tuned::rest
# So are files that cannot be written.
for option in -o --json; do refuses "cannot write 'no/such.file'" --tolerance 1e-3 $option no/such.file -- "$program" both 500; done
refuses "cannot write 'no/such.svg'" --tolerance 1e-3 --chart no/such.svg -- "$program" both 500

# What is wide because a file says so is tried as floats together: a kernel alone, or a stream alone, would convert all elements.
printf '[kernels."*"]\nprecision = "double"\n[streams."*"]\nstorage = "double"\n' >base.toml
SK_CONFIG=$place/base.toml run 0 --tolerance 1e-4 --budget 100s -o light.toml --json all.json -- "$program" light 300000
json "
narrow = {('tuned::blend', 'precision'): 'single', ('tuned::state', 'storage'): 'single'}
assert any(narrow.items() <= trial.items() for trial in tried), tried"

# A search starts from the file that is in force; one of another program is refused.
printf '[kernels."tuned::subtract"]\nprecision = "double"\ncontraction = "exact"\n' >base.toml
export SK_CONFIG=$place/base.toml
run 0 --tolerance 1e-6 --budget 100s -o based.toml -- "$program" subtract 500
lacks <(printf %s "$out") 'raised'
has based.toml 'contraction = "exact"'
sed -i 's/tuned::subtract/ocean::waves/' base.toml
refuses "has a kernel 'ocean::waves', but" --tolerance 0.5 -- "$program" subtract 500
unset SK_CONFIG

# Files that the program writes.
run 0 --tolerance 1e-3 --budget 100s --result-file state.npy --json all.json -- "$program" array state.npy 500
json "assert [r['name'] for r in all['results']] == ['state.npy'] and 0 < all['asItIs']['errors'][0]['error'] < 1e-7, all['asItIs']"
run 0 --result-file state.tga --psnr 40 --budget 100s --json all.json -- "$program" picture state.tga 500
json "assert all['results'] == [{'name': 'state.tga', 'metric': 'psnr', 'tolerance': 40}], all['results']"
refuses "there is no tolerance for 'state.npy'; give --tolerance" --result-file state.npy -- "$program" array state.npy 500

# The right results are kept by the contents of the program, also of one that a shell finds in a command line.
cp "$program" copy
kept() { find cache -name 'truth-*' | wc -l; }
runBoth() {
  refuses 'nothing reaches the tolerance' --tolerance 1e-12 --budget 100s -- ./copy settle 80
  refuses 'nothing reaches the tolerance' --tolerance 1e-12 --budget 100s -- sh -c './copy settle 90'
}
runBoth
first=$(kept)
runBoth
(($(kept) == first)) || broken 'the same program has other right results'
echo >>copy
runBoth
(($(kept) == first + 2)) || broken 'another program has the same right results'

# Decisions stay as they are, unless they may change.
run 0 --tolerance 1e-3 --budget 100s -o odd.toml -- "$program" odd 12000
lacks odd.toml 'tuned::settle'
prints "not possible: tuned::settle: precision single: 'flags', of integers, has other values (--allow-decisions lets it)"
for attempt in 1 2 3; do
  run 0 --tolerance 1e-3 --budget 100s -o odd.toml --allow-decisions -- "$program" odd 12000
  grep -qF 'tuned::settle' odd.toml && break
  ((attempt < 3)) || busy
done
refuses 'reads only integers' --tolerance 1e-3 -- "$program" decide 500

refuses 'reads other numbers in each run (' --tolerance 1e-3 -- "$program" random 500
refuses "ends with status 3
  loading
  there is no field today" --tolerance 1e-3 -- "$program" status 500
refuses 'reads nothing from its devices' --tolerance 1e-3 --any-status -- "$program" status 500
refuses 'ends by signal 6' --tolerance 1e-3 -- "$program" signal 500
refuses 'reads nothing from its devices' --tolerance 1e-3 -- "$program" silent 500
refuses "runs tuned::settle on 'native' even with SK_DEVICE=reference" --tolerance 1e-3 -- "$program" named 500
refuses "the program reads no 'tuned::rst'; did you mean 'tuned::rest'?" --tolerance 1e-3 --result tuned::rst -- "$program" both 500
refuses "'sums.json' has no 'sum' (of 'run.sum'); there are sums" --tolerance 1e-3 --result-json sums.json:run.sum -- "$program" text sums.json 500
refuses "does not write 'other.json'" --tolerance 1e-3 --result-json other.json:run -- "$program" text sums.json 500
refuses "'run.json' names no number in a file" --tolerance 1e-3 --result-json run.json -- "$program" both 500
refuses "has recorded no results: it opens no device" --tolerance 1e-3 -- true
refuses 'starts 2 processes' --tolerance 1e-3 -- sh -c "'$program' both 9; '$program' both 9"
refuses "there is no program './nothere'" --tolerance 1e-3 -- ./nothere
refuses "there is no metric 'l3'; choose one of relative, absolute, ulp, l2, psnr" --tolerance 1e-3 --metric l3 -- "$program" both 500
refuses "'0' is no tolerance above 0" --result tuned::rest=l2:0 -- "$program" both 500
for number in -1 0 nan inf 1e-400 1e400 x; do
  refuses "--tolerance: '$number' is no number above 0; give one such as 1e-5" --tolerance $number -- "$program" both 500
  refuses "--psnr: '$number' is no number above 0" --psnr $number --result-file state.tga -- "$program" picture state.tga 500
done
for number in -1 nan inf 1e400; do
  refuses "'$number' is no tolerance above 0" --result tuned::rest=l2:$number -- "$program" both 500
done
run 0 --help
[[ $out != *00000000000000000000* ]] || broken 'numbers are printed with hundreds of digits'
refuses '--tolerance is required' -- "$program" both 500
refuses 'is too small: a run of' --tolerance 1e-3 --budget 0.001 -- "$program" both 500
refuses "'soon' is no budget" --tolerance 1e-3 --budget soon -- "$program" both 500
refuses 'its name must end in .svg or .png' --tolerance 1e-3 --chart all.txt -- "$program" both 500
refuses 'program is required' --tolerance 1e-3
