#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# listed_programs_test.sh PYTHON SOURCE: tests of ./dev test find what packages.txt brings, and nothing else that is installed.
set -euo pipefail
python=$1 source=$2
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

# listed PACKAGE...: the programs that a packages.txt with these packages in [build], and chromium in [web], brings.
listed() {
  printf '%s\n' '[build]' "$@" '[web]' chromium >"$place/packages.txt"
  local status=0
  "$python" "$source/tests/cli/listed_programs.py" "$place" "$place/programs" >"$place/why" || status=$?
  ((status != 77)) || { echo "skipped: $(cat "$place/why")"; exit 77; }
  ((status == 0)) || broken "it fails: $(cat "$place/why")"
}
broken() { echo "broken: $1"; exit 1; }
has() { [[ -x $place/programs/$1 ]] || broken "$1 is missing"; }
has_not() { [[ ! -e $place/programs/$1 ]] || broken "$1 should be missing"; }

listed g++ glslang-tools
for program in g++ c++ awk sh glslangValidator; do has build/$program; done   # two of them are alternatives
for program in gdb cmake chromium; do has_not build/$program; done
has_not web/g++
[[ $(PATH=$place/programs/build sh -c 'command -v gdb || echo none') == none ]] || broken "the PATH has gdb"
listed g++ gdb
has build/gdb
has_not build/glslangValidator
echo "a PATH of what packages.txt brings"
