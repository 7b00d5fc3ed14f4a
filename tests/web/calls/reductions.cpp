// SPDX-License-Identifier: MIT
//
// The calls of reductions.mjs in native code.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sk/sk.hpp>

#include "calls/reductions.sk.hpp"
#include "reference.hpp"

namespace {

using namespace folds;

/// Floats of all magnitudes: sums of them cancel, and depend on the order wherever they are rounded.
std::vector<float> wild(std::size_t n, std::uint32_t seed) {
  std::vector<float> all = floats(n, seed);
  for (std::size_t i = 0; i < n; ++i)
    all[i] = std::ldexp(all[i], static_cast<int>(random24(i, seed + 100) % 200) - 110);
  return all;
}

/// Bits, since sums must be equal in all of them.
std::vector<double> bitsOf(const std::vector<float>& values) {
  std::vector<double> bits;
  for (const float value : values)
    bits.push_back(std::isnan(value) ? -1 : static_cast<double>(std::bit_cast<std::uint32_t>(value)));
  return bits;
}

std::string text(const sk::Shape& shape) {
  std::string list;
  for (int d = 0; d < shape.rank(); ++d) list += (d > 0 ? "," : "") + std::to_string(shape[d]);
  return list;
}

constexpr auto exactly = sk::Accumulate::Exact;
constexpr auto extended = sk::Accumulate::Extended;

struct Reductions : Streams {
  void exactSums() {
    for (const std::int64_t n : {1LL, 7LL, 1000LL, 20011LL}) {
      const std::string name = " " + std::to_string(n);
      const auto elements = static_cast<std::size_t>(n);
      auto x = filled<float>({n}, wild(elements, 40)), y = filled<float>({n}, wild(elements, 41));
      auto z = random({n}, 42);
      print("exact" + name, bitsOf({sum.with({.accumulate = exactly})(x), precisely(y)}));
      print("exact dot" + name, bitsOf({dot.with({.accumulate = exactly})(z, y)}));
      print("extended" + name,
            {sum.with({.accumulate = extended})(z), dot.with({.accumulate = extended})(z, z)});
      const Sums sums = gathered.with({.accumulate = exactly})(x, z);
      print("exact struct" + name, bitsOf({sums.moment.x, sums.moment.y, sums.mass, sums.farthest}));
    }
    auto x = filled<float>({48, 36}, wild(48 * 36, 43)), z = random({48, 36}, 44);
    for (const sk::Shape& shape : {sk::Shape{48, 1}, sk::Shape{1, 36}, sk::Shape{12, 6}, sk::Shape{1, 1}}) {
      auto r = device.stream<float>(shape);
      sum.with({.accumulate = exactly})(x, r);
      print("exact to " + text(shape), bitsOf(r.read()));
      dot.with({.accumulate = exactly})(x, z, r);
      print("exact dot to " + text(shape), bitsOf(r.read()));
      sum.with({.accumulate = extended})(z, r);
      print("extended to " + text(shape), r.read());
      sum(z, r);
      print("sum to " + text(shape), r.read());
    }
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const std::vector<std::vector<float>> ends = {
        {1, infinity, 2},         {infinity, -infinity}, {-0.0F, -0.0F},    {3e38F, 3e38F, -3e38F},
        {1e-45F, 1e-45F, 2e-38F}, {3e38F, 3e38F, 3e38F}, {std::nanf(""), 1}};
    std::vector<float> found;
    for (const std::vector<float>& values : ends) {
      auto some = filled<float>({static_cast<std::int64_t>(values.size())}, values);
      found.push_back(sum.with({.accumulate = exactly})(some));
    }
    print("exact ends", bitsOf(found));
  }

  void blocks() {
    const std::vector<std::pair<sk::Shape, std::vector<sk::Shape>>> cases = {
        {{60, 48}, {{60, 1}, {1, 48}, {48}, {30, 24}, {6, 8}, {1, 1}, {1}, {60, 48}}},
        {{4, 5000}, {{4, 1}, {2, 1}, {1, 50}}},
        {{7, 33}, {{7}, {1, 11}}},
        {{9000}, {{10}, {3000}, {1}}},
        {{6, 8, 10}, {{3, 4, 5}, {6, 1, 1}, {8, 10}, {1, 1, 10}}},
        {{2, 3, 4, 50}, {{2, 3, 4, 1}, {1, 3, 1, 25}, {2, 1, 4, 1}}}};
    for (const auto& [shape, results] : cases) {
      const auto elements = static_cast<std::size_t>(shape.size());
      auto x = filled<int>(shape, randomIntegers<int>(elements, 45, 2001));
      for (const sk::Shape& result : results) {
        const std::string name = " " + text(shape) + " to " + text(result);
        auto r = device.stream<int>(result), s = device.stream<int>(result);
        folds::count(x, r);
        print("count" + name, r.read());
        last(x, r);
        print("last" + name, r.read());
        weighted(x, r, s);
        print("weighted" + name, r.read());
        print("most" + name, s.read());
      }
    }
    auto x = filled<int>({24, 40}, randomIntegers<int>(24 * 40, 46, 100));
    auto table = filled<int>({16}, randomIntegers<int>(16, 47, 100)), n = device.stream<int>({24, 1});
    looked(3, true, table, x, n);
    print("looked", n.read());
    auto a = random({24, 40}, 48), b = random({24, 40}, 49);
    auto s = device.stream<Sums>({6, 10});
    gathered(a, b, s);
    std::vector<double> members;
    for (const Sums& one : s.read())
      members.insert(members.end(), {one.moment.x, one.moment.y, one.mass, one.farthest});
    print("gathered", members);
    largest(x, x);  // each block is an element
    print("same", x.read());
    auto none = device.stream<int>({0, 8});
    auto zeros = filled<int>({1, 8}, randomIntegers<int>(8, 50, 9));
    folds::count(none, zeros);
    print("none", zeros.read());
  }

  void folded() {
    for (const std::int64_t w : {64LL, 61LL}) {
      const std::string name = " " + std::to_string(w);
      auto p = random({48, w}, 51), q = random({48, w}, 52), x = random({48, w}, 53), r = random({48, w}, 54);
      auto rr = device.stream<float>({1}), rows = device.stream<float>({48, 1});
      descend(0.5F, p, q, x, r, x, r, rr);
      print("descend" + name, rr.read());
      descend(0.25F, p, q, x, r, x, r, rows);
      print("descend rows" + name, rows.read());
      print("descend x" + name, x.read());
      print("descend r" + name, r.read());
      auto cells = filled<int>({48, w}, randomIntegers<int>(static_cast<std::size_t>(48 * w), 55, 7));
      auto alive = device.stream<int>({1}), most = device.stream<int>({1});
      advance(cells, cells, alive, most);
      print("advance" + name, {double(alive.read()[0]), double(most.read()[0])});
      auto aliveRows = device.stream<int>({48, 1}), mostRows = device.stream<int>({48, 1});
      advance(cells, cells, aliveRows, mostRows);
      print("advance rows" + name, aliveRows.read());
      print("advance most" + name, mostRows.read());
      print("advance cells" + name, cells.read());
    }
    auto r = device.stream<int>({10, 12}), total = device.stream<int>({1});
    ramped(sk::iter(0, 120), r, total);
    print("ramped", {double(total.read()[0]), double(r.read()[119])});
  }

  void scans() {
    constexpr auto exclusive = sk::Scan::Exclusive;
    for (const sk::Shape& shape :
         {sk::Shape{1}, sk::Shape{7}, sk::Shape{1000}, sk::Shape{20011}, sk::Shape{37, 29}, sk::Shape{64, 48},
          sk::Shape{5, 7, 36}, sk::Shape{3, 2, 4, 20}}) {
      const auto elements = static_cast<std::size_t>(shape.size());
      auto x = filled<int>(shape, randomIntegers<int>(elements, 56, 201)), s = device.stream<int>(shape);
      for (int along = -1; along < shape.rank(); ++along) {
        const std::string name = " " + text(shape) + " along " + std::to_string(along);
        const std::optional<int> dimension = along < 0 ? std::nullopt : std::optional(along);
        prefix.with({.along = dimension})(x, s);
        print("prefix" + name, s.read());
        prefix.with({.scan = exclusive, .along = dimension})(x, s);
        print("before" + name, s.read());
        highest.with({.along = dimension})(x, s);
        print("highest" + name, s.read());
        located.with({.along = dimension})(x, s);
        print("located" + name, s.read());
      }
    }
    auto x = filled<float>({3000}, wild(3000, 57)), z = random({50, 60}, 58),
         r = device.stream<float>({3000});
    auto t = device.stream<float>({50, 60});
    running.with({.accumulate = exactly})(x, r);
    print("running exact", bitsOf(r.read()));
    running.with({.accumulate = exactly, .scan = exclusive, .along = 1})(z, t);
    print("running exact along", bitsOf(t.read()));
    running(z, t);
    print("running", t.read());
    running.with({.accumulate = extended})(z, z);
    print("running extended", z.read());
  }
};

}  // namespace

void printReductions() {
  Reductions reductions;
  reductions.exactSums();
  reductions.blocks();
  reductions.folded();
  reductions.scans();
}
