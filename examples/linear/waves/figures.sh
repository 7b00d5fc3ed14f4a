#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh WAVES [STUDY...]: runs the studies (all, unless some are named) on the device native and writes their tables into docs/linear.md. Takes a minute.
set -euo pipefail
(($# > 0)) || { echo "usage: figures.sh WAVES [STUDY...]" >&2; exit 1; }
program=$(realpath "$1")
shift
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
(($# > 0)) || set -- dispersion energy
exec ../../support/figures.sh waves "$program" native ../../../docs/linear.md "$@"
