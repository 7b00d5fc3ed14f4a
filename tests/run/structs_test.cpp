// SPDX-License-Identifier: MIT
//
// Compares structs and arrays with the same text compiled as C++.
#include "structs.sk.hpp"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"   // tests that missing members are zero
#include "shared/structs.hpp"
#pragma GCC diagnostic pop
#include "support/shared_cases.hpp"

using namespace run_tests;

TEST_CASE("structs and arrays are those of C++") {
  const Samples<int> samples = pairsOf(-6, 12);
  onGlAndNative([&](sk::Device& device) {
    SharedCases<int, int> cases(device, samples);
#define CHECK_CASE(name) cases.check(#name, structs::run_##name, structs::name);
    STRUCT_CASES(CHECK_CASE)
  });
}
#undef CHECK_CASE
