#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh FLUID [STUDY...]: runs the studies (all, unless some are named) on the device native and writes their tables into docs/linear.md. Takes two
# minutes; leave the machine alone meanwhile, for one of the tables is of times.
set -euo pipefail
(($# > 0)) || { echo "usage: figures.sh FLUID [STUDY...]" >&2; exit 1; }
program=$(realpath "$1")
shift
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
(($# > 0)) || set -- taylor_green time energy cavity poiseuille cost
exec ../../support/figures.sh fluid "$program" native ../../../docs/linear.md "$@"
