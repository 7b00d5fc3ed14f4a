// SPDX-License-Identifier: MIT
//
// What programs of several .sk files have in common. SK_UPDATE_GOLDENS=1 writes it anew.

#define sk_precise
uniform uint sk_zero;   // never set, hence 0
float sk_keep(float x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
vec2 sk_keep(vec2 x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
vec3 sk_keep(vec3 x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
vec4 sk_keep(vec4 x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
float sk_known(float x) { return uintBitsToFloat(floatBitsToUint(x) + sk_zero); }
vec2 sk_known(vec2 x) { return uintBitsToFloat(floatBitsToUint(x) + sk_zero); }
vec3 sk_known(vec3 x) { return uintBitsToFloat(floatBitsToUint(x) + sk_zero); }
vec4 sk_known(vec4 x) { return uintBitsToFloat(floatBitsToUint(x) + sk_zero); }

#define sk_precise precise
#define sk_keep(x) (x)

Hit sk_fetch_h(ivec2 sk_t) {
  Hit sk_e;
  sk_e.t = texelFetch(sk_tex0_h, sk_t, 0).x;
  sk_e.id = texelFetch(sk_tex1_h, sk_t, 0).x;
  return sk_e;
}

float sk_product_error(float a, float b) {
  sk_precise float p = sk_keep(a * b);
  uint m = (floatBitsToUint(a) & 0x7fffffu) | 0x800000u;
  uint n = (floatBitsToUint(b) & 0x7fffffu) | 0x800000u;
  uint q = (floatBitsToUint(p) & 0x7fffffu) | 0x800000u;
  int units = int(m * n - (q << (((q - m) >> 31) + 23u)));
  sk_precise float e = sk_keep(float(units) * uintBitsToFloat(0x28800000u));
  sk_precise float f = sk_keep(uintBitsToFloat(floatBitsToUint(a) & 0xff800000u) *
                          uintBitsToFloat(floatBitsToUint(b) & 0xff800000u));
  return e * f;
}

float sk_rounded_product(float a, float b) {
  sk_precise float p = sk_keep(a * b);
  return p;
}

float sk_rounded_sum(float a, float b) {
  sk_precise float s = sk_keep(a + b);
  return s;
}

float sk_sum_error(float a, float b) {
  sk_precise float s = sk_keep(a + b);
  bool isLarge = bool(step(abs(b), abs(a)));
  float large = mix(b, a, isLarge);
  float small = mix(a, b, isLarge);
  sk_precise float c = sk_keep(s - large);
  sk_precise float d = sk_keep(small - c);
  return d;
}

int sk_wrap(int sk_p, int sk_n) {
  return sk_p < 0 ? sk_p + sk_n : sk_p < sk_n ? sk_p : sk_p - sk_n;
}

ivec2 sk_local() {
  int sk_i = int(gl_LocalInvocationIndex);
  return ivec2((sk_i & 1) | (sk_i >> 2 & 6), (sk_i >> 1 & 3) | (sk_i >> 5 << 2));
}

ivec2 sk_place(int sk_n) {
  int sk_y = sk_n / sk_source_width;
  return ivec2(sk_n - sk_y * sk_source_width, sk_y);
}

ivec2 sk_texel(int sk_n, int sk_s) {
  return ivec2(sk_n & ((1 << sk_s) - 1), sk_n >> sk_s);
}

ivec4 sk_index() {
  return (ivec4(sk_pixel * ivec2(4, 1), 0, 0) + ivec4(sk_lane, 0, 0, 0));
}

ivec4 sk_unravel(int sk_n, ivec4 sk_s) {
  int sk_y = sk_n / sk_s.y;
  return ivec4(sk_n - sk_y * sk_s.y, sk_y, 0, 0);
}

precision highp float;
precision highp int;
precision highp sampler2D;
precision highp isampler2D;
precision highp usampler2D;

uint sk_order(float x) {
  int bits = floatBitsToInt(x);
  return uint(bits ^ ((bits >> 31) & 0x7fffffff));
}
