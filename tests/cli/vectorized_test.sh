#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# The native loops of simple kernels are vectorised, says GCC itself: those around elements (sk/native/run.hpp) and those around
# what is folded in any order (fold.hpp), in the clone for vectors of 256 bits as in the one for all CPUs. Kernels with loops or
# computed gathers are computed by lanes (sk/native/lanes.hpp): that clone multiplies eight at a time.
# Usage: vectorized_test.sh SKC CXX INCLUDE_FOLDER OPTION...
set -euo pipefail
skc=$(realpath "$1") cxx=$2 include=$(realpath "$3")
shift 3
options=("$@")
source "$(dirname "${BASH_SOURCE[0]}")/frame.sh"

# Where the loops that may be vectorised begin: the lines that follow the mark.
loopsIn() { grep -n -A1 '^ *SK_NATIVE_INDEPENDENT' "$include/sk/native/$1" | sed -n 's/^\([0-9]*\)-.*for (.*/\1/p'; }

# vectorised HEADER KERNEL: a loop of the header is, for this kernel alone.
vectorised() {
  local header=$1 bytes lines
  printf '%s\n' "$2" >kernel.sk
  "$skc" --precision=single -o . kernel.sk
  "$cxx" -std=c++20 "${options[@]}" -I"$include" -I. -fopt-info-vec -c kernel.sk.cpp -o kernel.o 2>report.txt
  lines=$(loopsIn "$header" | paste -sd'|')
  [[ -n $lines ]] || { echo "broken: no loops found in $header"; exit 1; }
  for bytes in 16 32; do
    grep -qE "$header:($lines):[0-9]+: optimized: loop vectorized using $bytes byte vectors" report.txt || {
      echo "broken: no loop of $header is vectorised with $bytes bytes for: $2"
      cat report.txt
      exit 1
    }
  done
}

vectorised run.hpp 'kernel void saxpy(float a, float x<>, float y<>, out float r<>) { r = a * x + y; }'
for boundary in clamp wrap mirror 'border(0.0f)'; do
  vectorised run.hpp "kernel void diffuse(float k, [[$boundary]] float u[][], out float v<>) {
    float c = neighbor(u, 0, 0);
    v = c + k * (neighbor(u, 1, 0) + neighbor(u, -1, 0) + neighbor(u, 0, 1) + neighbor(u, 0, -1) - 4 * c);
  }"
done
vectorised run.hpp 'struct Pair { float a; int b; };
kernel void pairs(Pair p<>, out Pair q<>) { q.a = max(p.a, 0.0f); q.b = p.b + indexof(p).x; }'
vectorised fold.hpp '[[accumulate(tree)]] reduce void sum(float x<>, reduce float total<> = 0) { total += x; }'
vectorised fold.hpp 'reduce void dots(float x<>, float y<>, reduce float total<>) { total += x * y; }'
vectorised fold.hpp 'reduce void most(float x<>, reduce float m<>) { m = max(m, x); }'

# byLanes KERNEL: it multiplies vectors of 256 bits, which no loop around its elements does.
byLanes() {
  printf '%s\n' "$1" >kernel.sk
  "$skc" --precision=single -o . kernel.sk
  "$cxx" -std=c++20 "${options[@]}" -I"$include" -I. -S kernel.sk.cpp -o kernel.s
  grep -qE 'vmulps[[:space:]].*%ymm' kernel.s || { echo "broken: not computed by lanes: $1"; exit 1; }
}

byLanes 'kernel void escape(float2 c<>, int most, out int steps<>) {
  float2 z = 0;
  steps = 0;
  while (steps < most && dot(z, z) <= 4) {
    z = float2(z.x * z.x - z.y * z.y, 2 * z.x * z.y) + c;
    ++steps;
  }
}'
byLanes 'kernel void multiply(float a[][], float b[][], out float c<>) {
  int2 p = indexof(c).xy;
  c = 0;
  for (int k = 0; k < extentof(a).x; ++k) c += a[p.y][k] * b[k][p.x];
}'
byLanes 'kernel void leap(int by, [[wrap]] float a[], out float r<>) {
  int i = indexof(r).x;
  r = (i & by) != 0 ? a[i ^ by] * a[i] : 0;
}'
