#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# expect_error.sh MESSAGE COMMAND...: wants COMMAND to fail with status 1 and one line on standard error
# that the extended regular expression MESSAGE fits.
set -u
message=$1
shift
errors=$("$@" 2>&1 >/dev/null)
status=$?
if ((status != 1)); then
  printf 'exit status %d, not 1; standard error: %s\n' "$status" "$errors"
  exit 1
fi
if [[ $(wc -l <<<"$errors") != 1 || ! $errors =~ $message ]]; then
  printf 'wanted one line that fits: %s\ngot: %s\n' "$message" "$errors"
  exit 1
fi
