#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# pack.sh BUILD_DIR FOLDER: what runs of the benchmarks on another machine, without a build folder: sk_race, peers that
# need nothing installed there, and the libraries of Debian that it may not have. Some MB.
set -euo pipefail
build=${1:?usage: pack.sh BUILD_DIR FOLDER}/tests/bench/race
folder=${2:?usage: pack.sh BUILD_DIR FOLDER}
mkdir -p "$folder"
files=("$build/sk_race" "$build/peer_openmp.so")
[[ ! -e $build/peer_fftw.so ]] || files+=("$build/peer_fftw.so")
cp "${files[@]}" "$folder"
# Every machine has these of its own, to fit its kernel and its driver.
ldd "${files[@]}" | awk '$2 == "=>" { print $3 }' | sort -u |
  grep -Ev '/(libc|libm|libdl|libpthread|librt|libstdc\+\+|libgcc_s|libgomp)\.so' |
  xargs -r cp -L -t "$folder"
strip "$folder"/*
du -sh "$folder"
