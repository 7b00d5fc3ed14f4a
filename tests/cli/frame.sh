# SPDX-License-Identifier: MIT
#
# What tests of command lines share, to be sourced: a folder of their own, which they are in, and words for what a
# program should print. The test names the program first: tested=(PATH [ARGUMENT...]).

place=$(mktemp -d)
trap 'chmod -R u+w "$place"; rm -rf "$place"' EXIT
cd "$place"

# run STATUS ARGUMENT...: its texts go to $out and $err, and to out.txt and err.txt.
run() {
  local expected=$1 status=0
  shift
  line="${tested[*]##*/} $*"
  "${tested[@]}" "$@" >out.txt 2>err.txt </dev/null || status=$?
  out=$(<out.txt)
  err=$(<err.txt)
  ((status == expected)) || broken "status $status, not $expected"
  [[ $err != *$'\e'* && $out != *$'\e'* ]] || broken "colours without a terminal"
}
broken() { printf 'broken: %s\n%s\nstandard output:\n%s\nstandard error:\n%s\n' "$1" "$line" "$out" "$err"; exit 1; }
prints() { [[ $out == *"$1"* ]] || broken "standard output lacks: $1"; }
matches() { grep -qE -- "$1" out.txt || broken "no line of standard output matches: $1"; }
says() { [[ $err == *"$1"* ]] || broken "standard error lacks: $1"; }
