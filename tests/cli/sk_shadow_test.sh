#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# `sk shadow` on the sample reports: each part is printed, one kernel in full, the page again, and what is no report is refused with a
# way out. docs/accuracy.md shows what is printed.
# Usage: sk_shadow_test.sh SK
set -euo pipefail
sk=$(realpath "$1")
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
tested=("$sk" shadow)
source "$here/frame.sh"
cp "$here"/shadow/*.json .
accuracy=$here/../../docs/accuracy.md

# before TEXT TEXT: a line with the first text stands before one with the second.
before() {
  local first second
  first=$(grep -nF -- "$1" out.txt | head -n 1 | cut -d : -f 1)
  second=$(grep -nF -- "$2" out.txt | head -n 1 | cut -d : -f 1)
  ((${first:-0} > 0 && ${second:-0} > first)) || broken "'$1' does not stand before '$2'"
}

# A program without a fault: no part about faults.
run 0 healthy.json
prints 'heat 512 on llvmpipe (LLVM 15.0.6, 256 bits), beside double: 1001 calls, all followed'
matches '^  fine +All results keep 5\.8 digits or more'
matches '^  heat::total +5\.8 +1\.6e-06 +1\.6e-06 +1 +1 +0  96 % heat::sum, 4\.0 % heat::diffuse$'
before 'heat::total' 'heat::u'  # by error
matches '^  heat::diffuse +82 % +5\.9 +4\.5e-08 +1\.2e-06 +1 +1000 +490 ms +0 +0$'
before '  heat::diffuse   82 %' '  heat::sum       18 %'  # by share
prints '3 times as long as without the shadow'
[[ $out != *exceptional* && $out != *decisions\ that* && $out != *nothing\ read* ]] || broken 'an empty part is printed'

# NaN, decisions, and all of the account.
run 0 exceptional.json
matches '^  nan +flow::project makes 3 NaN'
before 'nan       flow::project' 'decision  flow::count'
matches '^  flow::v +none +NaN +NaN +3 +4096 +0  61 % flow::project, 35 % flow::press, 3\.0 % flow::count, 1 other$'
matches '^  flow::project +61 % +none +NaN +NaN +inf +1200 +410 ms +3 NaN +0$'
prints 'nan in call 1000: v[17][4] of flow::project is nan, not 0.0004882812500001 (0x1.000000000039ap-11), like 2 other elements of this call'
matches '^    u +-1\.5 \(-0x1\.8000000000000p\+0\) +-1\.5000000123 '
prints 'then call 1003: v of flow::project (25 elements)'
matches '^  400 +flow::count  n\[31\] +2 +7 +8  its own$'
matches '^  401 +flow::count  n\[31\] +5 +7 +9  its inputs differ$'
matches '^  flow::press  residual +1200  50 ms$'
matches '^  flow::p +25 %  300 ms$'
matches '^  flow::count +<0\.1 %  110 ms  No result needs'
prints 'Call 1201 (flow::paint) was not followed'
shown=$(sed -n '/^<!-- sk shadow -->/,/^```$/p' "$accuracy" | sed '1,2d;$d')
((${#shown} > 500)) || broken 'docs/accuracy.md shows no report'
while IFS= read -r text; do
  grep -qxF -- "$text" out.txt || broken "docs/accuracy.md shows what it does not print: $text"
done <<<"$shown"

# One kernel, by the end of its name.
run 0 exceptional.json --kernel press
prints 'flow::press: 1200 calls, all followed, 320 ms'
matches '^  of it, storing +2\.2e-07 +2\.1e-07$'
prints 'p[0][63] of call 850 is 0.625 (0x1.4000000000000p-1), not 0.62501923'
matches '^  p +half  1 to 1200  own +0 +2\.4e-07 +2\.4e-07 +2\.4e-07 +8$'
matches '^ +total +2\.4e-07 .* NaN +NaN +1001$'
prints 'flush in call 64'
[[ $out != *'nan in call'* ]] || broken 'exceptional values of another kernel'
run 1 exceptional.json --kernel flow::pres
says "the report has no kernel 'flow::pres'; did you mean 'flow::press'?"
run 1 exceptional.json --kernel zzz
says "the report has no kernel 'zzz'; it has flow::project, flow::press, flow::count"
run 1 empty.json --kernel zzz
says "the report has no kernel 'zzz'; it has none"

# Nothing at all, and several ranks.
run 0 empty.json
prints 'nothing   The program called no kernel'
prints 'none were called'
run 0 ranks.json
prints '2002 calls, 1002 followed, 2 ranks'
prints 'ended early: the memory of the reference (8 GB) was exhausted in call 501'
prints "one of 2 calls of heat::*; the reference takes the device's decisions"
matches '^  1 +llvmpipe \(LLVM 15\.0\.6, 256 bits\) +1001$'

# Errors that make others smaller, and what an element was computed from.
python3 - <<'PY'
import json
report = json.load(open("exceptional.json"))
press = report["kernels"][1]
press.update(share=0, compensates=True)
press["worst"]["source"] = "of a gather, the element at the same index is shown"
press["worst"]["inputs"][0]["at"] = [0, 63]
json.dump(report, open("compensating.json", "w"))
PY
run 0 compensating.json
matches '^  flow::press +<0 % '
run 0 compensating.json --kernel press
matches '^  share +<0 % of the results'
prints '    of a gather, the element at the same index is shown'
matches '^    [a-z]+\[0\]\[63\] '

# Long tables are cut, unless all is asked for; no members of a later version are in the way.
python3 - <<'PY'
import json
report = json.load(open("exceptional.json"))
report["kernels"] = [dict(report["kernels"][1], name=f"many::k{i}", share=1 / (i + 1)) for i in range(500)]
report["exceptions"][0]["path"] *= 100
report["notes"] = ["a\x1b[2Jb"]
json.dump(report, open("many.json", "w"))
PY
run 0 many.json
matches '^  many::k19 '
prints 'and 480 more; --all shows them'
prints '... 191 more calls'
prints 'a [2Jb'
[[ $out != *many::k20\ * ]] || broken 'more than 20 kernels'
run 0 many.json --all
matches '^  many::k499 '

# The page: the report as it is, in a page that needs nothing else.
run 0 exceptional.json --html page.html
grep -qF 'reads a texture that the application wrote \u003citself>.' page.html || broken 'no report in the page'
grep -qF 'const report = {' page.html || broken 'no script in the page'
[[ $(grep -c 'REPORT' page.html) == 0 ]] || broken 'the marker is still there'
run 1 exceptional.json --html no/such/folder/page.html
says "cannot write 'no/such/folder/page.html'"

# What is no report.
run 1 missing.json
says "there is no file 'missing.json'"
run 1 .
says "cannot read '.'"
head -c 3000 exceptional.json >cut.json
run 1 cut.json
says "'cut.json' is cut off"
: >nothing.json
run 1 nothing.json
says "'nothing.json' is cut off"
sed '4s/:/=/' healthy.json >wrong.json
run 1 wrong.json
says "'wrong.json' is no JSON, from line 4 on"
run 1 page.html
says "'page.html' is a page; give its report, the .json file beside it"
echo '{"format": "another"}' >another.json
run 1 another.json
says "'another.json' is no report of SK_SHADOW"
echo '[1, 2]' >list.json
run 1 list.json
says "'list.json' is no report of SK_SHADOW"
sed 's/"version": 1/"version": 2/' healthy.json >later.json
run 1 later.json
says "'later.json' has version 2 of the report, and this sk reads version 1"
sed '/"results"/,$ s/"digits": 5.9/"digits": "many"/' healthy.json >damaged.json
run 1 damaged.json
says "'damaged.json' is damaged: 'results[0].digits' is no number"
sed '0,/"seconds": 0.49,/s///' healthy.json >lacking.json
run 1 lacking.json
says "'lacking.json' is damaged: 'kernels[0].seconds' is missing"
run 1
says 'file'
run 0 --help
for option in --kernel --all --html; do prints "$option"; done
echo "sk shadow tells what it should"
