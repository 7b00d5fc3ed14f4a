#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh PROGRAM [DEVICE [STUDY...]]: runs the studies of solve, fluid, waves or smooth (all, unless some are named) on the device (native) and writes their
# tables into docs/linear.md, and those of solve into README.md, too. Those of fluid take two minutes, the others one; leave the machine alone meanwhile, for some tables are of times.
set -euo pipefail
usage() { echo "usage: figures.sh PROGRAM [DEVICE [STUDY...]], with the program solve, fluid, waves or smooth" >&2; exit 1; }
(($# > 0)) || usage
program=$(realpath "$1") device=${2:-native} files=../../../docs/linear.md
shift "$(($# > 1 ? 2 : 1))"
name=$(basename "$program")
case $name in
  solve) name=linear all=(precision solvers preconditioners aggregation multigrid full jumps orders layouts) files=README.md,$files ;;
  fluid) all=(taylor_green time energy cavity poiseuille cost) ;;
  waves) all=(dispersion energy) ;;
  smooth) all=(sphere layouts) ;;
  *) usage ;;
esac
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
(($# > 0)) || set -- "${all[@]}"
export OMP_NUM_THREADS=1  # what threads are worth depends on what else runs
exec ../../support/figures.sh "$name" "$program" "$device" "$files" "$@"
