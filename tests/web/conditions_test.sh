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

# Five constants with eight values each come to no more sets than the streams that they switch.
cat >many.sk <<'SK'
enum Way { First, Second, Third, Fourth, Fifth, Sixth };
kernel void pick(spec Way a, spec Way b, spec Way c, spec Way d, spec Way e, float s[], float t[], float u[], float v[], float w[], out float r<>) {
  r = 0;
  if (a == Third) r += s[0];
  if (b == Fourth) r += t[0];
  if (c == Fifth) r += u[0];
  if (d == Sixth) r += v[0];
  if (e == First) r += w[0];
}
kernel void flagged(spec uint flags, float s[], float t[], float u[], out float r<>) {
  r = 0;
  if ((flags & 1) != 0) r += s[0];
  if ((flags & 4) != 0) r += t[0];
  if ((flags & 32) != 0) r += u[0];
}
kernel void counted(spec int n, spec uint m, float v[], float w[], out float r<>) {
  r = 0;
  if (n * 7 == 63) r += v[0];
  if (m + 40 == 17) r += w[0];
}
SK
"$skc" --emit=js many.sk
count() { grep -oE "\"linear1; [^\"]*($1)[^\"]*\":" many.sk.js | sort -u | wc -l; }
[ "$(count 'u:linear|no u')" = 40 ] || { echo "not 32 sets of five streams and 8 of three"; exit 1; }
[ "$(count 'w:linear|no w')" = 36 ] || { echo "not 32 sets of five streams and 4 of two"; exit 1; }

# A kernel with too many sets of streams is refused.
cat >refused.sk <<'SK'
kernel void flagged(spec uint flags, float a[], float b[], float c[], float d[], float e[], float f[], float g[], float h[],
                    float i[], out float r<>) {
  r = 0;
  if ((flags & 1) != 0) r += a[0];
  if ((flags & 2) != 0) r += b[0];
  if ((flags & 4) != 0) r += c[0];
  if ((flags & 8) != 0) r += d[0];
  if ((flags & 16) != 0) r += e[0];
  if ((flags & 32) != 0) r += f[0];
  if ((flags & 64) != 0) r += g[0];
  if ((flags & 128) != 0) r += h[0];
  if ((flags & 256) != 0) r += i[0];
}
SK
"$skc" --emit=js refused.sk
for file in refused.sk.js refused.sk.d.ts; do
  grep -q "among more than 256 sets of streams" $file || { echo "$file does not refuse"; exit 1; }
done
