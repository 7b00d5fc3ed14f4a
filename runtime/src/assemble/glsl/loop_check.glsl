// SPDX-License-Identifier: MIT
//
// Surrounds the main() of a program whose loops a driver may end early without saying so. Mesa's llvmpipe counts the iterations of
// all loops of an invocation, and of those that share its vectors, and from 65,535 on ends every loop after one iteration. A loop
// of two iterations at the end of the program shows whether that has happened; the program then stores its number.
// A section begins with `////` and its name in C++; glsl_text/loop_check.hpp defines it as a constant.

//// loopCheckBegin
layout(std430, binding = 1) buffer sk_loop_check {
  int sk_cut_loops;
};
uniform int sk_loop_number;
#define main sk_main

//// loopCheckOfDraw
#undef main
// No target is 2^20 texels wide, but no compiler knows that, so that none unrolls the loop.
int sk_two() { return 2 + (int(gl_FragCoord.x) >> 20); }

//// loopCheckOfDispatch
#undef main
// Numbers are positive, but no compiler knows that, so that none unrolls the loop.
int sk_two() { return 2 - min(sk_cut_loops, 0); }

//// loopCheckEnd
void main() {
  sk_main();
  int rounds = 0, two = sk_two();
  while (rounds < two) ++rounds;  // of a do loop, Mesa 22.3 takes it for granted that it has reached 2
  if (rounds < 2) sk_cut_loops = sk_loop_number;
}
