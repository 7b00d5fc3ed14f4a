#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# bench.sh BUILD_DIR [ARGUMENTS of sk_bench]: what ./dev bench runs once everything is built.
set -euo pipefail
build=${1:?usage: bench.sh BUILD_DIR [ARGUMENTS of sk_bench]}
shift
exec "$build/tests/bench/sk_bench" "$@"
