// SPDX-License-Identifier: MIT
//
// Folds that do not commute, with two inputs and three accumulators, against a plain loop: random shapes, blocks, views,
// broadcast inputs, and results of lower rank.
#include <random>

#include "reduce_arguments.sk.hpp"
#include "reduce_results.sk.hpp"
#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  /// A random number in [low, high].
  std::int64_t roll(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool coin() { return roll(0, 1) == 1; }

 private:
  std::mt19937 engine_;
};

sk::Shape ones(int rank) {
  switch (rank) {
    case 1: return {1};
    case 2: return {1, 1};
    case 3: return {1, 1, 1};
    default: return {1, 1, 1, 1};
  }
}

/// A random shape of up to a few thousand elements.
sk::Shape randomShape(Dice& dice) {
  constexpr std::int64_t most[] = {5000, 75, 17, 8};
  sk::Shape shape = ones(static_cast<int>(dice.roll(1, 4)));
  for (int d = 0; d < shape.rank(); ++d) shape = shape.with(d, dice.roll(1, most[shape.rank() - 1]));
  return shape;
}

sk::Shape randomDivisor(Dice& dice, const sk::Shape& shape) {
  sk::Shape divisor = shape;
  for (int d = 0; d < shape.rank(); ++d) {
    std::int64_t extent = dice.roll(1, shape[d]);
    while (shape[d] % extent != 0) --extent;
    divisor = divisor.with(d, extent);
  }
  return divisor;
}

/// A whole stream, or a view of a larger stream, with these elements.
class Placed {
 public:
  Placed(sk::Device& device, Dice& dice, const HostArray<std::uint32_t>& elements)
      : begin_(sk::Index::origin(elements.shape().rank())),
        end_(begin_),
        stream_(device.stream<std::uint32_t>(1)) {
    sk::Shape whole = elements.shape();
    for (int d = 0; d < whole.rank(); ++d) {
      begin_[d] = dice.coin() ? 0 : dice.roll(0, 2);
      end_[d] = begin_[d] + whole[d];
      whole = whole.with(d, end_[d] + (dice.coin() ? 0 : dice.roll(0, 2)));
    }
    stream_ = device.stream<std::uint32_t>(whole);
    stream_.domain(begin_, end_).write(elements.elements());
  }
  sk::View<std::uint32_t> get() { return stream_.domain(begin_, end_); }

 private:
  sk::Index begin_, end_;
  sk::Stream<std::uint32_t> stream_;
};

struct Result {
  results::Affine map{1, 0};
  folds::Affine two{1, 0};
  int count = 0;
  bool odd = false;
};

/// The expected results: a plain loop folds every block in row-major order.
std::vector<Result> expectedOf(const HostArray<std::uint32_t>& x, const HostArray<std::uint32_t>& y,
                               const sk::Shape& blocks) {
  const sk::Shape& shape = x.shape();
  std::vector<Result> results(static_cast<std::size_t>(blocks.size()));
  for (std::size_t i = 0; i < static_cast<std::size_t>(shape.size()); ++i) {
    const Position p = positionOf(shape, i);
    std::int64_t block = 0;
    for (int d = 0; d < shape.rank(); ++d) {
      block = block * blocks[d] + p[static_cast<std::size_t>(d)] / (shape[d] / blocks[d]);
    }
    Result& r = results[static_cast<std::size_t>(block)];
    const std::uint32_t v = x[p];
    r.map = {31u * r.map.a, 31u * r.map.b + v};
    r.two = {7u * r.two.a, 7u * r.two.b + (v ^ y.repeated(p))};
    r.count += 1;
    r.odd = r.odd != ((v & 1u) != 0u);
  }
  return results;
}

void checkOne(sk::Device& device, std::uint32_t seed) {
  Dice dice(seed);
  const sk::Shape shape = randomShape(dice);
  const sk::Shape blocks = dice.coin() ? randomDivisor(dice, shape) : ones(shape.rank());
  sk::Shape second = shape;
  for (int d = 0; d < shape.rank(); ++d) second = second.with(d, dice.roll(0, 2) == 0 ? 1 : shape[d]);
  INFO("seed " << seed << ": " << sk::toString(shape) << " and " << sk::toString(second) << " to "
               << sk::toString(blocks));
  const auto at = [&](std::size_t i) { return valueAt<std::uint32_t>(static_cast<std::uint32_t>(i) + seed); };
  const HostArray<std::uint32_t> x(shape, at), y(second, [&](std::size_t i) { return at(i + 977); });
  Placed first(device, dice, x), other(device, dice, y);
  const std::vector<Result> expected = expectedOf(x, y, blocks);

  auto maps = device.stream<results::Affine>(blocks);
  auto twos = device.stream<folds::Affine>(blocks);
  auto counts = device.stream<int>(blocks);
  auto odds = device.stream<bool>(blocks);
  results::mixed(first.get(), maps, counts, odds);
  folds::shifted(7u, first.get(), other.get(), twos);
  const auto map = maps.read();
  const auto two = twos.read();
  const auto number = counts.read();
  const auto odd = odds.read();
  bool isRight = true;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Result& r = expected[i];
    isRight = isRight && map[i].a == r.map.a && map[i].b == r.map.b && number[i] == r.count &&
              (odd[i] != 0) == r.odd && two[i].a == r.two.a && two[i].b == r.two.b;
  }
  CHECK(isRight);
  if (blocks.size() != 1) return;
  const auto [value, n, parity] = results::mixed(first.get());
  CHECK((value.a == expected[0].map.a && value.b == expected[0].map.b && n == expected[0].count));
  const folds::Affine last = folds::shifted(7u, first.get(), other.get());
  CHECK((last.a == expected[0].two.a && last.b == expected[0].two.b && parity == expected[0].odd));
}

}  // namespace

// Each fold may need programs of its own on GL, whose compilation takes most of the time.
TEST_CASE("random folds") {
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    checkOne(run_tests::device("native"), seed);
    if (seed % 4 != 0) continue;
    const Layout& layout = someLayouts[seed / 4 % std::size(someLayouts)];
    checkOne(run_tests::device(layout.profile, layout.textureLimit), seed);
  }
}
