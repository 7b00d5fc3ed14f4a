#!/bin/sh
# SPDX-License-Identifier: MIT
# A kernel that takes a bundle, and one of any rank, have the programs of kernels with the same parameters one by one: skc prints the
# same GLSL and the same native code for both, but for the spelling of names. A file with assertions has the programs of the file
# without, and those of its checks, which only SK_CHECK=asserts runs.
set -eu
skc=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

cat > grouped.sk <<'SK'
struct View { float3 eye; float scale; };
struct Ground { [[wrap]] float height[][]; float level; };
struct Scene {
  float4 corner[];
  int unread[];
  [[border(float4(1, 0, 0, 1))]] float4 sky[][];
  View view;
  Ground ground;
  spec bool lit;
};
float at(Ground ground, int2 p) { return ground.height[p] + ground.level; }
float3 normal(Scene scene, int face) { return cross(scene.corner[face].xyz, scene.view.eye) * scene.view.scale; }
kernel void shade(Scene scene, int hit<>, out float3 color<>) {
  color = normal(scene, hit) + at(scene.ground, indexof(color).xy);
  if (scene.lit) color += scene.sky[indexof(color).xy + 1].xyz;
}
reduce void total(Ground ground, float x<>, reduce float t<> = 0) { t += x * at(ground, indexof(x).xy); }
template <int N> float laplacian(gather<float, N> u) {
  float sum = 0;
  for (int d = 0; d < N; ++d) sum += neighbor(u, axis<N>(d)) - neighbor(u, -axis<N>(d));
  return sum;
}
template <int N> kernel void flow([[mirror]] gather<float, N> u, out float v<>) { v = laplacian(u) * u[indexof<N>(v)]; }
template kernel void flow<2>(gather<float, 2> u, out float v<>);
SK
cat > single.sk <<'SK'
struct View { float3 eye; float scale; };


float at(float ground_height[][], float ground_level, int2 p) { return ground_height[p] + ground_level; }
float3 normal(float4 scene_corner[], View scene_view, int face) { return cross(scene_corner[face].xyz, scene_view.eye) * scene_view.scale; }
kernel void shade(float4 scene_corner[], [[border(float4(1, 0, 0, 1))]] float4 scene_sky[][], View scene_view,
                  [[wrap]] float scene_ground_height[][], float scene_ground_level, spec bool scene_lit, int hit<>, out float3 color<>) {
  color = normal(scene_corner, scene_view, hit) + at(scene_ground_height, scene_ground_level, indexof(color).xy);
  if (scene_lit) color += scene_sky[indexof(color).xy + 1].xyz;
}
reduce void total([[wrap]] float ground_height[][], float ground_level, float x<>, reduce float t<> = 0) { t += x * at(ground_height, ground_level, indexof(x).xy); }
float laplacian(float u[][]) {
  float sum = 0;
  sum += neighbor(u, 1, 0) - neighbor(u, -1, 0);
  sum += neighbor(u, 0, 1) - neighbor(u, 0, -1);
  return sum;
}
kernel void flow([[mirror]] float u[][], out float v<>) { v = laplacian(u) * u[indexof(v).xy]; }
SK

# Comments and line numbers name the source.
for kind in glsl asm; do
  for file in grouped single; do
    "$skc" --emit=$kind $file.sk | sed -e 's/\b\(scene\|ground\)\.\([a-z]\)/\1_\2/g; s/\bscene_ground\.\([a-z]\)/scene_ground_\1/g' \
      -e '/^#line/d; /^ *\.loc/d; /^ *\.file/d; /^ *[;#]/d; s/ *#.*//' -e 's/sk_[0-9a-f]\{16\}/sk/g' -e "s/$file\.sk//g" > $file.$kind
  done
  [ "$(wc -l < grouped.$kind)" -gt 100 ]
  diff grouped.$kind single.$kind
done

cat > asserting.sk <<'SK'
bool isSmall(float x) { return x < 1e3; }
float root(float x) {
  assert(x >= 0);
  return sqrt(x);
}
void halve(float& x) {
  assert(isSmall(x) && x > -1);
  x /= 2;
}
kernel void steps(float k, float u[][], float x<>, out float r<>, out int n<>) {
  float s = root(x) + root(k);
  n = 0;
  for (int i = 0; i < n + 9 && root(s) > 1; ++i) {
    assert(i < 100);
    if (s > u[i][n]) break;
    halve(s);
    n += s > 3 && root(u[n][i]) < 5 ? 1 : 2;
  }
  r = s;
  assert(isfinite(r));
}
kernel void kept(float x<>, vout float r<>) {
  assert(x > 0);
  if (root(x) > 2) push(r, x);
}
reduce void total(float x<>, reduce float t<> = 0) {
  assert(x > 0);
  t += root(x);
}
SK
sed 's/^ *assert(.*);$//' asserting.sk > plain.sk
for file in asserting plain; do
  "$skc" --emit=glsl $file.sk | sed "s/$file\.sk//g" > $file.glsl
  # the code of functions, but for those that check, whose numbers are part of labels
  "$skc" --emit=asm $file.sk | awk '/\.type.*@function/ { is = !/Check/ } is { print } /\.size/ { is = 0 }' |
    sed -e '/^ *[;#]/d; s/ *#.*//; s/sk_[0-9a-f]\{16\}/sk/g; s/\.L[A-Za-z_]*[0-9]*_*/.L/g' > $file.asm
done
for kind in glsl asm; do
  [ "$(wc -l < plain.$kind)" -gt 100 ]
  diff asserting.$kind plain.$kind
done
