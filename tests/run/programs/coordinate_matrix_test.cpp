// SPDX-License-Identifier: MIT
//
// coordinate_matrix.sk against a loop over the entries, in double. Each product is rounded once, and each element of y once per
// entry of its row, in any order.
#include "programs/coordinate_matrix.sk.hpp"

#include "programs/bounds.hpp"
#include "support/devices.hpp"

using namespace run_tests;
using coordinate_matrix::Entry;

namespace {

/// Entries in random order; some have the same row and column.
std::vector<Entry> entries(int rows, int columns, int count) {
  std::vector<Entry> list;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t bits = hashed(static_cast<std::uint32_t>(i) + 3u), more = hashed(bits);
    list.push_back({static_cast<int>(bits % static_cast<std::uint32_t>(rows)),
                    static_cast<int>(more % static_cast<std::uint32_t>(columns)),
                    noise(static_cast<std::size_t>(i))});
  }
  return list;
}

void check(sk::Device& device, int rows, int columns, int count) {
  INFO(rows << " x " << columns << ", " << count << " entries");
  const auto list = entries(rows, columns, count);
  const auto x = noises(columns, 1), before = noises(rows, 2);
  auto y = streamOf<float>(device, before);
  coordinate_matrix::multiplyAdd(streamOf<Entry>(device, list), streamOf<float>(device, x), y);

  std::vector<double> sums(before.begin(), before.end()), sizes(before.size()), roundingsOf(before.size(), 1);
  for (std::size_t i = 0; i < before.size(); ++i) sizes[i] = std::fabs(before[i]);
  for (const Entry& e : list) {
    const auto row = static_cast<std::size_t>(e.row);
    const double product = double{e.value} * x[static_cast<std::size_t>(e.column)];
    sums[row] += product;
    sizes[row] += std::fabs(product);
    ++roundingsOf[row];
  }
  CHECK(outside(y.read(),
                [&](std::size_t i) { return Bounded{sums[i], roundings(roundingsOf[i]) * sizes[i]}; }) == "");
}

}  // namespace

TEST_CASE("coordinate matrix: entries in any order add up in their rows") {
  onDrawnLayouts([](sk::Device& device) {
    for (const auto& [rows, columns, count] :
         {std::tuple{1, 1, 0}, {1, 1, 1}, {1, 64, 31}, {13, 5, 17}, {67, 61, 509}, {1021, 300, 4096}}) {
      check(device, rows, columns, count);
    }
  });
  onGlAndNative(
      [](sk::Device& device) { check(device, 20011, 997, 60013); });  // longer than a row of a texture
}
