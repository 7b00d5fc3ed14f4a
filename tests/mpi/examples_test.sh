#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Examples under mpirun: one process prints and writes files, all of them refuse what they cannot do with one message, and an error of
# one process ends all.
# Usage: examples_test.sh BINARIES EXAMPLES MPIRUN [OPTION...]
set -euo pipefail
binaries=$(realpath "$1")
scenes=$(realpath "$2/lattice/scenes")
cloths=$(realpath "$2/cloth/scenes")
rays=$(realpath "$2/rays/scenes")
shift 2
mpirun=("$@")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"

broken() {
  printf 'broken: %s\n' "$1"
  cat out.txt err.txt
  exit 1
}
# on RANKS STATUS PROGRAM ARGUMENT...: the program ends with status 0 or another one.
on() {
  local ranks=$1 wanted=$2 status=0
  shift 2
  timeout 60 "${mpirun[@]}" -n "$ranks" "$binaries/$1" "${@:2}" >out.txt 2>err.txt || status=$?
  [[ $((status != 0)) == "$wanted" && $status != 124 ]] || broken "$*: status $status on $ranks ranks"
}
# says COUNT TEXT: so many lines of standard error contain a text.
says() {
  [[ $(grep -cF "$2" err.txt) == "$1" ]] || broken "not $1 lines say: $2"
}

spots=(lattice "$scenes/spots.toml" --size 40x30 --steps 20 --no-account)
"$binaries/${spots[0]}" "${spots[@]:1}" --output one.png --csv one.csv >out.txt 2>err.txt
on 3 0 "${spots[@]}" --output three.png --csv three.csv
[[ $(grep -c '^lattice: spots, 40 x 30, 20 steps on 3 ranks, each on ' out.txt) == 1 ]] || broken 'not one report'
[[ $(grep -c '^verified .*: ok$' out.txt) == 1 ]] || broken 'not one verification'
cmp one.png three.png
cmp one.csv three.csv
on 2 1 "${spots[@]}" --window
says 1 'lattice: --window needs one process, but there are 2; start it without mpirun, or make a film with --output'
on 6 1 lattice "$scenes/spots.toml" --size 2x2 --steps 1
says 1 'cannot be divided over 6 ranks so that each has an element'
on 2 1 "${spots[@]}" --output /dev/null/film.apng
says 1 '/dev/null/film.apng'
torn=(cloth "$cloths/torn.toml" --points 15 17 --steps 20 --frames 3)
"$binaries/${torn[0]}" "${torn[@]:1}" --no-compare --csv one.csv --obj one.obj >out.txt 2>err.txt
on 3 0 "${torn[@]}" --csv three.csv --obj three.obj
[[ $(grep -c '^cloth: .* on 3 ranks, each on ' out.txt) == 1 ]] || broken 'not one report'
[[ $(grep -c '^verified .*: ok$' out.txt) == 2 ]] || broken 'not two verifications'
cmp one.csv three.csv
cmp one.obj three.obj
on 6 1 cloth "$cloths/torn.toml" --points 3 3 --steps 2
says 1 "'p' needs a halo of 2 element(s)"
cornell=(rays "$rays/cornell.toml" --size 20x15 --samples 2)
"$binaries/${cornell[0]}" "${cornell[@]:1}" --output one.pfm --layers one >out.txt 2>err.txt
on 3 0 "${cornell[@]}" --output three.pfm --layers three
[[ $(grep -c '^rays: cornell, 20 x 15, 2 samples on 3 ranks, each on ' out.txt) == 1 ]] || broken 'not one report'
for layer in '' _variance _samples _depth; do cmp "one$layer.pfm" "three$layer.pfm"; done
on 2 1 "${cornell[@]}" --error 0.1
says 1 "rays: 'error' needs one process, but there are 2; give --error 0"
on 2 1 saxpy
says 2 'saxpy: 2 processes were started, but each would compute everything: it computes in one process; start it without mpirun'
