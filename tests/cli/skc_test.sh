#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# skc's command line: what it writes and where, and that every bad input ends with status 1 and one
# message, never a crash, a hang or silence. What kernels mean is tested elsewhere.
# Usage: skc_test.sh SKC
set -euo pipefail
skc=$(realpath "$1")
tested=(timeout 20 "$skc")
source "$(dirname "${BASH_SOURCE[0]}")/frame.sh"

silent() { [[ -z $err ]] || broken "standard error is not empty"; }

# refuses MESSAGE ARGUMENT...: one error, status 1, and no output left behind.
refuses() {
  local message=$1
  shift
  run 1 "$@" -o refused
  says "$message"
  (($(grep -c 'error: ' err.txt) <= 1)) || broken "more than one error"
  [[ -z $out ]] || broken "standard output is not empty"
  [[ -z $(find refused -type f 2>/dev/null) ]] || broken "an output is left behind"
}

cat >heat.sk <<'EOF'
#include "weights.sk"
kernel void diffuse(float k, [[wrap]] float u[][], out float v<>) {
  int2 p = indexof(v).xy;
  v = u[p.y][p.x] + k * WEIGHT * (neighbor(u, 1, 0) - neighbor(u, -1, 0));
}
reduce void sum(float x<>, reduce float total<> = 0) { total += x; }
EOF
mkdir include
echo '#define WEIGHT 0.25f' >include/weights.sk

# Help and version.
run 0 --help
prints 'FILE'
for option in -o --emit --target --profile --kernel --isolated -I -D -W -g -O --depfile --print-after --library --shadow --device --target-triple --levels \
  --lanes --quad --version; do
  prints " $option"
done
run 0 --version
[[ $out =~ ^skc\ [0-9]+\.[0-9]+\.[0-9]+ ]] || broken "no version"

# Stubs and the object file, and the depfile that rebuilds them.
run 0 -Iinclude heat.sk
silent
[[ -s heat.sk.hpp && -s heat.sk.cpp && -s heat.sk.o ]] || broken "no stubs or no object beside the caller"
run 0 -I include -o "a folder" --depfile=heat.d heat.sk
silent
for part in hpp cpp o; do
  cmp -s "heat.sk.$part" "a folder/heat.sk.$part" || broken "heat.sk.$part depends on where it is written"
  grep -qF "a\ folder/heat.sk.$part" heat.d || broken "the depfile lacks heat.sk.$part: $(<heat.d)"
done
grep -qF 'include/weights.sk' heat.d || broken "the depfile lacks the included file: $(<heat.d)"

# A module for browsers, and its types.
run 0 --emit=js -Iinclude -o web --depfile=web.d heat.sk
silent
grep -qF 'export const diffuse = $file.callable(0);' web/heat.sk.js || broken "no kernel in heat.sk.js"
grep -qF ', $programs, {folds: $sk.folds});' web/heat.sk.js || broken "heat.sk.js asks for other features than folds"
[[ $(<web/heat.sk.js) != *sk_sqrt* ]] || broken 'heat.sk.js has functions that its programs do not call'
grep -qF 'diffuse: sk.Kernel<[k: number | sk.Held<'"'float'"'>, u: sk.Gather<'"'float'"', 2>, v: sk.Output<'"'float'"'>]>;' web/heat.sk.d.ts ||
  broken "no type of diffuse: $(<web/heat.sk.d.ts)"
grep -qF 'sum: sk.Reduce<[x: sk.Input<'"'float'"'>], number, [x: sk.Input<'"'float'"'>, total: sk.Output<'"'float'"'>]>;' web/heat.sk.d.ts || broken "no type of sum: $(<web/heat.sk.d.ts)"
[[ ! -e web/heat.sk.cpp ]] || broken "a stub beside the module"
grep -qF 'web/heat.sk.d.ts' web.d || broken "the depfile lacks the types: $(<web.d)"
cat >scan.sk <<'EOF'
scan void prefix(int x<>, scan int s<> = 0) { s += x; }
EOF
run 0 --emit=js -o web scan.sk
silent
grep -qF 'prefix: sk.Scan<[x: sk.Input<'"'int'"'>, s: sk.Output<'"'int'"'>]>;' web/scan.sk.d.ts || broken "no type of prefix: $(<web/scan.sk.d.ts)"

# Programs for browsers do not multiply with the streams of a kernel.
{
  echo 'kernel void many(float a0[], '
  for i in {1..14}; do echo "float a$i[], "; done
  echo 'iter int n<>, iter float m<>, out float r<>) { int i = n; r = m + a0[i]'
  for i in {1..14}; do echo " + a$i[i]"; done
  echo '; }'
} >many.sk
run 0 --emit=js -o web many.sk
(($(wc -c <web/many.sk.js) < 200000)) || broken "many.sk.js has $(wc -c <web/many.sk.js) bytes"

# codeSymbols FILE.sk.cpp: the native code that the stub refers to.
codeSymbols() { grep -oE 'sk_[0-9a-f]{16}_[A-Za-z0-9_]+' "$1" | sort -u; }

# The stub refers to native code that the object defines, unless other targets are named.
codeSymbols heat.sk.cpp | grep -q '_diffuse$' || broken "the stub refers to no native code"
if command -v nm >/dev/null; then
  codeSymbols heat.sk.cpp | cmp -s - <(nm --defined-only --extern-only --format=just-symbols heat.sk.o | sort) ||
    broken "the object defines other symbols than the stub refers to"
fi
run 0 -Iinclude -o fragment --target=fragment heat.sk
grep -qF '.code = ' fragment/heat.sk.cpp && broken "--target=fragment writes native code"
[[ ! -e fragment/heat.sk.o ]] || broken "--target=fragment writes an object"

# What a shadow computes beside kernels is in modules that ask for it.
run 0 --emit=js -Iinclude -o web heat.sk
! grep -q '"shadow":' web/heat.sk.js || broken "a module has what nobody asked for"
run 0 --emit=js --shadow --precision=single -Iinclude -o web heat.sk
[[ $(grep -o '"shadow":{"name"' web/heat.sk.js | wc -l) == 2 ]] || broken "a kernel and a reduce lack what --shadow adds"
run 1 --shadow -Iinclude heat.sk
says '--shadow adds to modules for browsers; write --emit=js, too, or leave it out'

# With --isolated, no other file is read, and none is found.
echo 'the secret;' >secret.sk
kernel='kernel void f(out float r<>) { r = 1; }'
for asks in '#include "secret.sk"' "#include \"$PWD/secret.sk\"" "#include <$PWD/secret.sk>" '#include "/etc/passwd"'; do
  printf '%s\n%s\n' "$asks" "$kernel" >alone.sk
  run 1 --isolated --emit=glsl alone.sk
  says 'file not found'
  [[ $err != *secret\;* && $err != *root:* ]] || broken "a message quotes another file"
done
printf '#if __has_include("secret.sk")\n#error found\n#endif\n%s\n' "$kernel" >alone.sk
run 0 --isolated --emit=glsl alone.sk
run 1 --emit=glsl alone.sk
echo "$kernel" >plain.sk
run 0 --isolated -o alone "$PWD/../${PWD##*/}/plain.sk"
run 1 --isolated -I. --emit=glsl alone.sk
says '--isolated reads no included file; leave out -I'

# Symbols do not depend on folders, and differ between files.
mkdir elsewhere
cp heat.sk elsewhere
run 0 -Iinclude -o elsewhere "$PWD/elsewhere/heat.sk"
cmp -s <(codeSymbols heat.sk.cpp) <(codeSymbols elsewhere/heat.sk.cpp) || broken "symbols depend on the folder of the file"
cp heat.sk cold.sk
run 0 -Iinclude -o elsewhere cold.sk
[[ -z $(comm -12 <(codeSymbols heat.sk.cpp) <(codeSymbols elsewhere/cold.sk.cpp)) ]] || broken "two files share a symbol"

# An object without kernels, for build rules that name their outputs beforehand.
echo 'stream float field<height, width>;' >declared.sk
run 0 declared.sk
[[ -s declared.sk.o ]] || broken "no object without kernels"

# What is printed.
run 0 -Iinclude --emit=glsl heat.sk
prints '#version 330'
run 0 -Iinclude --emit=glsl --profile=webgl2 --kernel=diffuse heat.sk
prints '#version 300 es'
run 0 -Iinclude --emit=glsl --profile=essl300 --kernel=diffuse heat.sk
prints '#version 300 es'
prints 'diffuse'
[[ $out != *sum* ]] || broken "--kernel=diffuse prints more"
run 0 -Iinclude --emit=llvm --kernel=diffuse heat.sk
prints '_diffuse'
[[ $out != *_sum* ]] || broken "--kernel=diffuse prints more"
run 0 -Iinclude --emit=asm heat.sk
prints '_diffuse'
run 0 -Iinclude --emit=ir heat.sk
prints 'diffuse'
run 0 -Iinclude --emit=ast heat.sk
prints 'diffuse'
run 0 -Iinclude --print-after=all heat.sk
prints 'diffuse'
prints '// after predicate'
run 0 -Iinclude --print-after=all --target=fragment heat.sk
[[ $out != *'after predicate'* ]] || broken "predicate is printed without native code"
run 0 -Iinclude --print-after=predicate heat.sk
[[ $out == '// after predicate'* ]] || broken "--print-after=predicate prints more, or nothing"

# Plans for the limits of devices that sk info has measured.
cat >large.sk <<'SK'
kernel void spread(float x<>, out float4 a<>, out float4 b<>, out float4 c<>, out float4 d<>, out float4 e<>, out float4 f<>) {
  a = x; b = x; c = x; d = x; e = x; f = x;
}
SK
cat >devices.json <<'JSON'
{"devices": [{"name": "native"},
             {"name": "wide", "limits": {"draw_buffers": 8, "texture_units": 16}},
             {"name": "narrow", "limits": {"draw_buffers": 5, "texture_units": 16}}]}
JSON
run 0 --emit=plan large.sk
prints 'glsl330: 8 draw buffers'
echo 'kernel void deposit(int at<>, float x<>, out float sums[], out int counts[]) { sums[at] += x; ++counts[at]; }' >deposit.sk
run 0 --emit=plan deposit.sk
prints 'sums combines values in order: drawn, as points; dispatched, as sorted records'
run 0 --emit=plan --device=devices.json large.sk
prints 'wide: 8 draw buffers'
prints 'narrow: 5 draw buffers'
prints '6 planes written, 1 read: 2 passes'
run 0 --device=devices.json large.sk
run 0 --emit=plan --profile=essl300 large.sk
prints 'essl300: 4 draw buffers'
refuses "'nowhere.json' cannot be read" --device=nowhere.json large.sk

# Bounds of rounding errors.
echo 'kernel void product(float2 v<>, out float r<>) { r = v.x * v.y; }' >product.sk
run 0 --emit=bounds product.sk
prints 'not bounded: give v.x a range: --range v.x=LOW:HIGH, or --range v=LOW:HIGH'
run 0 --emit=bounds --range v=0:1 --range v.y=2 product.sk
prints 'r: 0 to 2, error at most 0'
run 0 --emit=bounds --range v=1:2 --json --target=fragment product.sk
prints '"target": "fragment"'
# A kernel that cannot run in a precision has no bound there.
echo 'kernel void turn(float2x2 m<>, float2 v<>, out float2 r<>) { r = m * v; }' >turn.sk
for precision in extended double; do
  run 0 --emit=bounds --range m=1:2 --range v=1:2 --target=fragment --precision=$precision turn.sk
  prints "not bounded: it has no form in $precision precision: matrices are of floats"
done
run 0 --emit=bounds --range m=1:2 --range v=1:2 --precision=single turn.sk
[[ $out != *'not bounded'* ]] || broken 'matrices of floats have bounds'
refuses "'v' is not a range; write NAME=LOW:HIGH" --emit=bounds --range v product.sk
for number in -1 0 nan inf x; do
  refuses "--elements: '$number' is no number of elements; give one such as 1000 or 1e6" --emit=bounds --elements $number product.sk
done
refuses '--range, --elements and --json are for --emit=bounds' --range v=0:1 product.sk
refuses '--emit=bounds takes one target, native or fragment' --emit=bounds --target=fragment,native product.sk
echo '{"devices": 3' >broken.json
refuses "'broken.json' is not what sk info --json=broken.json writes" --device=broken.json large.sk
for buffers in 0 -1 3 4.5 1e300 9223372036854775808; do
  echo '{"devices": [{"name": "odd", "limits": {"draw_buffers": '$buffers', "texture_units": 16}}]}' >odd.json
  refuses "draw_buffers is ${buffers/300/+300}, but every device has 4 or more" --device=odd.json large.sk
done
{
  printf '{"devices": [{"name": "deep", "limits": '
  head -c 300000 /dev/zero | tr '\0' '['
  head -c 300000 /dev/zero | tr '\0' ']'
  printf '}]}'
} >deep.json
refuses "'deep.json' has no device that draws" --device=deep.json large.sk
echo '{"devices": [{"name": "native"}]}' >native.json
refuses "'native.json' has no device that draws" --device=native.json large.sk

# -D, -W and -Werror.
echo 'kernel void f(float x<>, out float r<>) { if (x > LIMIT) r = x; }' >partial.sk
run 0 -DLIMIT=2 partial.sk
says "warning: output 'r' is not written on every path"
says 'partial.sk:1:'
run 1 -DLIMIT=2 -Werror partial.sk
says "error: output 'r' is not written on every path"

# Command lines that make no sense.
run 1
says 'skc: '
refuses '--nosuch' --nosuch heat.sk
refuses "did you mean '--emit'?" --emti=glsl heat.sk
refuses 'glsll' --emit=glsll heat.sk
refuses 'glsl990' --emit=glsl --profile=glsl990 heat.sk
refuses 'quantum' --target=quantum heat.sk
refuses "unknown target triple 'quantum-unknown'; use one like" --target-triple=quantum-unknown heat.sk
for triple in i686-linux-gnu s390x-linux-gnu; do
  refuses 'use --target=fragment,compute there' --target-triple=$triple heat.sk
done
run 0 -Iinclude -o unneeded --target=fragment,compute --target-triple=quantum-unknown heat.sk   # it compiles no native code
silent
refuses "unknown level 'x86-64-v9' of the CPU; use one of x86-64, x86-64-v3, x86-64-v4" \
  --target-triple=x86_64-linux-gnu --levels=x86-64,x86-64-v9 heat.sk
other=aarch64-linux-gnu
[[ $(uname -m) != aarch64 ]] || other=x86_64-linux-gnu
refuses "level 'native' is this machine's" --target-triple="$other" --levels=native heat.sk
run 0 -Iinclude -o here --levels=native heat.sk
if [[ $(uname -m) == x86_64 ]]; then
  (($(stat -c %s here/heat.sk.o) < $(stat -c %s heat.sk.o))) || broken "--levels=native is no smaller than all levels"
fi
refuses 'leave out --levels' --target-triple=aarch64-linux-gnu --levels=x86-64 heat.sk
for lanes in 3 128; do
  refuses "$lanes lanes are not possible; use a power of 2 from 1 to 64" --lanes=$lanes heat.sk
done
refuses '-O' -O1 heat.sk
refuses '--emit=asm prints native code' --emit=asm --target=fragment heat.sk
run 0 -Iinclude -o compute --target=compute heat.sk
grep -qF '.drawn = false' compute/heat.sk.cpp || broken "--target=compute has fragment programs"
grep -qF '.dispatched = false' fragment/heat.sk.cpp || broken "--target=fragment has compute programs"
refuses 'nosuch' --print-after=nosuch heat.sk
refuses 'nosuch' -Iinclude --emit=glsl --kernel=nosuch heat.sk
mkdir other
cp heat.sk other
refuses "'heat.sk' and 'other/heat.sk' would both be written to heat.sk.hpp" -Iinclude heat.sk other/heat.sk
run 0 -Iinclude --emit=ir heat.sk other/heat.sk   # writes nothing
echo 'in the way' >file
run 1 -Iinclude -o file/below heat.sk
says 'file/below'

# Files that are none.
refuses "'missing.sk' does not exist" missing.sk
refuses "'include' is a directory" include
: >empty.sk
refuses "'empty.sk' is empty" empty.sk
head -c 4096 /dev/urandom >binary.sk
printf '\0' >>binary.sk
refuses "'binary.sk' is not a text file" binary.sk
yes 'kernel void f(float x<>, out float r<>) { r = x; }' | head -c 10485760 >huge.sk || true  # yes ends by SIGPIPE
refuses "'huge.sk' is 10485760 bytes long" huge.sk
echo 'float twice(float x) { return 2 * x; }' >none.sk
refuses "'none.sk' declares no kernel" none.sk
refuses "'weights.sk' file not found" heat.sk

# Mistakes are reported at their place.
printf 'kernel void f(float x<>, out float r<>) {\n  r = x + y;\n}\n' >mistake.sk
refuses "mistake.sk:2:11: error: use of undeclared identifier 'y'" mistake.sk

# Every slip in a declaration: a character left out, or the rest of the file.
slips=0
declaration='reduce void f([[wrap]] Hit h<>, reduce Hit best<> = 0) { best = h; }'
echo 'struct Hit { float t; };' >hit.sk
for ((i = 0; i < ${#declaration}; ++i)); do
  for slip in "${declaration:0:i}" "${declaration:0:i}${declaration:i+1}"; do
    printf '#include "hit.sk"\nkernel void g(float x<>, out float r<>) { r = x; }\n%s\n' "$slip" >slip.sk
    status=0
    timeout 20 "$skc" -o slips slip.sk >out.txt 2>err.txt </dev/null || status=$?
    ((status <= 1)) || { line="skc of: $slip" out='' err=$(<err.txt); broken "status $status"; }
    ((status == 0)) || grep -q '^[a-z]*\.sk:[0-9]*:[0-9]*: error: ' err.txt ||
      { line="skc of: $slip" out='' err=$(<err.txt); broken "no message with a place"; }
    ((++slips))
  done
done
echo "skc's command line holds, with $slips slips in a declaration"

# A crash ends with a short report and status 1, or with the signal, for debuggers. An skc that waits for its file is easy to hit.
mkfifo waits.sk
for expected in 1 139; do
  line='a crash of skc' out='' status=0
  setting=()
  ((expected == 1)) || setting=(SKC_CRASH=signal)
  (ulimit -c 0; exec env "${setting[@]}" "$skc" --emit=ir waits.sk) 2>err.txt &
  until [[ $(readlink "/proc/$!/exe") == "$skc" ]]; do sleep 0.05; done
  sleep 0.5
  kill -SEGV $!
  wait $! 2>/dev/null || status=$?
  err=$(<err.txt)
  ((status == expected)) || broken "status $status, not $expected"
  says 'skc: internal error: segmentation fault'
  says 'skc --emit=ir waits.sk'
  (($(wc -l <err.txt) <= 6)) || broken 'the report is not short'
done

# Constants that need more memory than there is, macros that copy their arguments, and files that include each other without end.
echo 'struct A { float x = 1; }; const A fixed[9000000] = {{2}}; kernel void f(out float r<>) { r = 0; }' >large.sk
(ulimit -v 900000; "$skc" --emit=ir large.sk 2>err.txt) && broken 'no error'
err=$(<err.txt) && says 'skc: this takes more memory than there is'
{
  echo '#define F(x) x x x x x x x x x x x x x x x x x x x x x'
  printf 'kernel void f(out float r<>) { r = %s1%s; }\n' "$(printf 'F(%.0s' {1..40})" "$(printf ')%.0s' {1..40})"
} >explodes.sk
run 1 --emit=ir explodes.sk
says 'macros that use one another expand to more than fits here'
printf '#if __INCLUDE_LEVEL__ < 100\n#include "twice.sk"\n#include "twice.sk"\n#endif\nkernel void f(out float r<>) { r = 0; }\n' >twice.sk
run 1 --emit=ir twice.sk
says 'this is file number 10000 to be included'

# Structs that typedefs name.
cat >pairs.sk <<'EOF'
typedef struct { float a; } A;
typedef struct { float b; } B;
typedef struct Pair_t { float a, b; } Pair;
kernel void part(Pair p<>, out A a<>, out B b<>) { a.a = p.a; b.b = p.b; }
EOF
run 0 --target=fragment pairs.sk
for line in 'struct A {' 'struct B {' 'struct Pair_t {' 'using Pair = Pair_t;'; do
  grep -qF "$line" pairs.sk.hpp || broken "the header lacks '$line'"
done
