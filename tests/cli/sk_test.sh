#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# sk's command line, what `sk info` tells of native code and of the device with GL, and what it keeps. The facts of
# llvmpipe are known (docs/accuracy.md); of other devices, only that there are answers.
# Usage: sk_test.sh SK
set -euo pipefail
sk=$(realpath "$1")
accuracy=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../docs/accuracy.md")
tested=("$sk")
source "$(dirname "${BASH_SOURCE[0]}")/frame.sh"
unset SK_DEVICE SK_PROFILE
export SK_CACHE=$place/cache

# arithmetic: of a table, what no other load of the machine changes.
arithmetic() { sed '/^  bandwidth/,$d'; }
measures() { [[ $err == *measuring* ]] || broken "nothing is measured"; }
remembers() { [[ -z $err ]] || broken "standard error is not empty"; }

# Help, version, and command lines that make no sense.
run 0 --help
prints 'info'
run 0 info --help
for option in --device --profile --json --refresh SK_CACHE; do prints "$option"; done
run 0 --version
[[ $out =~ ^sk\ [0-9]+\.[0-9]+\.[0-9]+$ ]] || broken "no version"
run 1
run 1 inform
says 'inform'
says "did you mean 'info'?"
run 1 frob
says "there is no command 'frob'"
run 1 inof
says "there is no command 'inof'; did you mean 'info'?"
run 1 info --jsno
says "did you mean '--json'?"
run 1 info --nosuch
says '--nosuch'
run 1 info --device abacus
says "sk: no device 'abacus' was found"
run 1 info --device software --profile glsl110
says "there is no profile 'glsl110'"

# Native code: IEEE 754, and no questions about textures.
run 0 info --device native
measures
matches '^native$'
matches '^  processor '
for operation in '\+' '-' '\*' '/' 'sqrt'; do matches "^    $operation +\[-0\.5, 0\.5\] .* correctly rounded$"; done
matches '^  contraction +a \* b \+ c is rounded twice$'
matches '^    exp +\[-87, 88\] +0\.5'
matches '^  special values +([0-9]+) of \1 as in IEEE 754$'
matches '^  doubles +native; right bits of \+ 53, '
[[ $out != *'half stores'* ]] || broken "native code has no textures"
first=$out

# What is kept is told again, and is not measured; --refresh, rubbish and no place to keep it measure again.
run 0 info --device native
remembers
[[ $out == "$first" ]] || broken "what is kept differs from what was measured"
file=$(echo cache/info-*)
for rubbish in "$(head -c 500 "$file")" "$(head -n 1 "$file")"$'\n{"schema": 1}'; do
  printf '%s' "$rubbish" >"$file"
  run 0 info --device native
  measures
  run 0 info --device native
  remembers
done
run 0 info --device native --refresh
measures
[[ $(arithmetic <<<"$out") == "$(arithmetic <<<"$first")" ]] || broken "another arithmetic than the first time"
SK_CACHE=/proc/no/such/folder run 0 info --device native
measures

# JSON on standard output and in a file.
run 0 info --device native --json
remembers
for key in devices schema streamkernel name profile processor threads simd operations min_signed max_signed \
  correctly_rounded contraction functions range max mean worst_at special_values ieee_754 indices doubles costs \
  gigabytes_per_second call_us pass_us measured_in_seconds; do
  prints "\"$key\":"
done
json=$out
run 0 info --device native --json native.json
[[ $out == "$first"* || $out == native* ]] || broken "no table beside the file"
[[ $(<native.json) == "$json" ]] || broken "another JSON in the file"
run 1 info --device native --json no/such/folder.json
says "cannot write 'no/such/folder.json'"

# Without GL: it says so, and tells of native code.
__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent run 0 info
if [[ $out == 'no OpenGL: '* ]]; then
  matches '^native$'
  matches '^no GPU: '
  __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent run 0 info --json
  prints '"no_gl": "no device was found'
  prints '"no_gpu": "'
fi

# With GL: both devices, the better one first, what is known of llvmpipe, and nothing of what this process wishes of it.
SK_BARRIER=none SK_DOUBLES=pairs SK_LIMITS=guaranteed run 0 info
measures
run 0 info
remembers
matches '^native$'
matches '^  driver '
matches '^  gives +textures [0-9]+ texels wide or high'
if grep -q '^llvmpipe' out.txt; then
  [[ $out == native* ]] || broken "native code is no better than a software renderer"
  matches '^no GPU: '
  for operation in '\+' '-' '\*' '/' 'sqrt'; do matches "^    $operation +\[-0\.5, 0\.5\] .* correctly rounded$"; done
  matches 'a \* b \+ c is rounded twice$'
  matches 'fma of GLSL is rounded twice$'
  matches '^ +none +9[0-9]\.?[0-9]* % of the sums'
  matches '^ +xor +0 % of the sums, 0 % of the products$'
  matches '^ +precise +0 % of the sums, 0 % of the products   taken$'
  matches 'd \+ 0 +is 0, not 7\.347e-40$'
  matches 'd == 0 +is 1, not 0$'
  [[ $out != *'d copied'* ]] || broken "a copy loses denormals"
  matches '^  half stores +toward zero; 65520 becomes 65504'
  matches '^  filter +16 bits of weight or more'
  matches '^  doubles +native; right bits of \+ 53, '
fi

# What the documentation shows of one device: the block that begins with its name, but for what is left out.
shown=$(sed -n '/^<!-- sk info -->/,/^```$/p' "$accuracy" | sed '1,2d;$d')
if grep -qxF -- "${shown%%$'\n'*}" out.txt; then
  while IFS= read -r text; do
    [[ $text == '  ...' ]] || grep -qxF -- "$text" out.txt || broken "docs/accuracy.md shows what it does not print: $text"
  done <<<"$shown"
fi
run 0 info --json
for key in driver shading_language software limits texture_side texture_layers draw_buffers allocates texture_bytes \
  exact_sums wrong_sums wrong_products taken half_stores rounding filter weight_bits compile_ms \
  pass_and_readback_us; do
  prints "\"$key\":"
done
echo "sk tells what it should"
