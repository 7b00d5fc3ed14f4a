#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# figures.sh FOLDER DEVICE [NAME...]: runs the classics (all, unless some are named), whose programs are in FOLDER, and writes what they print into their
# READMEs, between the marks <!-- DEVICE --> and <!-- /DEVICE -->, and their pictures into docs/images/classics. DEVICE is native, llvmpipe or gpu. With the
# variable RUN_FROM=FOLDER, nothing runs: FOLDER/NAME.txt has what the program printed on another machine.
set -euo pipefail
(($# > 1)) || { echo "usage: figures.sh FOLDER DEVICE [NAME...]" >&2; exit 1; }
programs=$(realpath "$1") device=$2
shift 2
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
pictures=$here/../../docs/images/classics
(($# > 0)) || mapfile -t names < <(cd "$here" && for f in */README.md; do dirname "$f"; done)
(($# == 0)) || names=("$@")
mkdir -p "$pictures"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for name in "${names[@]}"; do
  readme=$here/$name/README.md
  size=$(sed -n "s/^<!-- $device \([0-9]*\) *-->$/\1/p" "$readme")
  if [[ -n ${RUN_FROM:-} ]]; then
    output=$(cat "$RUN_FROM/$name.txt")
  elif ! output=$(cd "$work" && SK_DEVICE=$device "$programs/$name" ${size:+"$size"}); then
    printf '%s\nfigures.sh: %s failed\n' "$output" "$name" >&2
    exit 1
  fi
  TEXT=$(grep -v '^picture: \|^| ' <<<"$output") awk -v device="$device" '
    $0 == "<!-- /" device " -->" { inside = 0 }
    !inside { print }
    $0 ~ "^<!-- " device "( [0-9]+)? -->$" { print "```text"; print ENVIRON["TEXT"]; print "```"; inside = 1 }' "$readme" >"$work/README"
  cat "$work/README" >"$readme"
  if [[ $device == native ]]; then
    for picture in "$work"/*.png; do
      convert "$picture" -strip -dither none -colors 256 -define png:compression-level=9 "PNG8:$pictures/$(basename "$picture")"
    done
    rm -f "$work"/*.png
  fi
done
