// SPDX-License-Identifier: MIT
//
// The GLSL functions that assembled programs share. They use only integers for indices, no negative operands
// of / or %, and never overflow, because indices are not negative and extents are at most sk::mostExtent.
// A section begins with `////` and its name in C++; glsl_text/functions.hpp defines it as a constant.

//// unravel2
// Index of element number n, given the strides.
ivec4 sk_unravel(int sk_n, ivec4 sk_s) {
  int sk_y = sk_n / sk_s.y;
  return ivec4(sk_n - sk_y * sk_s.y, sk_y, 0, 0);
}

//// unravel3
// Index of element number n, given the strides.
ivec4 sk_unravel(int sk_n, ivec4 sk_s) {
  int sk_z = sk_n / sk_s.z;
  sk_n -= sk_z * sk_s.z;
  int sk_y = sk_n / sk_s.y;
  return ivec4(sk_n - sk_y * sk_s.y, sk_y, sk_z, 0);
}

//// unravel4
// Index of element number n, given the strides.
ivec4 sk_unravel(int sk_n, ivec4 sk_s) {
  int sk_w = sk_n / sk_s.w;
  sk_n -= sk_w * sk_s.w;
  int sk_z = sk_n / sk_s.z;
  sk_n -= sk_z * sk_s.z;
  int sk_y = sk_n / sk_s.y;
  return ivec4(sk_n - sk_y * sk_s.y, sk_y, sk_z, sk_w);
}

//// ravel
// Number of the element at index i, given the strides.
int sk_ravel(ivec4 sk_i, ivec4 sk_s) {
  return sk_i.x * sk_s.x + sk_i.y * sk_s.y + sk_i.z * sk_s.z + sk_i.w * sk_s.w;
}

//// texel
// Texel of element number n in a texture of width 1 << s.
ivec2 sk_texel(int sk_n, int sk_s) {
  return ivec2(sk_n & ((1 << sk_s) - 1), sk_n >> sk_s);
}

//// paired
// A permutation of the numbers in each pair of rows of a texture of width 1 << h, 8 or more: of eight consecutive ones,
// four are in either row. GPUs keep texels of two rows in one sector of memory, and a sector that invocations side by side
// write only a part of takes as long as several.
int sk_paired(int sk_n, int sk_h) {
  int sk_i = sk_n & ((2 << sk_h) - 1);
  return (sk_n - sk_i) | ((sk_i >> 2 & 1) << sk_h) | (sk_i >> 3 << 2) | (sk_i & 3);
}

//// divide
// n / d for n >= 0 and d > 0, by floats, since software renderers divide integers one by one: the first quotient is off
// by the rounding error of n, the second by less than 1.
int sk_divide(int sk_n, int sk_d) {
  float sk_f = float(sk_d);
  int sk_q = int(float(sk_n) / sk_f);
  sk_q += int(floor(float(sk_n - sk_q * sk_d) / sk_f));
  int sk_r = sk_n - sk_q * sk_d;
  return sk_q + (sk_r < 0 ? -1 : sk_r >= sk_d ? 1 : 0);
}

//// row
// Texel of element number n in a plane of width w.
ivec2 sk_in_row(int sk_n, int sk_w) {
  int sk_y = sk_divide(sk_n, sk_w);
  return ivec2(sk_n - sk_y * sk_w, sk_y);
}

//// layered
// Texel t of layers of 1 << s rows each, which continue each other.
ivec3 sk_layered(ivec2 sk_t, int sk_s) {
  return ivec3(sk_t.x, sk_t.y & ((1 << sk_s) - 1), sk_t.y >> sk_s);
}

//// wrap
// i + d in a period of n elements, for i >= 0 and any d.
int sk_wrap(int sk_i, int sk_d, int sk_n) {
  uint sk_p = uint(sk_i) + uint(sk_d);
  if (sk_p < uint(sk_n)) return int(sk_p);
  bool sk_below = sk_d < -sk_i;
  int sk_r = int((sk_below ? ~sk_p : sk_p) % uint(sk_n));
  return sk_below ? sk_n - 1 - sk_r : sk_r;
}

//// wrapOnce
// p in a period of n elements, for -n <= p < 2n.
int sk_wrap(int sk_p, int sk_n) {
  return sk_p < 0 ? sk_p + sk_n : sk_p < sk_n ? sk_p : sk_p - sk_n;
}

//// mirror
// i + d mirrored at the ends of n elements, which repeats them, for i >= 0 and any d.
int sk_mirror(int sk_i, int sk_d, int sk_n) {
  uint sk_p = uint(sk_i) + uint(sk_d);
  if (sk_d < -sk_i) sk_p = ~sk_p;
  uint sk_turns = sk_p / uint(sk_n);
  int sk_r = int(sk_p - sk_turns * uint(sk_n));
  return (sk_turns & 1u) == 0u ? sk_r : sk_n - 1 - sk_r;
}

//// mirrorOnce
// p mirrored at the ends of n elements, which repeats them, for -n <= p < 2n.
int sk_mirror(int sk_p, int sk_n) {
  return sk_p < 0 ? -1 - sk_p : sk_p < sk_n ? sk_p : sk_n - 1 - (sk_p - sk_n);
}

//// toHalf
// The half that is nearest to x, of two the even one; infinity from 65520 on.
float sk_to_half(float sk_x) {
  uint sk_b = floatBitsToUint(sk_x), sk_m = sk_b & 0x7fffffffu;
  if (sk_m > 0x7f800000u) return sk_x;
  uint sk_r = (sk_m + 0xfffu + ((sk_m >> 13) & 1u)) & 0xffffe000u;
  if (sk_r > 0x477fe000u) sk_r = 0x7f800000u;
  if (sk_m < 0x38800000u) {
    sk_r = floatBitsToUint(roundEven(uintBitsToFloat(sk_m) * 16777216.0) * 5.9604645e-8);
  }
  return uintBitsToFloat((sk_b & 0x80000000u) | sk_r);
}

//// ramp
// Element k of a ramp from a in steps of s. Where k steps exceed the largest float, though the ramp's ends do not, it takes them in
// two parts.
float sk_ramp(float sk_a, int sk_k, float sk_s) {
  int sk_h = sk_k / 2;
  $pfloat sk_d = $(float(sk_k) * sk_s$);
  $pfloat sk_e = $(float(sk_h) * sk_s$);
  $pfloat sk_f = $(float(sk_k - sk_h) * sk_s$);
  $pfloat sk_r = $(sk_a + sk_d$);
  $pfloat sk_t = $($[sk_a + sk_e$] + sk_f$);
  return abs(sk_d) < 3e38 ? sk_r : sk_t;
}
vec2 sk_ramp(vec2 sk_a, ivec2 sk_k, vec2 sk_s) {
  return vec2(sk_ramp(sk_a.x, sk_k.x, sk_s.x), sk_ramp(sk_a.y, sk_k.y, sk_s.y));
}
vec3 sk_ramp(vec3 sk_a, ivec3 sk_k, vec3 sk_s) {
  return vec3(sk_ramp(sk_a.xy, sk_k.xy, sk_s.xy), sk_ramp(sk_a.z, sk_k.z, sk_s.z));
}
vec4 sk_ramp(vec4 sk_a, ivec4 sk_k, vec4 sk_s) {
  return vec4(sk_ramp(sk_a.xy, sk_k.xy, sk_s.xy), sk_ramp(sk_a.zw, sk_k.zw, sk_s.zw));
}

//// local
// Where the invocation is in its work group of 8 x 16: eight after one another fetch a line of the cache, 2 x 4 texels.
ivec2 sk_local() {
  int sk_i = int(gl_LocalInvocationIndex);
  return ivec2((sk_i & 1) | (sk_i >> 2 & 6), (sk_i >> 1 & 3) | (sk_i >> 5 << 2));
}

//// sampled
// The texel at t of a texture of at most 2^20 texels in each direction, whose sampler takes the nearest.
vec2 sk_centre(ivec2 sk_t, ivec2 sk_n) { return (vec2(sk_t) + 0.5) / vec2(sk_n); }
vec4 sk_sampled(sampler2D sk_s, ivec2 sk_t) {
  return textureLod(sk_s, sk_centre(sk_t, textureSize(sk_s, 0)), 0.0);
}
ivec4 sk_sampled(isampler2D sk_s, ivec2 sk_t) {
  return textureLod(sk_s, sk_centre(sk_t, textureSize(sk_s, 0)), 0.0);
}
uvec4 sk_sampled(usampler2D sk_s, ivec2 sk_t) {
  return textureLod(sk_s, sk_centre(sk_t, textureSize(sk_s, 0)), 0.0);
}
