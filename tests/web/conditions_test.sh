#!/bin/sh
# SPDX-License-Identifier: MIT
# A module for browsers has a program for each set of streams that the values of specialisation constants make a kernel need,
# however many other constants the kernel has.
set -eu
skc=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

cat >conditions.sk <<'SK'
enum Way { First, Second, Third, Fourth };
kernel void pick(spec bool isLit, spec Way a, spec Way b, spec Way c, spec Way d, spec Way e, float u[], float v[], out float r<>) {
  r = float(int(a) + int(b) + int(c) + int(d));
  if (isLit) r += u[0];
  if (e == Fourth) r += v[0];
}
SK
"$skc" --emit=js conditions.sk
for streams in 'u:linear; v:linear' 'u:linear; no v' 'no u; v:linear' 'no u; no v'; do
  grep -q "\"linear1; $streams\"" conditions.sk.js || { echo "no program with $streams"; exit 1; }
done
