// SPDX-License-Identifier: MIT
//
// Calls with const outputs: each value of WRONG is compiled separately and must not compile.
#include "misuse.sk.hpp"

void call(sk::Stream<float>& f, const sk::Stream<float>& constant) {
  misuse::diffuse(1, constant, f);   // right
#if WRONG == 1
  misuse::diffuse(1, f, constant);
#elif WRONG == 2
  misuse::sum(f, constant.domain({0}, {1}));
#endif
}
