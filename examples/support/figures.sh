#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh NAME PROGRAM DEVICE FILE STUDY...: runs `PROGRAM --study STUDY --device DEVICE` for each study and writes its tables into the files, a list
# with commas, between the marks <!-- NAME study STUDY --> and <!-- /NAME -->. A device other than native has marks of its own:
# <!-- NAME study STUDY on DEVICE -->. A study that misses its bound ends it.
set -euo pipefail
(($# > 4)) || { echo "usage: figures.sh NAME PROGRAM DEVICE FILE,... STUDY..." >&2; exit 1; }
name=$1 program=$2 device=$3
IFS=, read -r -a files <<<"$4"
shift 4
for study in "$@"; do
  mark="<!-- $name study $study -->"
  [[ $device == native ]] || mark="<!-- $name study $study on $device -->"
  if ! output=$("$program" --study "$study" --device "$device"); then
    printf '%s\nfigures.sh: the study %s missed its bound\n' "$output" "$study" >&2
    exit 1
  fi
  # Tables, with an empty line between two of them.
  table=$(awk '/^\|/ { if (begun && !inside) print ""; print; begun = 1 } { inside = /^\|/ }' <<<"$output")
  for file in "${files[@]}"; do
    TABLE=$table awk -v mark="$mark" -v end="<!-- /$name -->" '
      $0 == end { inside = 0 }
      !inside { print }
      $0 == mark { print ENVIRON["TABLE"]; inside = 1 }' "$file" >"$file.new"
    mv "$file.new" "$file"
  done
done
