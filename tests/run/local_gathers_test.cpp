// SPDX-License-Identifier: MIT
//
// Promises: stencils over parts of a whole that ask where they are compute the bits of one call over the whole, for boxes inside
// it and at its ends in every boundary mode, in one to three dimensions, in texels of one element or four, whether the domain
// begins with the gather or inside of it. So do their folds.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "local_gathers.sk.hpp"
#include "sk/placed.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using namespace local_gathers;

constexpr std::int64_t depth = 2;  ///< how far the kernels read

/// A box, and a part that holds it.
struct Part {
  sk::Box box;
  sk::Placement at;
  sk::Shape shape;
};

/// The box with `margin` elements around it; 2 halo elements more than the box has in x keep rows a multiple of four if both
/// are. `isClipped`: not beyond the ends of the whole.
Part partOf(const sk::Shape& whole, const sk::Box& box, const sk::Index& margin, bool isClipped) {
  Part part{box, {box.begin, whole}, whole};
  for (int d = 0; d < whole.rank(); ++d) {
    std::int64_t begin = box.begin[d] - margin[d], end = box.end[d] + margin[d];
    if (isClipped || margin[d] == 0) {
      begin = std::max<std::int64_t>(begin, 0);
      end = std::min(end, whole[d]);
    }
    part.at.origin[d] = begin;
    part.shape = part.shape.with(d, end - begin);
  }
  return part;
}

/// Calls visit(number, index) for the elements of a part, row-major.
template <class Visit>
void forEachIn(const Part& part, const Visit& visit) {
  for (std::int64_t number = 0; number < part.shape.size(); ++number) {
    sk::Index index = part.at.origin;
    std::int64_t rest = number;
    for (int d = part.shape.rank() - 1; d >= 0; --d) {
      index[d] += rest % part.shape[d];
      rest /= part.shape[d];
    }
    visit(number, index);
  }
}

std::size_t numberIn(const sk::Shape& whole, const sk::Index& index) {
  std::int64_t number = 0;
  for (int d = 0; d < whole.rank(); ++d)
    number = number * whole[d] + (index[d] % whole[d] + whole[d]) % whole[d];
  return static_cast<std::size_t>(number);
}

template <class T>
std::vector<T> valuesOf(const sk::Shape& shape, int seed) {
  std::vector<T> values(static_cast<std::size_t>(shape.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<T>((static_cast<int>(i) * 37 + 11 + seed) % 101);
  return values;
}

/// A stream that holds a part of a whole: beyond its ends, the elements of the other end, or others unless `wraps`.
template <class T>
struct Held {
  Held(sk::Device& device, const Part& given) : part(given), stream(device.stream<T>(given.shape)) {}
  Held(sk::Device& device, const Part& given, const std::vector<T>& all, bool wraps) : Held(device, given) {
    std::vector<T> held(static_cast<std::size_t>(part.shape.size()));
    forEachIn(part, [&](std::int64_t number, const sk::Index& index) {
      bool isInside = true;
      for (int d = 0; d < index.rank(); ++d)
        isInside = isInside && index[d] >= 0 && index[d] < part.at.whole[d];
      held[static_cast<std::size_t>(number)] =
          isInside || wraps ? all[numberIn(part.at.whole, index)] : static_cast<T>(-9999);
    });
    stream.write(held);
  }
  auto placed() { return sk::placed(stream, part.at); }

  Part part;
  sk::Stream<T> stream;
};

std::int64_t wordOf(float x) { return static_cast<std::int64_t>(x); }  // all results are integers
std::int64_t wordOf(int x) { return x; }
std::int64_t wordOf(const sk::int4& x) {
  return x.x + 1000 * (x.y + 1000 * (x.z + std::int64_t{1000} * x.w));
}

/// Whether the box in a part has the elements of the whole.
template <class T>
bool isSame(Held<T>& got, const sk::Box& box, const std::vector<sk::HostElement<T>>& all) {
  const auto elements = got.stream.read();
  bool same = true;
  forEachIn(got.part, [&](std::int64_t number, const sk::Index& index) {
    for (int d = 0; d < index.rank(); ++d) {
      if (index[d] < box.begin[d] || index[d] >= box.end[d]) return;
    }
    same = same && wordOf(elements[static_cast<std::size_t>(number)]) ==
                       wordOf(all[numberIn(got.part.at.whole, index)]);
  });
  return same;
}

std::string textOf(const Part& gather, const Part& output) {
  return sk::toString(gather.box.begin) + " to " + sk::toString(gather.box.end) + " of " +
         sk::toString(gather.at.whole) + ", gathers from " + sk::toString(gather.at.origin) + " on, shape " +
         sk::toString(gather.shape) + ", outputs from " + sk::toString(output.at.origin) + " on";
}

/// Calls visit(gather, output) for boxes inside the whole and at its ends, with halos of `margin` that end with the whole or not, and with outputs that
/// hold the same or the box alone.
template <class Visit>
void forEachPart(const sk::Shape& whole, const std::vector<sk::Box>& boxes, const sk::Index& margin,
                 bool wraps, const Visit& visit) {
  for (const sk::Box& box : boxes) {
    for (const bool isClipped : {false, true}) {
      if (wraps && isClipped) continue;
      const Part gather = partOf(whole, box, margin, isClipped);
      for (const Part& output : {gather, partOf(whole, box, sk::Index::origin(whole.rank()), true)}) {
        INFO(textOf(gather, output));
        visit(gather, output);
      }
    }
  }
}

template <class Row, class Grid, class Space, class Product, class Slope>
struct Mode {
  int number;
  const char* name;
  bool wraps;
  Row row;
  Grid grid;
  Space space;
  Product product;
  Slope slope;
};
template <class... K>
Mode(int, const char*, bool, K...) -> Mode<K...>;

template <class Visit>
void forEachMode(const Visit& visit) {
  visit(Mode{0, "clamp", false, row_clamp, grid_clamp, space_clamp, product_clamp, slope_clamp});
  visit(Mode{1, "wrap", true, row_wrap, grid_wrap, space_wrap, product_wrap, slope_wrap});
  visit(Mode{2, "mirror", false, row_mirror, grid_mirror, space_mirror, product_mirror, slope_mirror});
  visit(Mode{3, "border", false, row_border, grid_border, space_border, product_border, slope_border});
}

/// GL devices take every other combination of mode and shape.
bool takes(const sk::Device& device, int number) {
  return &device == &run_tests::device("native") || number % 2 == 0;
}

/// Boxes of whole rows, and blocks of which all ends in x are multiples of four.
std::vector<sk::Box> boxesOf(const sk::Shape& whole) {
  const std::int64_t h = whole[0], w = whole[1];
  return {{{0, 0}, {5, w}}, {{5, 0}, {h - 4, w}}, {{h - 4, 0}, {h, w}}, {{0, 0}, {h, w}},
          {{4, 0}, {9, 8}}, {{4, 8}, {9, 16}},    {{3, 16}, {h, w}}};
}

/// Halos of two rows above and below, and of two or four elements on the left and right: texels hold one element or four.
const std::vector<sk::Index> margins = {{2, 0}, {2, 2}, {2, 4}};

TEST_CASE("stencils in a row that ask where they are") {
  onSomeLayouts([](sk::Device& device) {
    forEachMode([&](const auto& mode) {
      INFO(mode.name);
      for (const sk::Shape& whole : {sk::Shape{2048}, sk::Shape{51}}) {
        if (!takes(device, mode.number + (whole[0] == 51 ? 1 : 0))) continue;
        const std::int64_t n = whole[0];
        const auto along = sk::iter(0.0F, static_cast<float>(n));
        const std::vector<float> us = valuesOf<float>(whole, 0), xs = valuesOf<float>(whole, 5);
        auto u = device.stream<float>(whole), x = device.stream<float>(whole),
             r = device.stream<float>(whole);
        u.write(us);
        x.write(xs);
        mode.row(along, u, x, r);
        const auto expected = r.read();
        for (const std::int64_t margin : {std::int64_t{2}, std::int64_t{4}}) {
          forEachPart(whole, {{{0}, {16}}, {{16}, {36}}, {{36}, {n}}}, {margin}, mode.wraps,
                      [&](const Part& gather, const Part& output) {
                        Held<float> ownU(device, gather, us, mode.wraps),
                            ownX(device, output, xs, mode.wraps), result(device, output);
                        mode.row.with({.box = gather.box})(along, ownU.placed(), ownX.placed(),
                                                           result.placed());
                        CHECK(isSame(result, gather.box, expected));
                      });
        }
      }
    });
  });
}

TEST_CASE("stencils in a plane that ask where they are, by drawing and by dispatches") {
  const auto test = [](sk::Device& device) {
    forEachMode([&](const auto& mode) {
      INFO(mode.name);
      for (const sk::Shape& whole : {sk::Shape{14, 24}, sk::Shape{13, 22}}) {
        if (!takes(device, mode.number + (whole[1] == 22 ? 1 : 0))) continue;
        const auto along = sk::iter(sk::float2{0, 0},
                                    sk::float2{static_cast<float>(whole[1]), static_cast<float>(whole[0])});
        const std::vector<float> us = valuesOf<float>(whole, 0), vs = valuesOf<float>(whole, 7),
                                 xs = valuesOf<float>(whole, 5);
        auto u = device.stream<float>(whole), v = device.stream<float>(whole),
             x = device.stream<float>(whole), r = device.stream<float>(whole),
             s = device.stream<float>(whole);
        u.write(us);
        v.write(vs);
        x.write(xs);
        mode.grid(along, u, v, x, r, s);
        const auto expectedR = r.read(), expectedS = s.read();
        for (const sk::Index& margin : margins) {
          const bool isOfRows = margin[1] == 0;
          std::vector<sk::Box> boxes = boxesOf(whole);
          if (isOfRows) boxes.resize(4);
          forEachPart(whole, boxes, margin, mode.wraps, [&](const Part& gather, const Part& output) {
            Held<float> ownU(device, gather, us, mode.wraps), ownV(device, gather, vs, mode.wraps),
                ownX(device, output, xs, mode.wraps), resultR(device, output), resultS(device, output);
            mode.grid.with({.box = gather.box})(along, ownU.placed(), ownV.placed(), ownX.placed(),
                                                resultR.placed(), resultS.placed());
            CHECK(isSame(resultR, gather.box, expectedR));
            CHECK(isSame(resultS, gather.box, expectedS));
          });
        }
      }
    });
  };
  onEveryTarget(test);
  test(run_tests::device("glsl330", smallLimits[1]));
}

TEST_CASE("stencils in space that ask where they are") {
  onSomeLayouts([](sk::Device& device) {
    forEachMode([&](const auto& mode) {
      INFO(mode.name);
      const sk::Shape whole{7, 6, 12};
      const std::vector<int> values = valuesOf<int>(whole, 0);
      auto a = device.stream<int>(whole), r = device.stream<int>(whole);
      auto where = device.stream<sk::int4>(whole);
      a.write(values);
      mode.space(a, r, where);
      const auto expected = r.read();
      const auto places = where.read();
      const std::vector<sk::Box> boxes = {
          {{0, 0, 0}, {3, 6, 12}}, {{3, 0, 0}, {5, 6, 12}}, {{4, 2, 4}, {7, 6, 8}}};
      forEachPart(whole, boxes, {depth, depth, depth}, mode.wraps,
                  [&](const Part& gather, const Part& output) {
                    Held<int> own(device, gather, values, mode.wraps), result(device, output);
                    Held<sk::int4> at(device, output);
                    mode.space.with({.box = gather.box})(own.placed(), result.placed(), at.placed());
                    CHECK(isSame(result, gather.box, expected));
                    CHECK(isSame(at, gather.box, places));
                  });
    });
  });
}

TEST_CASE("folds of stencils that ask where they are") {
  const auto test = [](sk::Device& device) {
    forEachMode([&](const auto& mode) {
      INFO(mode.name);
      const bool folds = takes(device, mode.number), reduces = takes(device, mode.number + 1);
      const sk::Shape whole{14, 24};
      const std::vector<float> us = valuesOf<float>(whole, 0), xs = valuesOf<float>(whole, 5);
      auto u = device.stream<float>(whole), x = device.stream<float>(whole), r = device.stream<float>(whole);
      auto t = device.scalar<float>();
      u.write(us);
      x.write(xs);
      mode.product(u, x, r, t);
      const auto expected = r.read();
      for (const sk::Index& margin : {margins[0], margins[2]}) {
        std::vector<sk::Box> boxes = boxesOf(whole);
        if (margin[1] == 0) boxes.resize(4);
        forEachPart(whole, boxes, margin, mode.wraps, [&](const Part& gather, const Part& output) {
          Held<float> ownU(device, gather, us, mode.wraps), ownX(device, output, xs, mode.wraps),
              result(device, output);
          if (folds) {
            mode.product.with({.box = gather.box})(ownU.placed(), ownX.placed(), result.placed(), t);
            CHECK(isSame(result, gather.box, expected));
            float product = 0;  // sums of integers below 2^24 are exact
            forEachIn(partOf(whole, gather.box, {0, 0}, true), [&](std::int64_t, const sk::Index& index) {
              product += expected[numberIn(whole, index)] * xs[numberIn(whole, index)];
            });
            CHECK(t.read() == product);
          }
          if (reduces)
            CHECK(mode.slope.with({.box = gather.box})(ownU.placed(), ownX.placed()) ==
                  mode.slope.with({.box = gather.box})(u, x));
        });
      }
    });
  };
  test(run_tests::device("native"));
  test(run_tests::device("glsl430"));
}

}  // namespace
}  // namespace run_tests
