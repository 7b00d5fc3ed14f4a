#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh RAYS [DEVICE [STUDY...]]: runs the studies (all but embree, which needs cmake -DSK_EMBREE=ON, and alike, which takes ten minutes, unless some are
# named) on the device (native) and writes their tables into docs/rays.md. Takes some minutes; tables of speeds count the time of the processor, not what
# passes, but for GPUs.
set -euo pipefail
(($# > 0)) || { echo "usage: figures.sh RAYS [DEVICE [STUDY...]]" >&2; exit 1; }
program=$(realpath "$1") device=${2:-native}
shift "$(($# > 1 ? 2 : 1))"
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
(($# > 0)) || set -- leaks needles light metals convergence precision sums speed wavefront streaming stopping ray_engine engines
export OMP_NUM_THREADS=1  # rates are those of one core
exec ../../support/figures.sh rays "$program" "$device" README.md,../../../docs/rays.md "$@"
