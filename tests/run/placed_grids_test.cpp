// SPDX-License-Identifier: MIT
//
// Promises: placed gathers may have other extents than the call's domain. Parts that hold what a promise allows around the same
// relative place, or what skc knows around the element's own index, give the bits of one call over whole streams.
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "placed_grids.sk.hpp"
#include "sk/placed.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using Catch::Contains;

sk::Stream<float> filled(sk::Device& device, const sk::Shape& shape) {
  auto stream = device.stream<float>(shape);
  std::vector<float> values;
  for (int i = 0; i < shape.size(); ++i) values.push_back(static_cast<float>(i * i % 97));
  stream.write(values);
  return stream;
}

/// The rows of a stream that a gather's part holds, from `begin` on; rows beyond the ends go on around them.
sk::Stream<float> rowsOf(sk::Device& device, const sk::Stream<float>& all, std::int64_t begin,
                         std::int64_t end) {
  const std::int64_t rows = all.shape()[0], columns = all.shape()[1];
  const std::vector<float> values = all.read();
  std::vector<float> part;
  for (std::int64_t y = begin; y < end; ++y) {
    const std::int64_t row = (y + rows) % rows * columns;
    part.insert(part.end(), values.begin() + row, values.begin() + row + columns);
  }
  auto stream = device.stream<float>({end - begin, columns});
  stream.write(part);
  return stream;
}

/// Computes rows 4 to 9 of a grid of 13 rows, or its last four, from the rows `first` to `last` of the other grid.
template <class Kernel>
void checkPart(sk::Device& device, const Kernel& kernel, const sk::Shape& other, std::int64_t begin,
               std::int64_t end, std::int64_t first, std::int64_t last) {
  const sk::Shape shape{13, 10};
  INFO("from " << sk::toString(other) << ", rows " << begin << " to " << end);
  auto u = filled(device, other), whole = device.stream<float>(shape);
  kernel(u, whole);
  auto part = rowsOf(device, u, first, last);
  auto own = device.stream<float>({end - begin, 10});
  kernel.with({.box = {{begin, 0}, {end, 10}}})(sk::placed(part, {{first, 0}, other}),
                                                sk::placed(own, {{begin, 0}, shape}));
  CHECK(own.read() == rowsOf(device, whole, begin, end).read());
}

TEST_CASE("parts of other grids are read around the same relative place") {
  onEveryTarget([](sk::Device& device) {
    // Row i lies at row (2 i + 1) 27 / 26 of the finer grid, and at (2 i + 1) 6 / 26 of the coarser one.
    checkPart(device, scaled_clamp, {27, 21}, 4, 9, 8, 19);
    checkPart(device, scaled_mirror, {27, 21}, 9, 13, 18, 27);
    checkPart(device, scaled_border, {27, 21}, 9, 13, 18, 27);
    checkPart(device, scaled_wrap, {27, 21}, 9, 13, 18, 28);
    checkPart(device, scaled_clamp, {6, 5}, 4, 9, 1, 5);
    checkPart(device, scaled_mirror, {6, 5}, 9, 13, 3, 6);
    checkPart(device, scaled_wrap, {6, 5}, 9, 13, 3, 7);
    checkPart(device, scaled_wrap, {6, 5}, 0, 4, -1, 3);
  });
}

TEST_CASE("what skc knows is read around the element's own index") {
  onEveryTarget([](sk::Device& device) {
    checkPart(device, near_clamp, {27, 21}, 4, 9, 3, 10);
    checkPart(device, near_border, {27, 21}, 9, 13, 8, 14);
    checkPart(device, near_clamp, {6, 5}, 4, 9, 3, 6);
    checkPart(device, near_mirror, {11, 5}, 8, 11, 7, 11);
    checkPart(device, near_wrap, {12, 5}, 9, 13, 8, 14);
  });
}

TEST_CASE("parts that hold too little of another grid are refused") {
  sk::Device& device = run_tests::device("native");
  auto part = device.stream<float>({10, 21}), own = device.stream<float>({5, 10});
  CHECK_THAT(errorOf([&] {
               scaled_clamp.with({.box = {{4, 0}, {9, 10}}})(sk::placed(part, {{9, 0}, {27, 21}}),
                                                             sk::placed(own, {{4, 0}, {13, 10}}));
             }),
             Contains("'u' is read from 1 before to 1 after the relative places of the elements of the box "
                      "{4, 0} to {9, 10}, "
                      "so from index 8 to 19 (exclusive) along y, but it holds 9 to 19 of 27"));
}

}  // namespace
}  // namespace run_tests
