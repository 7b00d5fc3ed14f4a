#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Native code computes several elements side by side, whatever a kernel is made of: its assembly for x86-64-v3 has
# arithmetic on vectors of 256 bits, that for x86-64-v4 on vectors of 512 or 256.
# Usage: vectorized_test.sh SKC
set -euo pipefail
skc=$(realpath "$1")
source "$(dirname "${BASH_SOURCE[0]}")/frame.sh"

# vectorised PATTERN KERNEL: both levels have such an instruction on whole vectors.
vectorised() {
  local instruction=$1 level registers
  printf '%s\n' "$2" >kernel.sk
  while read -r level registers; do
    "$skc" --emit=asm --target-triple=x86_64-linux-gnu --levels="$level" kernel.sk >kernel.s
    grep -qE "^[[:space:]]$instruction[[:space:]].*%[$registers]mm" kernel.s ||
      { echo "broken: no $instruction on vectors in the code for $level of: $2"; exit 1; }
  done <<<$'x86-64-v3 y\nx86-64-v4 yz'
}

vectorised vmulps 'kernel void saxpy(float a, float x<>, float y<>, out float r<>) { r = a * x + y; }'
for boundary in clamp wrap mirror 'border(0.0f)'; do
  vectorised vmulps "kernel void diffuse(float k, [[$boundary]] float u[][], out float v<>) {
    float c = neighbor(u, 0, 0);
    v = c + k * (neighbor(u, 1, 0) + neighbor(u, -1, 0) + neighbor(u, 0, 1) + neighbor(u, 0, -1) - 4 * c);
  }"
done
vectorised vpaddd 'struct Pair { float a; int b; };
kernel void pairs(Pair p<>, out Pair q<>) { q.a = max(p.a, 0.0f); q.b = p.b + indexof(p).x; }'
vectorised vaddps '[[accumulate(tree)]] reduce void sum(float x<>, reduce float total<> = 0) { total += x; }'
vectorised vmulps 'reduce void dots(float x<>, float y<>, reduce float total<>) { total += x * y; }'
vectorised 'v(max|blendv|blendm)ps' 'reduce void most(float x<>, reduce float m<>) { m = max(m, x); }'

# Loops whose trip counts differ, and gathers at computed indices.
vectorised vmulps 'kernel void escape(float2 c<>, int most, out int steps<>) {
  float2 z = 0;
  steps = 0;
  while (steps < most && dot(z, z) <= 4) {
    z = float2(z.x * z.x - z.y * z.y, 2 * z.x * z.y) + c;
    ++steps;
  }
}'
# The squares that an iteration ends with are those that the next one begins with.
products=$("$skc" --emit=llvm --target-triple=x86_64-linux-gnu --levels=x86-64-v3 kernel.sk |
  sed -n '/^define .*_escape\.run\.v3(/,/^}/p' | grep -c '= fmul <')
((products == 4)) || { echo "broken: $products products in an iteration that needs 4"; exit 1; }
# Without registers for masks, those of loops stay the words that comparisons give.
"$skc" --emit=asm --target-triple=x86_64-linux-gnu --levels=x86-64-v3 kernel.sk >kernel.s
! sed -n '/_escape\.run\.v3:/,/retq/p' kernel.s | grep -q vpackss || { echo "broken: masks of a loop are packed to bytes"; exit 1; }
# With them, each vector has a mask of its own, and lanes need not be counted one by one: no mask is packed or taken apart.
"$skc" --emit=asm --target-triple=x86_64-linux-gnu --levels=x86-64-v4 kernel.sk |
  sed -n '/_escape\.run\.v4:/,/retq/p' >escape.s
! grep -qE 'kunpck|kshift|vpmovm2' escape.s || { echo "broken: masks of a loop are packed or taken apart"; exit 1; }
# The number of steps is the same in all lanes that are left: integers are compared before the loop alone.
compared=$(grep -c 'vpcmp' escape.s)
((compared == 2)) || { echo "broken: $compared comparisons of integers, where 2 find the lanes that have elements"; exit 1; }
# Where few variables differ between lanes, four vectors hide how long each operation takes.
printf '%s\n' 'kernel void grow(float x<>, int most, out int steps<>) {
  float y = x;
  steps = 0;
  while (steps < most && y < 100) { y = y * y + 1; ++steps; }
}' >kernel.sk
products=$("$skc" --emit=asm --target-triple=x86_64-linux-gnu --levels=x86-64-v4 kernel.sk |
  sed -n '/_grow\.run\.v4:/,/retq/p' | grep -c vmulps)
((products == 4)) || { echo "broken: $products vectors in a loop that 4 hide the latency of"; exit 1; }
vectorised vmulps 'kernel void multiply(float a[][], float b[][], out float c<>) {
  int2 p = indexof(c).xy;
  c = 0;
  for (int k = 0; k < extentof(a).x; ++k) c += a[p.y][k] * b[k][p.x];
}'
# All sums of its rows stay in registers: the block of products touches no vector on the stack.
for level in x86-64-v3 x86-64-v4; do
  "$skc" --emit=asm --target-triple=x86_64-linux-gnu --levels="$level" kernel.sk |
    sed -n "/_multiply\.rows\.v${level: -1}\.contracted:/,/retq/p" |
    awk '/^\.LBB/ { spills = 0; products = 0 } /[xyz]mm/ && /rsp/ { ++spills } /vfmadd/ { ++products }
         /^\tj/ && products > 4 && !found { print spills; found = 1 }' >spills
  [[ $(<spills) == 0 ]] || { echo "broken: sums of a product of matrices are spilled on $level"; exit 1; }
done
# Its indices are tested before the loop: an iteration is one block that jumps back to itself, and its addresses are in registers.
for level in x86-64-v3 x86-64-v4; do
  "$skc" --emit=asm --target-triple=x86_64-linux-gnu --levels="$level" kernel.sk |
    sed -n "/_multiply\.rows\.v${level: -1}\.contracted:/,/retq/p" |
    awk '/^\.LBB/ { label = substr($1, 1, length($1) - 1); products = loads = 0 } /vfmadd/ { ++products } /rsp/ { ++loads }
         /^\tj/ && products > 4 && $2 == label { print loads }' >loads
  [[ -s loads ]] || { echo "broken: a product of matrices tests indices in its loop on $level"; exit 1; }
  (($(<loads) < 3)) || { echo "broken: addresses in a product of matrices are spilled on $level"; exit 1; }
done
# The vectors that all rows share are those of b, whose bit says so (Code::sharedGathers).
"$skc" --emit=llvm --target-triple=x86_64-linux-gnu --levels=x86-64-v3 kernel.sk >kernel.ll
grep -q '_multiply = hidden constant .*, i64 2 }' kernel.ll ||
  { echo "broken: the code does not say that rows of a product of matrices share b"; exit 1; }
vectorised vmulps 'kernel void leap(int by, [[wrap]] float a[], out float r<>) {
  int i = indexof(r).x;
  r = (i & by) != 0 ? a[i ^ by] * a[i] : 0;
}'
