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
// The bound comes from memory, so that no compiler unrolls the loop. It is 2: numbers are positive.
bool sk_are_loops_cut() {
  int rounds = 0;
  while (rounds < 2 - min(sk_cut_loops, 0)) ++rounds;
  return rounds < 2;
}
#define main sk_main

//// loopCheckEnd
#undef main
void main() {
  sk_main();
  if (sk_are_loops_cut()) sk_cut_loops = sk_loop_number;
}
