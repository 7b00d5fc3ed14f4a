#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# demo.sh [--small] BUILD_DIR OUT_DIR: runs the classics, drift beside its reference, then every application on input that it makes itself. Shows what each
# did, how far it was from double precision, and where the pictures are. Works without a terminal.
# The exit status is 1 if an example failed or missed its bound. --small is for tests: it takes seconds, not minutes.
set -uo pipefail

size=512 steps=4000 elements=4000000
classics=usual small=()
if [[ ${1:-} == --small ]]; then
  size=96 steps=200 elements=10000 classics=small small=(--size 32)
  shift
fi
if (($# != 2)); then
  echo "usage: demo.sh [--small] BUILD_DIR OUT_DIR" >&2
  exit 1
fi
programs=$1/bin
out=$2
if ! mkdir -p "$out" || ! out=$(cd "$out" && pwd); then
  echo "demo.sh: cannot make the folder '$2'" >&2
  exit 1
fi
summary=$out/summary.tsv
: >"$summary"
failed=0

# example NAME ARGUMENTS...: shows the command, runs it in the folder of the pictures, keeps going.
example() {
  local name=$1
  if [[ ! -x $programs/$name ]]; then
    echo "demo.sh: '$programs/$name' is not built" >&2
    exit 1
  fi
  shift
  printf '\n> %s%s\n' "$name" "${*:+ $*}"
  if ! "$programs/$name" "$@" --summary "$summary"; then
    failed=1
    if [[ $(tail -n 1 "$summary" | cut -f 1) != "$name" ]]; then
      printf '%s\tno result\t-\t-\t-\tFAILED\t\n' "$name" >>"$summary"
    fi
  fi
}

# classics usual|small: runs the classics, each at its usual size or at the small one in their list, then shows one row for each.
classics() {
  local name small size rows=$out/classics/rows.txt printed=$out/classics/printed.txt
  mkdir -p classics
  : >"$rows"
  while read -r name small; do
    size=
    [[ $1 != small ]] || size=$small
    printf '\n> classics/%s%s\n' "$name" "${size:+ $size}"
    (cd classics && "$programs/classics/$name" ${size:+"$size"}) | tee "$printed"
    if ((PIPESTATUS[0])); then
      failed=1
      [[ $(tail -n 1 "$printed") == '| '* ]] || printf '| %s | | | | FAILED | |\n' "$name" >>"$rows"
    fi
    grep '^| ' "$printed" >>"$rows" || true
  done <"$examples/classics/list.txt"
  printf '\nthe classics, against plain loops in double precision:\n\n'
  awk -F ' *[|] *' '
    BEGIN { split("|name|paper|device|time|largest error|picture", head, "|") }
    NR == 1 { for (i = 2; i <= 7; ++i) width[i] = length(head[i]) }
    { for (i = 2; i <= 7; ++i) { cell[NR, i] = $i; if (length($i) > width[i]) width[i] = length($i) } }
    function line(row,   i, text) {
      for (i = 2; i <= 6; ++i) text = text sprintf("%-*s  ", width[i], row ? cell[row, i] : head[i])
      print text (row ? cell[row, 7] : head[7])
      return length(text)
    }
    END {
      rule = sprintf("%*s", line(0) + width[7], "")
      gsub(/ /, "-", rule)
      print rule
      for (r = 1; r <= NR; ++r) line(r)
    }' "$rows"
  rm "$rows" "$printed"
}

# shadowed REPORT NAME ARGUMENTS...: runs an example beside its reference in double. Its row is followed by what the report says first.
shadowed() {
  local report=$1
  shift
  printf '\n> SK_SHADOW=%s.html' "$report"
  SK_SHADOW=$report.html example "$@"
  verdict=$(sed -n 's/.*"verdicts":\[{[^}]*"text":"\([^"]*\)".*/\1/p' "$report.json")
  if [[ -z $verdict ]]; then
    echo "demo.sh: '$out/$report.json' holds no report" >&2
    failed=1
  fi
  printf '%s says: %s\n' "$report.html" "$verdict"
}

# everywhere NAME ARGUMENTS...: runs an example on each device that there is, and shows what it took there.
everywhere() {
  local name=$1 device said all=$out/devices.tsv
  shift
  : >"$all"
  for device in native software gpu:{0..7}; do
    if ! said=$("$programs/$name" "$@" --device "$device" --summary "$all" 2>&1); then
      [[ $said == *"no device '$device' was found"* ]] && continue
      printf '%s\n' "$said" >&2
      failed=1
    fi
  done
  printf '\nthe same on every device of this machine:\n\n'
  awk -F '\t' '{ printf "  %-40s %10s   %s\n", $7, $5, $6 }' "$all"
  rm "$all"
}

programs=$(cd "$programs" 2>/dev/null && pwd) || {
  echo "demo.sh: '$1' holds no built examples" >&2
  exit 1
}
examples=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd) || exit 1
cd "$out" || exit 1
classics "$classics"
shadowed drift_report drift "${small[@]}" --output drift.png
example saxpy --size "$elements"
everywhere saxpy --size "$elements"
example edges --size "$size" --output edges.png
example edges --size "$size" --low 0.01 --high 0.05 --style ink edges_input.png edges_linked.png
example cloth "$examples/applications/cloth/scenes/drape.toml" --points "$((size / 6 + 1))" "$((size / 6 + 1))" --steps "$((steps * 3 / 2))" --frames 1 -o cloth_drape.png
example cloth "$examples/applications/cloth/scenes/torn.toml" --points "$((size / 6 + 1))" "$((size / 8 + 1))" --steps "$steps" --frames 1 -o cloth_torn.png
example stats --made weather.csv
example lattice "$examples/applications/lattice/scenes/boiling.toml" --size "${size}x$((size * 5 / 8))" --steps "$((steps / 2))"
example lattice "$examples/applications/lattice/scenes/boiling_3d.toml" --size "$((size * 3 / 16))x$((size / 6))x$((size * 3 / 16))"
example lattice "$examples/applications/lattice/scenes/stirred.toml" --size "${size}x$((size * 3 / 8))" --steps "$steps" --csv stirred.csv
example lattice "$examples/applications/lattice/scenes/rolls.toml" --size "${size}x$((size / 8))" --steps "$steps"
example rays "$examples/applications/rays/scenes/rings.toml" --size "$((size * 5 / 8))x$((size * 3 / 8))" --samples "$((steps / 40 + 1))" --error 0.1 --output rays_rings.png
example smooth "$examples/applications/smooth/scenes/sphere.toml" -o smooth_sphere.png
example solve "poisson:${size}x${size}" --preconditioner multigrid --every 1
example fluid "$examples/applications/fluid/scenes/plume.toml" --size "$((size * 3 / 16))x$((size / 4))" --steps "$((steps / 40))"
example waves "$examples/applications/waves/scenes/drops.toml" --size "$((size / 4))x$((size * 7 / 36))" --steps 28 --pixels "${size}x$((size * 5 / 8))"

echo
awk -F '\t' -v verdict="$verdict" '
  $7 != "" { device = $7 }
  { for (i = 1; i <= 6; ++i) { cell[NR, i] = $i; if (length($i) > width[i]) width[i] = length($i) } }
  function line(a, b, c, d, e, f) {
    printf "%-*s  %-*s  %*s  %*s  %*s  %s\n", width[1], a, width[2], b, width[3], c, width[4], d, width[5], e, f
  }
  END {
    if (device != "") printf "on %s, against double precision:\n\n", device
    split("example\tdid\tlargest error\tallowed\ttime\t", head, "\t")
    for (i = 1; i <= 5; ++i) if (length(head[i]) > width[i]) width[i] = length(head[i])
    line(head[1], head[2], head[3], head[4], head[5], "")
    rule = sprintf("%*s", width[1] + width[2] + width[3] + width[4] + width[5] + 16, "")
    gsub(/ /, "-", rule)
    print rule
    for (r = 1; r <= NR; ++r) {
      line(cell[r, 1], cell[r, 2], cell[r, 3], cell[r, 4], cell[r, 5], cell[r, 6])
      if (cell[r, 1] == "drift") printf "%-*s  its report: %s\n", width[1], "", verdict
    }
  }' "$summary"

printf '\npictures in %s:\n' "$out"
printf '  %s\n' classics/*.png *.png drift_report.html
exit "$failed"
