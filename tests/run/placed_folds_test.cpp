// SPDX-License-Identifier: MIT
//
// Promises: a reduction, or a kernel with folded outputs, that asks where its elements are and reads their neighbors folds a
// box of its domain as a part of the whole, whether its streams are whole or placed. Parts together give what one call gives.
// All numbers are small integers, so that sums are exact in any order.
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "placed_folds.sk.hpp"
#include "sk/placed.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using namespace placed_folds;

const sk::Shape whole{19, 24};

std::vector<float> numbers() {
  std::vector<float> values;
  for (int i = 0; i < 19 * 24; ++i) values.push_back(static_cast<float>((i * 37 + 11) % 53 - 20));
  return values;
}

/// Boxes that make up the whole.
std::vector<sk::Box> boxes() {
  return {{{0, 0}, {19, 9}}, {{0, 9}, {7, 24}}, {{7, 9}, {8, 24}}, {{8, 9}, {19, 24}}};
}

/// A part of a stream with a halo of one element, beyond the ends of the whole, too.
struct Held {
  Held(sk::Device& device, const sk::Box& box, const std::vector<float>& all)
      : at{{box.begin[0] - 1, box.begin[1] - 1}, whole} {
    const std::int64_t rows = box.end[0] - box.begin[0] + 2, columns = box.end[1] - box.begin[1] + 2;
    std::vector<float> values;
    for (std::int64_t y = 0; y < rows; ++y) {
      for (std::int64_t x = 0; x < columns; ++x) {
        const std::int64_t row = (at.origin[0] + y + 19) % 19, column = (at.origin[1] + x + 24) % 24;
        values.push_back(all[static_cast<std::size_t>(row * 24 + column)]);
      }
    }
    stream = device.stream<float>({rows, columns});
    stream.write(values);
  }
  auto placed() { return sk::placed(stream, at); }

  sk::Placement at;
  sk::Stream<float> stream;
};

/// Adds fold(options, stream) over all boxes, of whole streams and of placed ones, and compares with one call.
template <class Fold>
void checkSum(sk::Device& device, const Fold& fold) {
  auto x = device.stream<float>(whole);
  x.write(numbers());
  for (const sk::Accumulate kind :
       {sk::Accumulate::Default, sk::Accumulate::Exact, sk::Accumulate::Extended}) {
    const float expected = fold(sk::CallOptions{.accumulate = kind}, x, x);
    float boxed = 0, placed = 0;
    for (const sk::Box& box : boxes()) {
      const sk::CallOptions options{.accumulate = kind, .box = box};
      boxed += fold(options, x, x);
      Held held(device, box, numbers());
      placed += fold(options, held.placed(), held.placed());
    }
    CHECK(boxed == expected);
    CHECK(placed == expected);
  }
}

TEST_CASE("folds that use indices and extents speak of the whole") {
  onSomeLayouts([](sk::Device& device) {
    checkSum(device, [](const sk::CallOptions& options, const auto&, const auto& x) {
      return weighed.with(options)(x);
    });
    auto x = device.stream<float>(whole);
    x.write(numbers());
    const Least all = least(x);
    Least best{1e30F, {}};
    for (const sk::Box& box : boxes()) {
      Held held(device, box, numbers());
      const Least one = least.with({.box = box})(held.placed()), other = least.with({.box = box})(x);
      CHECK(one.value == other.value);
      CHECK((one.at.x == other.at.x && one.at.y == other.at.y));
      const bool isEarlier = one.at.y < best.at.y || (one.at.y == best.at.y && one.at.x < best.at.x);
      if (one.value < best.value || (one.value == best.value && isEarlier)) best = one;
    }
    CHECK((best.at.x == all.at.x && best.at.y == all.at.y));
  });
}

TEST_CASE("folds that read neighbors and ramps have those of the whole") {
  onSomeLayouts([](sk::Device& device) {
    checkSum(device, [](const sk::CallOptions& options, const auto& u, const auto& x) {
      return slopes.with(options)(u, x, sk::iter(sk::float2{0, 0}, sk::float2{24, 19}));
    });
    auto row = device.stream<float>({1, 24});
    const std::vector<float> values = numbers();
    row.write(std::span(values).first(24));
    auto x = device.stream<float>(whole);
    x.write(values);
    float sum = 0;
    for (const sk::Box& box : boxes()) {
      Held held(device, box, numbers());
      sum += mirrored.with({.box = box})(held.placed(), held.placed(), row);
    }
    CHECK(sum == mirrored(x, x, row));
  });
}

TEST_CASE("a product and its dot product over parts are those of the whole") {
  onSomeLayouts([](sk::Device& device) {
    auto x = device.stream<float>(whole), r = device.stream<float>(whole),
         boxed = device.stream<float>(whole);
    x.write(numbers());
    auto t = device.scalar<float>();
    for (const sk::Accumulate kind : {sk::Accumulate::Default, sk::Accumulate::Exact}) {
      product.with({.accumulate = kind})(x, x, r, t);
      const float expected = t.read();
      const std::vector<float> results = r.read();
      float boxedSum = 0, sum = 0;
      for (const sk::Box& box : boxes()) {
        const auto call = product.with({.accumulate = kind, .box = box});
        call(x, x, boxed, t);
        boxedSum += t.read();
        Held held(device, box, numbers()), result(device, box, numbers());
        call(held.placed(), held.placed(), result.placed(), t);
        sum += t.read();
        const sk::Index end{box.end[0] - box.begin[0] + 1, box.end[1] - box.begin[1] + 1};
        CHECK(result.stream.domain({1, 1}, end).read() == r.domain(box.begin, box.end).read());
        call(held.placed(), held.placed(), held.placed(), t);  // in place
        CHECK(held.stream.domain({1, 1}, end).read() == r.domain(box.begin, box.end).read());
      }
      CHECK(boxedSum == expected);
      CHECK(sum == expected);
      CHECK(boxed.read() == results);
    }
  });
}

TEST_CASE("folds of parts that hold too little are refused") {
  sk::Device& device = run_tests::device("native");
  auto u = device.stream<float>({4, 6}), x = device.stream<float>({4, 6});
  auto row = device.stream<float>({1, 24});
  const sk::Placement at{{3, 8}, whole};
  const sk::Box box{{3, 8}, {7, 14}};
  using Catch::Matchers::Contains;
  CHECK_THAT(errorOf([&] { (void)mirrored.with({.box = box})(sk::placed(u, at), sk::placed(x, at), row); }),
             Contains("mirrored: 'u' is read from") && Contains("give it a deeper halo"));
  CHECK_THAT(errorOf([&] { (void)weighed(sk::placed(x, at)); }),
             Contains("weighed: 'x' holds the elements {3, 8} to {7, 14} of a whole"));
}

}  // namespace
}  // namespace run_tests
