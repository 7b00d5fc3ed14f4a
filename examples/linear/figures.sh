#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh SOLVE [DEVICE [STUDY...]]: runs the studies of solve (all, unless some are named) on the device (native) and writes their tables into
# docs/linear.md and README.md. Takes a minute.
set -euo pipefail
(($# > 0)) || { echo "usage: figures.sh SOLVE [DEVICE [STUDY...]]" >&2; exit 1; }
program=$(realpath "$1") device=${2:-native}
shift "$(($# > 1 ? 2 : 1))"
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
(($# > 0)) || set -- precision solvers preconditioners layouts
export OMP_NUM_THREADS=1  # what threads are worth depends on what else runs
exec ../support/figures.sh linear "$program" "$device" README.md,../../docs/linear.md "$@"
