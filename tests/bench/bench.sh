#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# bench.sh BUILD_DIR [--json FILE] [--chart DIR] [--document FILE] [ARGUMENTS of sk_race]: what ./dev bench runs once
# everything is built. Without arguments of sk_race, sk_bench runs, too. bench.sh BUILD_DIR costs ARGUMENTS...: sk_bench alone.
# bench.sh BUILD_DIR busy ARGUMENTS...: native calls beside busy processes.
set -euo pipefail
build=${1:?usage: bench.sh BUILD_DIR [--json FILE] [--chart DIR] [--document FILE] [ARGUMENTS of sk_race]}
shift
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
costs=$build/tests/bench/sk_bench
race=$build/tests/bench/race/sk_race

if [[ ${1:-} == costs ]]; then
  exec "$costs" "${@:2}"
fi

if [[ ${1:-} == busy ]]; then
  exec python3 -B "$here/busy.py" "$race" "${@:2}"
fi

telling=() racing=()
while (($#)); do
  case $1 in
    --json | --chart | --document)
      telling+=("$1" "${2:?$1 wants a name}")
      shift 2
      ;;
    *)
      racing+=("$1")
      shift
      ;;
  esac
done
for argument in ${racing[@]+"${racing[@]}"}; do
  [[ $argument != -h && $argument != --help ]] || { sed -n '4,5s/^# //p' "$0"; exec "$race" --help; }
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
files=()
((${#racing[@]})) || { "$costs" --json "$work/costs.json"; files+=("$work/costs.json"); }
status=0
if [[ -x $race ]]; then
  "$race" --json "$work/race.json" ${racing[@]+"${racing[@]}"} || status=$?
  files+=("$work/race.json")
else
  echo "bench.sh: no sk_race was built (Google Benchmark: libbenchmark-dev)" >&2
fi
python3 -B "$here/report.py" "${files[@]}" ${telling[@]+"${telling[@]}"}
exit "$status"
