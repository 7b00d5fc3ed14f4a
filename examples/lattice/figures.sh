#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh LATTICE [STUDY...]: runs the studies (all, unless some are named) on the device native and writes their tables
# into README.md of this folder and docs/feedback.md, between the marks <!-- lattice study NAME --> and <!-- /lattice -->.
# Takes some minutes; leave the machine alone meanwhile, for two of the tables are of times.
set -euo pipefail
(($# > 0)) || { echo "usage: figures.sh LATTICE [STUDY...]" >&2; exit 1; }
program=$(realpath "$1")
shift
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
(($# > 0)) || set -- stability onset cavity conservation growth stopping tables broken
for study in "$@"; do
  if ! output=$("$program" --study "$study" --device native); then
    printf '%s\nfigures.sh: the study %s missed its bound\n' "$output" "$study" >&2
    exit 1
  fi
  table=$(grep '^|' <<<"$output")
  for file in README.md ../../docs/feedback.md; do
    TABLE=$table awk -v mark="<!-- lattice study $study -->" '
      $0 == "<!-- /lattice -->" { inside = 0 }
      !inside { print }
      $0 == mark { print ENVIRON["TABLE"]; inside = 1 }' "$file" >"$file.new"
    mv "$file.new" "$file"
  done
done
