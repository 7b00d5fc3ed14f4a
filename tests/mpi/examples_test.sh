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
waters=$(realpath "$2/waves/scenes")
flows=$(realpath "$2/fluid/scenes")
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
says 1 "'net.p' needs a halo of 2 element(s)"
cornell=(rays "$rays/cornell.toml" --size 20x15 --samples 2)
"$binaries/${cornell[0]}" "${cornell[@]:1}" --output one.pfm --layers one >out.txt 2>err.txt
on 3 0 "${cornell[@]}" --output three.pfm --layers three
[[ $(grep -c '^rays: cornell, 20 x 15, 2 samples on 3 ranks, each on ' out.txt) == 1 ]] || broken 'not one report'
for layer in '' _variance _samples _depth; do cmp "one$layer.pfm" "three$layer.pfm"; done
on 2 1 "${cornell[@]}" --error 0.1
says 1 "rays: 'error' needs one process, but there are 2; give --error 0"
# same RANKS PROGRAM ARGUMENT...: as many ranks write the numbers and the picture that one process writes.
same() {
  local ranks=$1
  shift
  "$binaries/$1" "${@:2}" --output one.png --csv one.csv >out.txt 2>err.txt
  on "$ranks" 0 "$@" --output several.png --csv several.csv
  [[ $(grep -c "^$1: .* on $ranks ranks, each on " out.txt) == 1 ]] || broken 'not one report'
  cmp one.csv several.csv
  cmp one.png several.png
}
same 3 waves "$waters/drops.toml" --size 36x28 --steps 6 --pixels 64x40
same 6 waves "$waters/basin.toml" --size 29x31 --steps 3 --pixels 64x40
same 4 fluid "$flows/plume.toml" --size 48x64 --steps 3 --projection multigrid
same 6 fluid "$flows/cylinder.toml" --size 60x33 --steps 2 --projection multigrid
same 2 fluid "$flows/lid.toml" --size 33x33 --steps 2 --projection chebyshev
same 3 fluid "$flows/smoke_3d.toml" --size 13x24x14 --steps 2 --projection multigrid
on 2 1 fluid "$flows/plume.toml" --size 24x32 --steps 2 --study time
says 1 'fluid: --study needs one process, but there are 2; start it without mpirun'
poisson=(solve poisson:63x41 --preconditioner multigrid --accumulate exact)
"$binaries/${poisson[0]}" "${poisson[@]:1}" --solution one.mtx >out.txt 2>err.txt
on 4 0 "${poisson[@]}" --solution four.mtx
[[ $(grep -c '^verified .*: ok$' out.txt) == 1 ]] || broken 'not one verification'
cmp one.mtx four.mtx
printf '%%%%MatrixMarket matrix coordinate real general\n2 2 2\n1 1 1\n2 2 1\n' >two.mtx
on 2 1 solve two.mtx
says 1 'solve: a matrix of a file needs one process, but there are 2; its rows read any element of a vector; start it without mpirun'
on 2 1 solve poisson:20x20 --preconditioner ic0
says 1 "solve: the preconditioner 'ic0' needs one process, but there are 2; it takes rows one after the other; take multigrid"
on 2 1 smooth
says 2 'smooth: 2 processes were started, but each would compute everything: it computes in one process; start it without mpirun'
on 2 1 saxpy
says 2 'saxpy: 2 processes were started, but each would compute everything: it computes in one process; start it without mpirun'
