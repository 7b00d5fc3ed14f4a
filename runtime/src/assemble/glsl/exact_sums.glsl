// SPDX-License-Identifier: MIT
//
// Keeps compilers from simplifying rounding errors away; one section for each Barrier.
// A section begins with `////` and its name in C++; glsl_text/exact_sums.hpp defines it as a constant.

//// withoutBarrier
#define sk_precise
#define sk_keep(x) (x)

//// xorBarrier
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

//// preciseBarrier
#define sk_precise precise
#define sk_keep(x) (x)

//// knownValues
// Hides what a compiler knows, beside `precise`.
uniform uint sk_zero;   // never set, hence 0
float sk_known(float x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
vec2 sk_known(vec2 x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
vec3 sk_known(vec3 x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
vec4 sk_known(vec4 x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
