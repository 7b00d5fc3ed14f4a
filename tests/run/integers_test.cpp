// SPDX-License-Identifier: MIT
//
// Compares integer arithmetic with the same text compiled as C++. All results are exact.
#include "integers.sk.hpp"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wparentheses"   // precedence is tested without parentheses
#include "shared/integers.hpp"
#pragma GCC diagnostic pop
#include "support/shared_cases.hpp"

using namespace run_tests;

namespace {

const std::vector<int> ints = {
    0,         1,          -1,          2,          -2,         3,           -3,
    5,         7,          -7,          8,          16,         31,          32,
    33,        -17,        100,         -100,       255,        256,         1000,
    -1000,     46340,      65535,       65536,      -65537,     16777216,    16777217,
    -16777217, 1073741823, -1073741824, 2147483646, 2147483647, -2147483647, -2147483647 - 1};

}  // namespace

TEST_CASE("int arithmetic is that of C++") {
  const Samples<int> samples = pairsOf(ints);
  onGlAndNative([&](sk::Device& device) {
    SharedCases<int, int> cases(device, samples);
#define CHECK_CASE(name) cases.check(#name, integers::run_##name, integers::name);
    INT_CASES(CHECK_CASE)
  });
}

TEST_CASE("uint arithmetic is that of C++: it wraps") {
  const Samples<std::uint32_t> samples = pairsOf(std::vector<std::uint32_t>(ints.begin(), ints.end()));
  onGlAndNative([&](sk::Device& device) {
    SharedCases<std::uint32_t, std::uint32_t> cases(device, samples);
    UINT_CASES(CHECK_CASE)
  });
}
#undef CHECK_CASE
