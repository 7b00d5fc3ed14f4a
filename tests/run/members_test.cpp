// SPDX-License-Identifier: MIT
//
// Member functions take the parameters that helper functions take.
#include "members.sk.hpp"

#include <algorithm>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

TEST_CASE("member functions have outputs and gathers") {
  onGlAndNative([](sk::Device& device) {
    const std::vector<float> numbers = {3, -5, 8, 1, 0};
    auto a = streamOf<float>(device, {5}, numbers);
    auto x = streamOf<float>(device, {5}, {0, 1, 2, 3, 4});
    auto r = device.stream<float>({5});
    members::ranges(a, x, r);
    CHECK(difference(r.read(), [&](std::size_t i) {
            const float reach =
                static_cast<float>(i) + 2;  // the range grows by 2 to [-reach, reach], and is split at 1
            return std::clamp(numbers[i], -reach, 1.0F) + 100 * std::clamp(numbers[0], 1.0F, reach) +
                   2000 * reach;
          }) == "");
  });
}

TEST_CASE("member functions of nested structs, operators and templates have gathers") {
  onGlAndNative([](sk::Device& device) {
    const std::vector<float> numbers = {3, 5, 8, 1, 0};
    auto a = streamOf<float>(device, {5}, numbers);
    auto b = streamOf<float>(device, {2, 2}, {1, 2, 3, 4});
    auto r = device.stream<float>({5});
    members::weights(a, b, r);
    CHECK(difference(r.read(), [&](std::size_t i) {
            const auto at = [&](std::size_t k) { return numbers[std::min<std::size_t>(k, 4)]; };
            const float around = at(i == 0 ? 0 : i - 1) + 10 * at(i) + 100 * at(i + 1);
            return 3 * at(i + 1) + 4 + around + 3 * 4 + 9 + 2;
          }) == "");
  });
}
