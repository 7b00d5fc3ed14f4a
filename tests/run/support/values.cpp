// SPDX-License-Identifier: MIT
#include "support/values.hpp"

namespace run_tests {

#define SK_COMPILED_ONCE(T)                                                        \
  template std::string differenceOf(const std::vector<T>&, const std::vector<T>&); \
  template std::string differenceOf(const std::vector<T>&, const std::vector<T>&, const Agree<T>&);
#include "support/compared_types.def"
#undef SK_COMPILED_ONCE

std::string difference(const std::vector<float>& actual, const std::vector<float>& expected, double absolute,
                       double relative) {
  return differenceOf<float>(actual, expected, [&](float a, float b) {
    const double allowed = std::max(absolute, relative * std::fabs(double{b}));
    return isSame(a, b) || std::fabs(double{a} - double{b}) <= allowed;
  });
}

}  // namespace run_tests
