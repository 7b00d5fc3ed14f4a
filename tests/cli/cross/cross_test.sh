#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Object code for AArch64 computes the same bits as that for x86-64, optimised or not: harness.cpp is linked with each of
# them and run, for AArch64 by qemu.
# Usage: cross_test.sh SKC CXX RUNTIME_INCLUDES
set -euo pipefail
skc=$(realpath "$1") cxx=$2 includes=$(realpath "$3")
folder=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
for tool in aarch64-linux-gnu-g++ qemu-aarch64; do
  command -v $tool >/dev/null || { echo "skipped: there is no $tool"; exit 77; }
done
[[ $(uname -m) == x86_64 ]] || { echo "skipped: this is no x86-64"; exit 77; }
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"

# compile NAME TRIPLE [OPTION...]: NAME/kernels.sk.o
compile() { "$skc" --target=native --quad -o "$1" --target-triple="$2" "${@:3}" "$folder/kernels.sk"; }
# link NAME CXX [OPTION...]: NAME/program, of the harness and NAME's object
link() {
  local prefix
  prefix=$(grep -oE 'sk_[0-9a-f]{16}_' "$1/kernels.sk.cpp" | head -1)
  "$2" -std=c++20 -O1 -I"$includes" "-DSK_CODE(name)=$prefix##name" "$folder/harness.cpp" "$1/kernels.sk.o" -o "$1/program" "${@:3}"
}

compile here x86_64-linux-gnu
link here "$cxx" -lquadmath
here/program >here.txt
compile unoptimised x86_64-linux-gnu -g -O0
link unoptimised "$cxx" -lquadmath
unoptimised/program >unoptimised.txt
compile there aarch64-linux-gnu
link there aarch64-linux-gnu-g++ -static
qemu-aarch64 there/program >there.txt
compile slow aarch64-linux-gnu -g -O0 --lanes=16
link slow aarch64-linux-gnu-g++ -static
qemu-aarch64 slow/program >slow.txt
(($(wc -l <here.txt) >= 16)) || { echo "broken: the harness prints too little"; exit 1; }
for results in unoptimised there slow; do
  cmp here.txt $results.txt && continue
  echo "broken: the results of $results are not those of optimised code for x86-64:"
  diff here.txt $results.txt | cut -c1-200
  exit 1
done
echo "AArch64 has the bits of x86-64"
