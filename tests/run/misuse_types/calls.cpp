// SPDX-License-Identifier: MIT
//
// Calls with const outputs, and host memory where a stream is wanted: each value of WRONG is compiled separately and must
// not compile.
#include <vector>

#include <sk/sk.hpp>

#include "misuse.sk.hpp"

void call(sk::Stream<float>& f, const sk::Stream<float>& constant, sk::Scalar<float>& a, sk::Device& device) {
  misuse::diffuse(1, constant, f);  // right
#if WRONG == 1
  misuse::diffuse(1, f, constant);
#elif WRONG == 2
  misuse::sum(f, constant.domain({0}, {1}));
#elif WRONG == 3
  sk::Rows rows(std::vector<int>{0, 3, 5});
#elif WRONG == 4
  std::vector<float> memory(3);
  misuse::diffuse(1, memory, f);
#elif WRONG == 5
  auto numbers = device.stream<long long>({3});
#endif
  a = 2.0f;  // right
  static_cast<void>(device);
}
