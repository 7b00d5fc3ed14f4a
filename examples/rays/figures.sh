#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh RAYS [STUDY...]: runs the studies (all but embree, which needs cmake -DSK_EMBREE=ON, and alike, which takes ten minutes, unless some are named)
# on the device native and writes their tables into docs/rays.md, between the marks <!-- rays study NAME --> and <!-- /rays -->.
# Takes some minutes; tables of speeds count the time of the processor, not what passes.
set -euo pipefail
(($# > 0)) || { echo "usage: figures.sh RAYS [STUDY...]" >&2; exit 1; }
program=$(realpath "$1")
shift
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
(($# > 0)) || set -- leaks light convergence precision sums speed streaming ray_engine
export OMP_NUM_THREADS=1  # rates are those of one core
for study in "$@"; do
  if ! output=$("$program" --study "$study" --device native); then
    printf '%s\nfigures.sh: the study %s missed its bound\n' "$output" "$study" >&2
    exit 1
  fi
  # Tables, with an empty line between two of them.
  table=$(awk '/^\|/ { if (begun && !inside) print ""; print; begun = 1 } { inside = /^\|/ }' <<<"$output")
  for file in README.md ../../docs/rays.md; do
    TABLE=$table awk -v mark="<!-- rays study $study -->" '
      $0 == "<!-- /rays -->" { inside = 0 }
      !inside { print }
      $0 == mark { print ENVIRON["TABLE"]; inside = 1 }' "$file" >"$file.new"
    mv "$file.new" "$file"
  done
done
