// SPDX-License-Identifier: MIT
//
// prefix_scan.sk against a running sum, exactly: integers wrap.
#include "programs/prefix_scan.sk.hpp"

#include <numeric>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

/// Replaces each element by its sum with all elements before it.
void scanInclusive(sk::Stream<int>& x) {
  for (int distance = 1; distance < x.size(); distance *= 2) prefix_scan::include(distance, x, x);
}

/// The sum of all elements before each one.
sk::Stream<int> scanExclusive(sk::Device& device, const sk::Stream<int>& x) {
  auto before = device.stream<int>({x.size()});
  if (x.size() <= 1) {
    before.write(std::vector<int>(static_cast<std::size_t>(x.size()), 0));
    return before;
  }
  auto pairs = device.stream<int>({(x.size() + 1) / 2});
  prefix_scan::pair(x, pairs);
  prefix_scan::spread(scanExclusive(device, pairs), x, before);
  return before;
}

const std::vector<std::int64_t> scanSizes = {0, 1, 2, 3, 17, 64, 65, 127, 1021, 4096};

std::vector<unsigned> sums(const std::vector<int>& x) {
  std::vector<unsigned> result(x.begin(), x.end());
  std::partial_sum(result.begin(), result.end(), result.begin());
  return result;
}

void checkBoth(sk::Device& device, std::int64_t n) {
  INFO(n << " elements");
  const auto x = values<int>(n);
  const auto upTo = sums(x);
  auto stream = streamOf<int>(device, x);
  const auto before = scanExclusive(device, stream).read();
  CHECK(difference(before, [&](std::size_t i) { return i == 0 ? 0 : static_cast<int>(upTo[i - 1]); }) == "");
  scanInclusive(stream);
  CHECK(difference(stream.read(), [&](std::size_t i) { return static_cast<int>(upTo[i]); }) == "");
}

}  // namespace

TEST_CASE("prefix scan: sums of every length, in both ways") {
  onDrawnLayouts([](sk::Device& device) {
    for (const std::int64_t n : scanSizes) checkBoth(device, n);
  });
}

TEST_CASE("prefix scan: more elements than a row of a texture has texels") {
  onGlAndNative([](sk::Device& device) { checkBoth(device, 100003); });
}
