// SPDX-License-Identifier: MIT
//
// binary_search.sk against std::lower_bound.
#include "programs/binary_search.sk.hpp"

#include <algorithm>
#include <limits>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

void check(sk::Device& device, std::int64_t length, std::int64_t count) {
  INFO("a table of " << length << ", " << count << " keys");
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  auto table = values<float>(length, 1);   // with repetitions
  table.front() = -inf;
  std::sort(table.begin(), table.end());
  auto keys = values<float>(count, 2);
  const float special[] = {-inf, inf, nan, -0.0f, table.back(), table.front(), -8.5f, 8.5f};
  if (count > 8) std::copy(std::begin(special), std::end(special), keys.begin());

  auto place = device.stream<int>({count});
  auto isThere = device.stream<bool>({count});
  binary_search::find(streamOf<float>(device, table), streamOf<float>(device, keys), place, isThere);
  CHECK(difference(place.read(), [&](std::size_t i) {
          return static_cast<int>(std::lower_bound(table.begin(), table.end(), keys[i]) - table.begin());
        }) == "");
  CHECK(difference(isThere.read(), [&](std::size_t i) {
          return std::uint8_t(std::find(table.begin(), table.end(), keys[i]) != table.end());
        }) == "");
}

}  // namespace

TEST_CASE("binary search: many keys in tables of every length") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t length : {1, 2, 3, 64, 65, 1021, 4096}) {
      for (const std::int64_t count : {0, 1, 517}) check(device, length, count);
    }
  });
  onGlAndNative([](sk::Device& device) { check(device, 20011, 1021); });  // longer than a row of a texture
}
