// SPDX-License-Identifier: MIT
//
// Compares operations on extreme floats with the same text compiled as C++.
#include <cmath>

#include "floats.sk.hpp"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wtautological-compare"
#include "shared/floats.hpp"
#pragma GCC diagnostic pop
#include "support/shared_cases.hpp"

using namespace run_tests;

namespace {

const std::vector<float> special = {0.0f,     -0.0f,    1,         -1,       0.5f,     -2.5f,
                                    1e10f,    -1e10f,   3.4e38f,   -3.4e38f, 1.2e-38f, 16777216,
                                    16777215, INFINITY, -INFINITY, NAN};

/// Whether two floats are equal with the same sign, or both NaN. A denormal expected value may be flushed to 0.
bool agree(const float& a, const float& b) {
  const bool isFlushed = b != 0 && std::fabs(b) < 1.17549435e-38f && a == 0;
  return isFlushed || (isSame(a, b) && std::signbit(a) == std::signbit(b)) ||
         (std::isnan(a) && std::isnan(b));
}

}  // namespace

TEST_CASE("infinity, NaN and signed zeros") {
  const Samples<float> samples = pairsOf(special);
#define CHECK_CASE(name) cases.check(#name, floats::run_##name, floats::name);
  onGlAndNative([&](sk::Device& device) {
    {
      SharedCases<int, float> cases(device, samples);
      FLOAT_TO_INT_CASES(CHECK_CASE)
    }
    {
      SharedCases<float, float> cases(device, samples);
#define CHECK_FLOATS(name) cases.check(#name, floats::run_##name, floats::name, agree);
      FLOAT_CASES(CHECK_FLOATS)
    }
  });
}
#undef CHECK_CASE
