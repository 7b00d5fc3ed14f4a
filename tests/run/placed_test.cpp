// SPDX-License-Identifier: MIT
//
// Promises: kernels over parts of a whole compute, together, the bits of one call over the whole: with stencils, computed
// gathers and samples in every boundary mode, indices, extents, iterators, inputs that repeat, several outputs and folds.
// Wholes may have more elements than any device holds. Parts that hold too little are refused.
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "placed.sk.hpp"
#include "sk/placed.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using namespace placed_parts;
using Catch::Matchers::Contains;
using Random = std::mt19937;

int below(Random& random, int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }

/// A part of a whole: the elements that it computes, and what it holds.
struct Part {
  sk::Box box;
  sk::Placement at;
  sk::Shape shape;  ///< of what it holds
};

/// Divides the whole into parts at random places. Each holds a halo of `depth`, which without `wraps` may end where the
/// whole ends.
std::vector<Part> partsOf(const sk::Shape& whole, std::int64_t depth, bool wraps, Random& random) {
  std::vector<sk::Box> boxes = {{sk::Index::origin(whole.rank()), sk::Index::origin(whole.rank())}};
  for (int d = 0; d < whole.rank(); ++d) {
    std::vector<sk::Box> next;
    const auto n = static_cast<int>(whole[d]);
    const int cut = below(random, n);
    for (sk::Box box : boxes) {
      const std::vector<int> ends = cut == 0 ? std::vector{0, n} : std::vector{0, cut, n};
      for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        box.begin[d] = ends[k];
        box.end[d] = ends[k + 1];
        next.push_back(box);
      }
    }
    boxes = next;
  }
  std::vector<Part> parts;
  for (const sk::Box& box : boxes) {
    Part part{box, {sk::Index::origin(whole.rank()), whole}, whole};
    const bool isClipped = !wraps && below(random, 2) == 0;
    for (int d = 0; d < whole.rank(); ++d) {
      std::int64_t begin = box.begin[d] - depth, end = box.end[d] + depth + below(random, 2);
      if (isClipped) {
        begin = std::max<std::int64_t>(begin, 0);
        end = std::min(end, whole[d]);
      }
      part.at.origin[d] = begin;
      part.shape = part.shape.with(d, end - begin);
    }
    parts.push_back(part);
  }
  return parts;
}

/// Calls visit(number in the box, index) for the elements of a box, row-major.
template <class Visit>
void forEachIn(const sk::Index& begin, const sk::Shape& shape, const Visit& visit) {
  for (std::int64_t number = 0; number < shape.size(); ++number) {
    sk::Index index = begin;
    std::int64_t rest = number;
    for (int d = shape.rank() - 1; d >= 0; --d) {
      index[d] += rest % shape[d];
      rest /= shape[d];
    }
    visit(number, index);
  }
}

std::int64_t numberIn(const sk::Shape& whole, const sk::Index& index) {
  std::int64_t number = 0;
  for (int d = 0; d < whole.rank(); ++d)
    number = number * whole[d] + (index[d] % whole[d] + whole[d]) % whole[d];
  return number;
}

/// The elements of a whole that a part holds. Beyond its ends are those of the other end, or `garbage` unless `wraps`.
template <class T>
std::vector<T> heldOf(const std::vector<T>& all, const Part& part, bool wraps, const T& garbage) {
  std::vector<T> held(static_cast<std::size_t>(part.shape.size()));
  forEachIn(part.at.origin, part.shape, [&](std::int64_t number, const sk::Index& index) {
    bool isInside = true;
    for (int d = 0; d < index.rank(); ++d)
      isInside = isInside && index[d] >= 0 && index[d] < part.at.whole[d];
    held[static_cast<std::size_t>(number)] =
        isInside || wraps ? all[static_cast<std::size_t>(numberIn(part.at.whole, index))] : garbage;
  });
  return held;
}

sk::Shape shapeOf(const sk::Box& box) {
  sk::Shape shape = box.begin.rank() == 1   ? sk::Shape{0}
                    : box.begin.rank() == 2 ? sk::Shape{0, 0}
                                            : sk::Shape{0, 0, 0};
  for (int d = 0; d < shape.rank(); ++d) shape = shape.with(d, box.end[d] - box.begin[d]);
  return shape;
}

/// A stream that holds a part, and its place.
template <class T>
struct Held {
  Held(sk::Device& device, const Part& part) : stream(device.stream<T>(part.shape)), part(part) {}
  auto placed() { return sk::placed(stream, part.at); }

  sk::Stream<T> stream;
  Part part;
};

/// A part of a stream of results: the box that it computes, in a stream that is a little larger.
template <class T>
struct Result {
  Result(sk::Device& device, const Part& given) : part(given) {
    for (int d = 0; d < part.shape.rank(); ++d) {
      part.at.origin[d] = part.box.begin[d] - d;
      part.shape = part.shape.with(d, part.box.end[d] - part.box.begin[d] + d + 1);
    }
    stream = device.stream<T>(part.shape);
  }
  auto placed() { return sk::placed(stream, part.at); }
  std::vector<sk::HostElement<T>> read() {
    sk::Index begin = part.box.begin, end = part.box.end;
    for (int d = 0; d < begin.rank(); ++d) {
      begin[d] -= part.at.origin[d];
      end[d] -= part.at.origin[d];
    }
    return stream.domain(begin, end).read();
  }

  Part part;
  sk::Stream<T> stream;
};

bool isSame(float a, float b) { return a == b; }
bool isSame(int a, int b) { return a == b; }
bool isSame(const sk::int4& a, const sk::int4& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}
bool isSame(const sk::float2& a, const sk::float2& b) { return a.x == b.x && a.y == b.y; }
bool isSame(const Cell& a, const Cell& b) {
  return a.amount == b.amount && a.at.x == b.at.x && a.at.y == b.at.y;
}

/// Whether a part's results are those of the whole.
template <class T>
bool isPartOf(const std::vector<T>& got, const Part& part, const std::vector<T>& whole) {
  bool isSamePart = true;
  forEachIn(part.box.begin, shapeOf(part.box), [&](std::int64_t number, const sk::Index& index) {
    isSamePart = isSamePart && isSame(got[static_cast<std::size_t>(number)],
                                      whole[static_cast<std::size_t>(numberIn(part.at.whole, index))]);
  });
  return isSamePart;
}

template <class T>
T valueOf(std::int64_t i) {
  return static_cast<T>((i * 37 + 11) % 101);
}
template <>
Cell valueOf(std::int64_t i) {
  return {static_cast<float>((i * 37 + 11) % 101), {static_cast<int>(i), static_cast<int>(i % 7)}};
}
template <class T>
std::vector<T> valuesOf(const sk::Shape& shape) {
  std::vector<T> values(static_cast<std::size_t>(shape.size()));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = valueOf<T>(static_cast<std::int64_t>(i));
  return values;
}

std::string textOf(const Part& part) {
  return sk::toString(part.at.whole) + ", box " + sk::toString(part.box.begin) + " to " +
         sk::toString(part.box.end) + ", held from " + sk::toString(part.at.origin) + " on, shape " +
         sk::toString(part.shape);
}

/// Compares run(box, gather, result) for the whole with the same for its parts. `more` are given for each part.
template <class U, class R, class Run>
void comparePartsOf(sk::Device& device, const sk::Shape& shape, bool wraps, Random& random, const U& garbage,
                    const Run& run) {
  const std::vector<U> values = valuesOf<U>(shape);
  auto u = device.stream<U>(shape);
  auto r = device.stream<R>(shape);
  u.write(values);
  run(sk::Box{}, Part{{}, {sk::Index::origin(shape.rank()), shape}, shape}, u, r);
  const auto expected = r.read();
  for (const Part& part : partsOf(shape, 3, wraps, random)) {
    Held<U> held(device, part);
    Result<R> result(device, part);
    held.stream.write(heldOf(values, part, wraps, garbage));
    run(part.box, part, held.placed(), result.placed());
    INFO(textOf(part));
    CHECK(isPartOf(result.read(), part, expected));
  }
}

/// Kernels in one boundary mode.
template <class Line, class Stencil, class Space, class Anywhere, class Sampled, class Looped>
struct Mode {
  int number;
  const char* name;
  bool wraps;
  Line line;
  Stencil stencil;
  Space space;
  Anywhere anywhere;
  Sampled sampled;
  Looped looped;
};
template <class... K>
Mode(int, const char*, bool, K...) -> Mode<K...>;

template <class Visit>
void forEachMode(const Visit& visit) {
  visit(Mode{0, "clamp", false, line_clamp, stencil_clamp, space_clamp, anywhere_clamp, sampled_clamp,
             looped_clamp});
  visit(Mode{1, "wrap", true, line_wrap, stencil_wrap, space_wrap, anywhere_wrap, sampled_wrap, looped_wrap});
  visit(Mode{2, "mirror", false, line_mirror, stencil_mirror, space_mirror, anywhere_mirror, sampled_mirror,
             looped_mirror});
  visit(Mode{3, "border", false, line_border, stencil_border, space_border, anywhere_border, sampled_border,
             looped_border});
}

/// GL devices take every other combination of mode and kernel.
bool takes(const sk::Device& device, int number) {
  return &device == &run_tests::device("native") || number % 2 == 1;
}

TEST_CASE("stencils over parts of a whole give the bits of one call over all of it") {
  onSomeLayouts([](sk::Device& device) {
    Random random(7);
    const bool isNative = &device == &run_tests::device("native");
    forEachMode([&](const auto& mode) {
      INFO(mode.name);
      for (int repeat = isNative ? 4 : 1; repeat > 0; --repeat) {
        if (takes(device, mode.number)) {
          comparePartsOf<float, float>(device, {isNative ? 30 + below(random, 200) : 41}, mode.wraps, random,
                                       NAN, [&](const sk::Box& box, const Part&, auto&& u, auto&& r) {
                                         mode.line.with({.box = box})(u, r);
                                       });
          comparePartsOf<int, int>(device, {4 + below(random, 4), 5, 6 + below(random, 20)}, mode.wraps,
                                   random, -99999, [&](const sk::Box& box, const Part&, auto&& u, auto&& r) {
                                     mode.space.with({.box = box})(u, r);
                                   });
        }
        if (takes(device, mode.number + 1)) {
          comparePartsOf<float, float>(device, {5 + below(random, 40), isNative ? 6 + below(random, 90) : 24},
                                       mode.wraps, random, NAN,
                                       [&](const sk::Box& box, const Part&, auto&& u, auto&& r) {
                                         mode.stencil.with({.box = box})(u, r);
                                       });
        }
      }
    });
  });
}

/// The part of per-element data that a box of the whole needs.
template <class T>
std::vector<T> cutOut(const std::vector<T>& all, const Part& part) {
  std::vector<T> own;
  forEachIn(part.box.begin, shapeOf(part.box), [&](std::int64_t, const sk::Index& index) {
    own.push_back(all[static_cast<std::size_t>(numberIn(part.at.whole, index))]);
  });
  return own;
}

TEST_CASE("computed gathers and samples in parts give the bits of one call over all of it") {
  onEveryTarget([](sk::Device& device) {
    Random random(11);
    const sk::Shape shape{19, 23};
    std::vector<sk::int2> by(static_cast<std::size_t>(shape.size()));
    for (sk::int2& one : by) {
      one = {below(random, 7) - 3, below(random, 7) - 3};
      if (below(random, 9) == 0) one = {2000000000, -2000000000};  // not read
    }
    auto all = device.stream<sk::int2>(shape);
    all.write(by);
    auto weight = device.stream<float>({7});
    weight.write(valuesOf<float>({7}));
    const auto withBy = [&](const Part& part, const auto& call) {
      if (part.box.isWhole()) return call(all);
      auto own = device.stream<sk::int2>(shapeOf(part.box));
      own.write(cutOut(by, part));
      call(sk::placed(own, {.origin = part.box.begin, .whole = part.at.whole}));
    };
    forEachMode([&](const auto& mode) {
      INFO(mode.name);
      comparePartsOf<float, float>(
          device, shape, mode.wraps, random, NAN,
          [&](const sk::Box& box, const Part& part, auto&& u, auto&& r) {
            withBy(part, [&](const auto& d) { mode.anywhere.with({.box = box})(u, d, r); });
          });
      if (takes(device, mode.number)) {
        comparePartsOf<float, float>(
            device, shape, mode.wraps, random, NAN,
            [&](const sk::Box& box, const Part& part, auto&& u, auto&& r) {
              withBy(part, [&](const auto& d) { mode.anywhere.with({.box = box})(u, d, r); });
            });
        comparePartsOf<float, float>(device, shape, mode.wraps, random, NAN,
                                     [&](const sk::Box& box, const Part&, auto&& u, auto&& r) {
                                       mode.looped.with({.box = box})(3, u, weight, r);
                                     });
      }
      if (takes(device, mode.number + 1)) {
        comparePartsOf<float, float>(
            device, shape, mode.wraps, random, NAN,
            [&](const sk::Box& box, const Part& part, auto&& u, auto&& r) {
              withBy(part, [&](const auto& d) { mode.sampled.with({.box = box})(u, d, r); });
            });
      }
    });
    comparePartsOf<Cell, Cell>(device, shape, true, random, Cell{},
                               [&](const sk::Box& box, const Part& part, auto&& u, auto&& r) {
                                 withBy(part, [&](const auto& d) { cells.with({.box = box})(u, d, r); });
                               });
  });
}

TEST_CASE("indices, extents and neighbors are those of a whole with more elements than a device holds") {
  onSomeLayouts([](sk::Device& device) {
    const sk::Shape whole{(1 << 16) + 3, (1 << 17) + 5};  // 2^33 and more
    for (const sk::Index& begin : {sk::Index{0, 0}, sk::Index{65530, 131060}, sk::Index{40000, 77777}}) {
      INFO(sk::toString(begin));
      const sk::Box box{begin, {begin[0] + 9, begin[1] + 17}};
      const sk::Index origin{begin[0] - 1, begin[1] - 1};
      const sk::Shape held{11, 19}, own{9, 17};
      auto u = device.stream<sk::int4>(held);
      auto x = device.stream<float>(own);
      auto at = device.stream<sk::int4>(own), extent = device.stream<sk::int4>(own),
           around = device.stream<sk::int4>(own);
      std::vector<sk::int4> values;
      forEachIn(origin, held, [&](std::int64_t, const sk::Index& index) {
        const auto column = static_cast<int>((index[1] + whole[1]) % whole[1]);
        const auto row = static_cast<int>((index[0] + whole[0]) % whole[0]);
        values.push_back({column, row, 1, 2});
      });
      u.write(values);
      x.fill(3);
      const sk::Placement place{begin, whole};
      where.with({.box = box})(sk::placed(x, place), sk::placed(u, {origin, whole}), sk::placed(at, place),
                               sk::placed(extent, place), sk::placed(around, place));
      const std::vector<sk::int4> gotAt = at.read(), gotExtent = extent.read(), gotAround = around.read();
      bool areSame = true;
      forEachIn(begin, own, [&](std::int64_t number, const sk::Index& index) {
        const auto i = static_cast<std::size_t>(number);
        const auto column = static_cast<int>(index[1]), row = static_cast<int>(index[0]);
        const auto left = static_cast<int>((index[1] + whole[1] - 1) % whole[1]);
        const auto down = static_cast<int>((index[0] + 1) % whole[0]);
        areSame = areSame && isSame(gotAt[i], {column, row, 0, 0}) &&
                  isSame(gotExtent[i], {static_cast<int>(whole[1]) + 1000, static_cast<int>(whole[0]) + 1000,
                                        1 + 1000, 1 + 1000}) &&
                  isSame(gotAround[i], {left + 300, down + 300, 301, 302});
      });
      CHECK(areSame);
    }
  });
}

TEST_CASE("computed gathers find elements whose numbers in the whole exceed 32 bits") {
  sk::Device& device = run_tests::device("native");
  const sk::Shape whole{(1 << 16) + 3, (1 << 17) + 5}, held{9, 40000};
  const sk::Index origin{65525, 50000};
  const sk::Box box{{65528, 50010}, {65530, 50110}};
  std::vector<float> values(static_cast<std::size_t>(held.size()));
  const auto valueAt = [](std::int64_t y, std::int64_t x) { return static_cast<float>((7 * y + x) % 1009); };
  forEachIn(origin, held, [&](std::int64_t number, const sk::Index& index) {
    values[static_cast<std::size_t>(number)] = valueAt(index[0], index[1]);
  });
  Random random(3);
  std::vector<sk::int2> by(200);
  for (sk::int2& one : by) one = {below(random, 7) - 3, below(random, 7) - 3};
  auto u = device.stream<float>(held), r = device.stream<float>({2, 100});
  auto d = device.stream<sk::int2>({2, 100});
  u.write(values);
  d.write(by);
  const sk::Placement own{box.begin, whole};
  forEachMode([&](const auto& mode) {
    INFO(mode.name);
    mode.anywhere.with({.box = box})(sk::placed(u, {origin, whole}), sk::placed(d, own), sk::placed(r, own));
    const std::vector<float> got = r.read();
    bool areSame = true;
    forEachIn(box.begin, {2, 100}, [&](std::int64_t number, const sk::Index& index) {
      const auto i = static_cast<std::size_t>(number);
      areSame = areSame && got[i] == valueAt(index[0] + by[i].y, index[1] + by[i].x);
    });
    CHECK(areSame);
  });
}

TEST_CASE("iterators, inputs that repeat and several outputs keep to the whole's indices") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape shape{13, 22};
    const auto along = sk::iter(0.0F, 286.0F);
    const auto place = sk::iter(sk::float2{0, 0}, sk::float2{44, 13});
    const std::vector<float> values = valuesOf<float>(shape), rows = valuesOf<float>({1, 22});
    auto x = device.stream<float>(shape), row = device.stream<float>({1, 22}),
         r = device.stream<float>(shape);
    auto s = device.stream<sk::float2>(shape);
    x.write(values);
    row.write(rows);
    ramps(along, place, x, row, r, s);
    Random random(5);
    for (const Part& part : partsOf(shape, 2, false, random)) {
      INFO(textOf(part));
      Held<float> own(device, part);
      own.stream.write(heldOf(values, part, false, NAN));
      const Part ofRow{{{0, part.box.begin[1]}, {1, part.box.end[1]}},
                       {{0, part.at.origin[1]}, {1, 22}},
                       {1, part.shape[1]}};
      Held<float> held(device, ofRow);
      held.stream.write(heldOf(rows, ofRow, false, NAN));
      Result<float> first(device, part);
      Result<sk::float2> second(device, part);
      ramps.with({.box = part.box})(along, place, own.placed(), held.placed(), first.placed(),
                                    second.placed());
      CHECK(isPartOf(first.read(), part, r.read()));
      CHECK(isPartOf(second.read(), part, s.read()));
    }
  });
}

TEST_CASE("kernels in several passes compute parts") {
  sk::Device limited({.profile = "essl300", .limits = "guaranteed"});
  for (sk::Device* device : {&run_tests::device("native"), &limited}) {
    const sk::Shape shape{11, 14};
    auto u = device->stream<float>(shape);
    u.write(valuesOf<float>(shape));
    std::vector<sk::Stream<float>> whole;
    for (int k = 0; k < 5; ++k) whole.push_back(device->stream<float>(shape));
    many(u, whole[0], whole[1], whole[2], whole[3], whole[4]);
    Random random(9);
    for (const Part& part : partsOf(shape, 1, false, random)) {
      Held<float> held(*device, part);
      held.stream.write(heldOf(valuesOf<float>(shape), part, false, NAN));
      std::vector<Result<float>> r;
      for (int k = 0; k < 5; ++k) r.emplace_back(*device, part);
      many.with({.box = part.box})(held.placed(), r[0].placed(), r[1].placed(), r[2].placed(), r[3].placed(),
                                   r[4].placed());
      for (std::size_t k = 0; k < 5; ++k) CHECK(isPartOf(r[k].read(), part, whole[k].read()));
    }
  }
}

TEST_CASE("reductions and folded outputs fold the box of a placed stream") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape held{8, 20};
    auto x = device.stream<float>(held), r = device.stream<float>({4, 16}),
         table = device.stream<float>({103});
    x.write(valuesOf<float>(held));
    table.write(valuesOf<float>({103}));
    const sk::Placement place{{100, 1000}, {4000, 5000}};
    const sk::Box box{{102, 1003}, {106, 1019}};
    const auto inner = x.domain({2, 3}, {6, 19});
    CHECK(total.with({.box = box})(sk::placed(x, place)) == total(inner));
    const auto around = table.domain({1}, {103});
    CHECK(looked_up.with({.box = box})(sk::placed(x, place), sk::placed(table, {{-1}, {102}})) ==
          looked_up(inner, around));
    auto t = device.scalar<float>();
    twice.with({.box = box})(sk::placed(x, place), sk::placed(r, {box.begin, place.whole}), t);
    CHECK(t.read() == total(inner));
    std::vector<float> doubled = inner.read();
    for (float& value : doubled) value *= 2;
    CHECK(r.read() == doubled);
  });
}

TEST_CASE("recorded calls with placed streams repeat, and read what they write as it was") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape whole{40, 60};
    auto u = device.stream<float>({12, 18}), v = device.stream<float>({12, 18});
    u.write(valuesOf<float>({12, 18}));
    u.copyTo(v);
    const sk::Placement place{{10, 20}, whole};
    const sk::Box box{{13, 23}, {19, 35}};
    const auto step = stencil_wrap.with({.box = box});
    sk::Loop loop = device.record([&] { step(sk::placed(u, place), sk::placed(u, place)); });
    loop.repeat(2);
    step(sk::placed(v, place), sk::placed(v, place));
    step(sk::placed(v, place), sk::placed(v, place));
    CHECK(u.read() == v.read());
    CHECK(u.read() != valuesOf<float>({12, 18}));
  });
}

TEST_CASE("a part may be every second element of what holds it") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape held{12, 18};
    const sk::Placement place{{10, 20}, {40, 60}};
    auto u = device.stream<float>(held), r = device.stream<float>(held), s = device.stream<float>(held);
    auto apart = device.stream<float>({12, 36});
    u.write(valuesOf<float>(held));
    apart.fill(-1000);
    u.copyTo(sk::stride(apart, {1, 2}));
    r.fill(0);
    s.fill(0);
    const auto step = stencil_wrap.with({.box = sk::Box{{13, 23}, {19, 35}}});
    step(sk::placed(u, place), sk::placed(r, place));
    step(sk::placed(sk::stride(apart, {1, 2}), place), sk::placed(s, place));
    CHECK(s.read() == r.read());
    auto by = device.stream<sk::int2>(held);
    by.fill({2, -1});
    const auto jump = anywhere_wrap.with({.box = sk::Box{{13, 23}, {19, 35}}});
    jump(sk::placed(u, place), sk::placed(by, place), sk::placed(r, place));
    jump(sk::placed(sk::stride(apart, {1, 2}), place), sk::placed(by, place), sk::placed(s, place));
    CHECK(s.read() == r.read());
  });
}

TEST_CASE("a call does not test a promised halo unless SK_CHECK asks for it") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape held{12, 18};
    const sk::Placement place{{10, 20}, {40, 60}};
    auto u = device.stream<float>(held), r = device.stream<float>(held);
    auto by = device.stream<sk::int2>(held);
    u.write(valuesOf<float>(held));
    by.fill({4, 0});  // farther than promised, but held
    const auto jump = anywhere_wrap.with({.box = sk::Box{{14, 24}, {17, 33}}});
    CHECK(errorOf([&] { jump(sk::placed(u, place), sk::placed(by, place), sk::placed(r, place)); }) ==
          "no error");
  });
}

TEST_CASE("parts that hold too little, and calls that have no parts, are refused") {
  sk::Device& device = run_tests::device("native");
  auto u = device.stream<float>({8, 12}), r = device.stream<float>({8, 12});
  auto line = device.stream<float>({16}), others = device.stream<float>({16});
  auto s = device.stream<sk::float2>({8, 12});
  auto at = device.stream<int>({16});
  auto c = device.stream<Cell>({8, 12}), d = device.stream<Cell>({8, 12});
  const sk::Placement place{{10, 20}, {100, 200}};
  const sk::Box box{{13, 23}, {15, 29}};
  const auto pu = sk::placed(u, place), pr = sk::placed(r, place);
  CHECK(errorOf([&] { stencil_clamp.with({.box = box})(pu, pr); }) == "no error");
  CHECK_THAT(
      errorOf([&] { stencil_clamp(pu, pr); }),
      Contains(
          "'r' holds the elements {10, 20} to {18, 32} of a whole of shape {100, 200}, but the call needs "
          "{0, 0} to {100, 200}; give a box"));
  CHECK_THAT(errorOf([&] { stencil_clamp.with({.box = {{12, 23}, {15, 29}}})(pu, pr); }),
             Contains("'u' is read from 3 before to 1 after the elements of the box {12, 23} to {15, 29}, so "
                      "from index 9 "
                      "to 16 (exclusive) along y, but it holds 10 to 18 of 100; give it a deeper halo"));
  CHECK_THAT(errorOf([&] { stencil_wrap.with({.box = {{13, 23}, {15, 31}}})(pu, pr); }), Contains("along x"));
  CHECK_THAT(errorOf([&] { stencil_clamp.with({.box = {{90, 23}, {115, 29}}})(pu, pr); }),
             Contains("is not inside the domain, which has shape {100, 200}"));
  CHECK_THAT(errorOf([&] {
               ramps.with({.box = box})(sk::iter(0.0F, 1.0F), sk::iter(sk::float2{}, sk::float2{1, 1}), u, pu,
                                        pr, sk::placed(s, place));
             }),
             Contains("ramps: 'x' has shape {8, 12}, but the output 'r' has {100, 200}"));
  const sk::Box part{{3}, {5}};
  const sk::Placement ofLine{{2}, {1000}};
  CHECK_THAT(
      errorOf([&] {
        computed.with({.box = part})(sk::placed(line, ofLine), sk::placed(at, ofLine),
                                     sk::placed(others, ofLine));
      }),
      Contains(
          "computed: how far 'u' is read along x is not known, and it holds only indices 2 to 18 (exclusive) "
          "of 1000; promise a distance with [[halo(n)]]"));
  CHECK_THAT(errorOf([&] { keep(line, sk::placed(others, ofLine), others); }),
             Contains("keep: it pushes or scatters"));
  CHECK_THAT(errorOf([&] { prefix(sk::placed(line, ofLine), others); }),
             Contains("prefix: a scan takes no box and no placed"));
  CHECK_THAT(errorOf([&] { total(pu); }), Contains("total: 'x' holds the elements {10, 20} to {18, 32}"));
  CHECK_THAT(errorOf([&] { total(u, sk::placed(line, ofLine)); }), Contains("total: 't' is a placed stream"));
  CHECK_THAT(errorOf([&] {
               scaled.with({.box = part})(1.0F, sk::stretch(sk::placed(line, ofLine)),
                                          sk::placed(others, ofLine));
             }),
             Contains("scaled: 'x' is a placed stream, but only element inputs that are neither stretched"));
  CHECK_THAT(errorOf([&] { sk::placed(u, {{1, 2, 3}, {100, 200}}); }),
             Contains("as many dimensions as the part"));
  CHECK_THAT(errorOf([&] { sk::placed(u, {{100, 20}, {100, 200}}); }), Contains("has no element of a whole"));
  CHECK_THAT(errorOf([&] { sk::placed(u, {{-8, 20}, {100, 200}}); }), Contains("has no element of a whole"));
  CHECK_THAT(errorOf([&] { sk::placed(line, {{0}, {std::int64_t{1} << 33}}); }),
             Contains("has an extent above 1073741823, where indices end"));
}

}  // namespace
}  // namespace run_tests
