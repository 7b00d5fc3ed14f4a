// SPDX-License-Identifier: MIT
//
// Calls whose mistake the C++ compiler finds: each WRONG is compiled by itself and must not pass.
#include "misuse.sk.hpp"

void call(sk::Stream<float>& f, const sk::Stream<float>& constant, sk::Stream<int>& n, sk::Stream<misuse::Hit>& hits) {
  misuse::diffuse(1, f, f);   // right, as is every line below without its WRONG
#if WRONG == 1
  misuse::diffuse(1, n, f);
#elif WRONG == 2
  misuse::diffuse(1, f, n);
#elif WRONG == 3
  misuse::diffuse(1, f, constant);
#elif WRONG == 4
  misuse::split(f, f, f);
#elif WRONG == 5
  misuse::diffuse(1, f);
#elif WRONG == 6
  (void)misuse::sum(hits);
#elif WRONG == 7
  misuse::sum(f, constant.domain({0}, {1}));
#endif
  (void)n;
  (void)constant;
  (void)hits;
}
