#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
#
# Modules for browsers and their types have no name twice, whatever kernels, structs and namespaces are called.
# Usage: names_test.sh SKC SOURCE
set -euo pipefail
skc=$(realpath "$1") source=$(realpath "$2")
command -v node >/dev/null || { echo "skipped: no node"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >words.sk <<'END'
struct HitArrays { float a; };
struct Hit { float a; };
struct string { float a; };
struct a_Pair { float a; };
namespace a {
struct Pair { float a; };
kernel void function(Pair let<>, out Hit in_<>) { in_.a = let.a; }
kernel void await(HitArrays x<>, out string r<>) { r.a = x.a; }
}
namespace a_b { kernel void f(float x<>, out float r<>) { r = x; } }
namespace a { namespace b { kernel void f(float x<>, out float r<>) { r = x; } } }
kernel void function(a_Pair x<>, out Hit r<>) { r.a = x.a; }
kernel void function_(float x<>, out float r<>) { r = x; }
kernel void sk(float sk<>, out float with<>) { with = sk; }
kernel void $file(float $sk<>, out float r<>) { r = $sk; }
kernel void undefined(float x<>, out float r<>) { r = x; }
kernel void Arrays(float x<>, out float r<>) { r = x; }
END
cp "$source/tests/run/names.sk" .
sed -i "s|../../compiler|$source/compiler|" names.sk

mkdir streamkernel
cat >streamkernel/index.d.ts <<'END'
export type ArrayOf<T> = T;
export type Held<T> = T;
export type Input<T> = T;
export type Kernel<T extends unknown[]> = (...all: T) => void;
export type Output<T> = T;
export type Reduce<T extends unknown[], V, A extends unknown[]> = [T, V, A];
export type Struct<N, V, A> = [N, V, A];
export type Value<T> = T;
END
cat >tsconfig.json <<'END'
{ "compilerOptions": { "target": "es2022", "module": "esnext", "moduleResolution": "node", "strict": true, "noEmit": true,
                       "lib": ["es2022"], "types": [], "baseUrl": "." },
  "files": ["words.sk.d.ts", "names.sk.d.ts"] }
END
for file in words names; do
  "$skc" --emit=js $file.sk 2>messages || { cat messages; exit 1; }
  cp $file.sk.js $file.mjs
  node --check $file.mjs
done
if command -v tsc >/dev/null; then tsc -p .; fi
echo "no name stands twice"
