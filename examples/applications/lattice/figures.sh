#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh LATTICE [STUDY...]: runs the studies (all, unless some are named) on the device native and writes their tables
# into README.md of this folder and docs/feedback.md.
# Takes some minutes; leave the machine alone meanwhile, for two of the tables are of times.
set -euo pipefail
(($# > 0)) || { echo "usage: figures.sh LATTICE [STUDY...]" >&2; exit 1; }
program=$(realpath "$1")
shift
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
(($# > 0)) || set -- stability onset cavity conservation growth stopping tables broken
exec ../../support/figures.sh lattice "$program" native README.md,../../../docs/feedback.md "$@"
