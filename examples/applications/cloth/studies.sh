#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# studies.sh [--check] [--only WORD] CLOTH DOCUMENT...: puts what `cloth ARGUMENTS` prints between the marks <!-- cloth ARGUMENTS -->
# and <!-- /cloth --> of the documents, where the arguments hold the word; the rest of a file stays as it is. With --check it
# writes nothing and fails where the text between the marks is another.
set -euo pipefail

check=
only=
while [[ ${1:-} == --* ]]; do
  case $1 in
    --check) check=yes ;;
    --only)
      only=$2
      shift
      ;;
    *) break ;;
  esac
  shift
done
if (($# < 2)); then
  echo "usage: studies.sh [--check] [--only WORD] CLOTH DOCUMENT..." >&2
  exit 1
fi
cloth=$(realpath "$1")
shift
here=$(realpath "$(dirname "$0")")

# What the program prints; what is no table is a block.
printed() {
  local text
  text=$(cd "$here" && "$cloth" "$@" 2>/dev/null)
  if [[ $text == "|"* ]]; then printf '%s\n' "$text"; else printf '```text\n%s\n```\n' "$text"; fi
}

status=0
for document in "$@"; do
  document=$(realpath "$document")
  made=$(mktemp)
  arguments=
  old=
  while IFS= read -r line; do
    if [[ -n $arguments && $line != "<!-- /cloth -->" ]]; then
      old+=$line$'\n'
      continue
    fi
    if [[ -n $arguments && $arguments == *"$only"* ]]; then
      # shellcheck disable=SC2086 # the arguments are words
      new=$(printed $arguments)$'\n'
      if [[ -n $check && $new != "$old" ]]; then
        printf "%s: cloth %s prints\n%snot\n%s" "$document" "$arguments" "$new" "$old" >&2
        status=1
      fi
      printf '%s' "$new"
    elif [[ -n $arguments ]]; then
      printf '%s' "$old"
    fi >>"$made"
    arguments=
    old=
    printf '%s\n' "$line" >>"$made"
    if [[ $line =~ ^'<!-- cloth '(.*)' -->'$ ]]; then arguments=${BASH_REMATCH[1]}; fi
  done <"$document"
  if [[ -z $check ]]; then cat "$made" >"$document"; fi
  rm -f "$made"
done
exit "$status"
