#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# An exception on one rank ends all ranks, says which rank it was, and leaves the last file that was saved whole.
# Usage: faults_test.sh PROGRAM MPIRUN [OPTION...]
set -euo pipefail
program=$(realpath "$1")
shift
mpirun=("$@")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"

# ends STATUS WAY TEXT: a run on three ranks.
ends() {
  local status=0
  timeout 60 "${mpirun[@]}" -n 3 "$program" "$2" state.npy >out.txt 2>err.txt || status=$?
  if [[ $status != "$1" || $(<err.txt) != *"$3"* ]]; then
    printf 'broken: %s ended with status %s, not %s, or did not say: %s\n' "$2" "$status" "$1" "$3"
    cat out.txt err.txt
    exit 1
  fi
}
# whole: the file has a header and all elements.
whole() {
  [[ $(stat -c %s state.npy) == $((128 + 24 * 8 * 4)) && $(head -c 6 state.npy | tail -c 5) == NUMPY ]] || { echo "broken: no whole file"; exit 1; }
  [[ ! -e state.npy.partial ]] || { echo "broken: a part is left"; exit 1; }
}

host=$(uname -n)
ends 0 works ''
whole
rm state.npy
ends 1 throws "rank 2 of 3 on $host: step 10 went wrong"
whole
rm state.npy
ends 1 loses "rank 2 of 3 on $host: the device was lost"
whole
ends 1 leaves "rank 2 of 3 on $host: an exception that is no std::exception"
ends 3 fails ''
# MPI itself fails on one rank, so that it cannot tell the others.
ends 1 breaks "rank 2 of 3 on $host: the ranks of a sk::Domain cannot be compared any more: MPI has failed"
# A rank takes another branch.
ends 1 parts 'the ranks do not make the same call: rank 0 has diffuse as its call '
SK_CHECK=collectives ends 1 parts 'the ranks do not make the same call: rank 0 has diffuse, rank 2 has age;'
# A rank comes late.
SK_MPI_TIMEOUT=0.5 ends 0 sleeps 'sk: rank 0 of 3 has waited 0.5 s for other ranks in diffuse (call '
[[ -z $(sort err.txt | uniq -d) ]] || { echo 'broken: a wait is told more than once'; cat err.txt; exit 1; }
SK_MPI_TIMEOUT=long ends 1 works "SK_MPI_TIMEOUT is 'long'; give a number of seconds above 0"
SK_CHECK=nothing ends 1 works "there is no check 'nothing'"
# A launcher of another MPI starts each process as a world of its own.
if PMI_SIZE=3 timeout 60 "$program" works state.npy 2>err.txt; then
  echo 'broken: another launcher is not noticed'
  exit 1
fi
grep -qF 'built with another MPI' err.txt || { cat err.txt; exit 1; }
