// SPDX-License-Identifier: MIT
//
// Promises: a view by strides, or in another shape, is used like a stream of its elements, on either side of a call and by
// the host, wherever they lie; what is between its elements keeps its values.
#include <numeric>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/view_model.hpp"
#include "views.sk.hpp"

namespace run_tests {
namespace {

/// A stream, a view of it and what the view has to be.
struct Case {
  sk::Shape shape;
  sk::Index steps, offsets;
  sk::Shape reshaped = {};  ///< of the strided view, if it has a rank
};

/// A case for each kind of address arithmetic: strides in each rank, of whole texels of packed elements or not, and each way
/// to reshape. GL devices take these alone where a full list on one of them proves the arithmetic.
const std::vector<Case>& sampleCases() {
  static const std::vector<Case> some = {
      {{7, 9}, {2, 2}, {1, 0}},
      {{5, 16}, {2, 4}, {0, 3}},
      {{1000}, {7}, {3}},
      {{4, 5, 6}, {2, 2, 3}, {1, 0, 2}},
      {{3, 4, 5, 4}, {2, 1, 2, 3}, {0, 1, 1, 0}},
      {{6, 8}, {1, 2}, {0, 1}, {24}},
      {{6, 8}, {1, 1}, {0, 0}, {3, 2, 8}},
      {{1200}, {3}, {1}, {20, 20}},
  };
  return some;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> list = sampleCases();
    list.insert(list.end(), {
                                {{6, 8}, {1, 2}, {0, 0}},
                                {{6, 8}, {1, 2}, {0, 1}},
                                {{6, 16}, {1, 2}, {0, 2}},
                                {{6, 16}, {2, 2}, {1, 3}},
                                {{5, 16}, {1, 4}, {0, 6}},
                                {{7, 8}, {3, 1}, {1, 0}},
                                {{6, 4}, {2, 2}, {0, 2}},
                                {{5, 12}, {3, 5}, {2, 1}},
                                {{9, 5}, {4, 1}, {0, 2}},
                                {{7, 300}, {2, 3}, {1, 2}},
                                {{31}, {2}, {0}},
                                {{6, 8}, {1, 1}, {0, 0}, {48}},
                                {{6, 8}, {1, 1}, {0, 0}, {4, 12}},
                                {{6, 8}, {2, 1}, {0, 0}, {3, 2, 4}},
                                {{6, 8}, {1, 8}, {0, 3}, {6}},
                                {{6, 8}, {6, 1}, {2, 0}, {8}},
                                {{6, 8}, {6, 2}, {2, 0}, {2, 2}},
                                {{96}, {1}, {0}, {8, 12}},
                                {{1200}, {1}, {0}, {30, 40}},
                                {{1200}, {1}, {0}, {10, 10, 12}},
                                {{1200}, {1}, {192}, {28, 36}},
                                {{5, 6, 7}, {1, 1, 1}, {0, 0, 0}, {30, 7}},
                                {{5, 6, 7}, {1, 1, 1}, {0, 0, 0}, {7, 30}},
                                {{1}, {1}, {0}, {1, 1, 1}},
                                {{3, 3}, {5, 5}, {1, 2}},
                            });
    return list;
  }();
  return all;
}

struct Viewed {
  sk::View<int> view;
  Model model;
};

Viewed viewOf(sk::Stream<int>& stream, const Case& what) {
  Viewed result{sk::stride(stream, what.steps, what.offsets),
                Model(what.shape).strided(what.steps, what.offsets)};
  if (what.reshaped.rank() > 0) {
    result.view = result.view.reshape(what.reshaped);
    result.model.shape = what.reshaped;
  }
  return result;
}

std::string nameOf(const Case& what) {
  return sk::toString(what.shape) + " by " + sk::toString(what.steps) + " from " +
         sk::toString(what.offsets) + (what.reshaped.rank() > 0 ? " as " + sk::toString(what.reshaped) : "");
}

/// Calls test(device, stream of 1, 2 ..., view, model) for each of the cases.
template <class Test>
void onViews(sk::Device& device, const std::vector<Case>& chosen, const Test& test) {
  for (const Case& what : chosen) {
    INFO(nameOf(what));
    auto stream = device.stream<int>(what.shape);
    stream.write(counted(what.shape.size()));
    const Viewed viewed = viewOf(stream, what);
    REQUIRE(viewed.view.shape() == viewed.model.shape);
    test(device, stream, viewed.view, viewed.model);
  }
}

/// Every case natively and in planes, and a sample of them on every other layout: for tests of the address arithmetic.
template <class Test>
void onEveryView(const Test& test) {
  onEveryLayout([&](sk::Device& one) { onViews(one, takesAllCases(one) ? cases() : sampleCases(), test); });
}

/// Every case natively, and a sample of them on a sample of the layouts: for tests of what else is done with views.
template <class Test>
void onSomeViews(const Test& test) {
  onSomeLayouts(
      [&](sk::Device& one) { onViews(one, &one == &device("native") ? cases() : sampleCases(), test); });
}

TEST_CASE("the host reads, writes and fills views") {
  onSomeViews([](sk::Device&, sk::Stream<int>& stream, sk::View<int> view, const Model& model) {
    std::vector<int> all = counted(stream.size());
    CHECK(view.read() == model.of(all));
    CHECK(view.readAsync().get() == model.of(all));
    const std::vector<int> written = counted(view.size(), -5000);
    view.write(written);
    model.put(written, all);
    CHECK(stream.read() == all);
    view.writeAsync(counted(view.size(), 7000));
    model.put(counted(view.size(), 7000), all);
    CHECK(stream.read() == all);
    view.fill(-3);
    model.put(std::vector<int>(model.numbers.size(), -3), all);
    CHECK(stream.read() == all);
  });
}

TEST_CASE("views are copied from and to") {
  onSomeViews([](sk::Device& device, sk::Stream<int>& stream, sk::View<int> view, const Model& model) {
    std::vector<int> all = counted(stream.size());
    auto dense = device.stream<int>(view.shape());
    view.copyTo(dense);
    CHECK(dense.read() == model.of(all));
    dense.write(counted(view.size(), -400));
    dense.copyTo(view);
    model.put(counted(view.size(), -400), all);
    CHECK(stream.read() == all);
    // the same elements of another stream
    auto other = device.stream<int>(stream.shape());
    other.fill(1);
    std::vector<int> others(all.size(), 1);
    for (const Case& what : cases()) {
      if (what.shape != stream.shape()) continue;
      const Viewed to = viewOf(other, what);
      if (to.view.shape() != view.shape()) continue;
      view.copyTo(to.view);
      to.model.put(model.of(all), others);
      CHECK(other.read() == others);
    }
  });
}

TEST_CASE("kernels read and write views") {
  onEveryView([](sk::Device& device, sk::Stream<int>& stream, sk::View<int> view, const Model& model) {
    const std::vector<int> before = counted(stream.size());
    std::vector<int> all = before;
    auto result = device.stream<int>(view.shape());
    views::plus(10, view, result);
    CHECK(result.read() == mapped(model.of(all), [](int x) { return x + 10; }));
    auto input = device.stream<int>(view.shape());
    input.write(counted(view.size(), 100));
    views::plus(5, input, view);
    model.put(counted(view.size(), 105), all);
    CHECK(stream.read() == all);
    // in place
    views::plus(1, view, view);
    model.put(counted(view.size(), 106), all);
    CHECK(stream.read() == all);
    views::numbered(view, view);
    int n = 0;
    model.put(mapped(model.of(all), [&](int x) { return x + 1000 * n++; }), all);
    CHECK(stream.read() == all);
    const std::vector<int> here = model.of(all);
    views::increment(7, input, view, result);
    CHECK(result.read() == counted(view.size(), 93));
    model.put(counted(view.size(), 107), all);
    CHECK(stream.read() == all);
  });
}

TEST_CASE("gathers of views end at their edges") {
  onEveryView([](sk::Device& device, sk::Stream<int>& stream, sk::View<int> view, const Model& model) {
    const std::vector<int> elements = model.of(counted(stream.size()));
    const sk::Shape& shape = view.shape();
    auto result = device.stream<int>(shape);
    std::vector<int> expected;
    if (shape.rank() == 2) {
      views::around(view, result);
      for (std::int64_t y = 0; y < shape[0]; ++y) {
        for (std::int64_t x = 0; x < shape[1]; ++x) {
          expected.push_back(2 * at(elements, shape, y, x + 1) + 3 * at(elements, shape, y - 1, x) +
                             at(elements, shape, 100, 0));
        }
      }
      CHECK(result.read() == expected);
    } else if (shape.rank() == 1) {
      const std::int64_t n = shape[0];
      const auto wrapped = [&](std::int64_t i) {
        return elements[static_cast<std::size_t>((i % n + n) % n)];
      };
      views::beside(view, result);
      for (std::int64_t x = 0; x < n; ++x) expected.push_back(wrapped(x + 1) - wrapped(x - 2));
      CHECK(result.read() == expected);
    } else if (shape.rank() == 3) {
      auto turned = device.stream<int>({shape[2], shape[1], shape[0]});
      views::turned(view, turned);
      for (std::int64_t z = 0; z < shape[2]; ++z) {
        for (std::int64_t y = 0; y < shape[1]; ++y) {
          for (std::int64_t x = 0; x < shape[0]; ++x) {
            expected.push_back(elements[static_cast<std::size_t>((x * shape[1] + y) * shape[2] + z)]);
          }
        }
      }
      CHECK(turned.read() == expected);
    }
  });
}

TEST_CASE("views are reduced and scanned, and hold the results") {
  onSomeViews([](sk::Device& device, sk::Stream<int>& stream, sk::View<int> view, const Model& model) {
    std::vector<int> all = counted(stream.size());
    const std::vector<int> elements = model.of(all);
    CHECK(views::sum(view) == std::accumulate(elements.begin(), elements.end(), 0));
    CHECK(views::last(view) == elements.back());
    const sk::Shape& shape = view.shape();
    auto lines = device.stream<int>(shape.with(shape.rank() - 1, 1));
    views::sum(view, lines);
    std::vector<int> sums;
    const auto length = static_cast<std::size_t>(shape[shape.rank() - 1]);
    for (std::size_t i = 0; i < elements.size(); i += length) {
      sums.push_back(std::accumulate(&elements[i], &elements[i] + length, 0));
    }
    CHECK(lines.read() == sums);
    // to a view, of blocks of two rows of its shape
    sk::Shape doubled = shape.with(0, 2 * shape[0]);
    auto pairs = device.stream<int>(doubled);
    pairs.fill(3);
    views::sum(pairs, view);
    model.put(std::vector<int>(elements.size(), 6), all);
    CHECK(stream.read() == all);
    views::prefix(view, view);
    int sum = 0;
    model.put(mapped(std::vector<int>(elements.size(), 6), [&](int x) { return sum += x; }), all);
    CHECK(stream.read() == all);
  });
}

TEST_CASE("views are scattered to, and their elements pushed") {
  const auto test = [](sk::Device& device, sk::Stream<int>& stream, sk::View<int> view, const Model& model) {
    std::vector<int> all = counted(stream.size());
    const std::vector<int> elements = model.of(all);
    auto odd = device.stream<int>({1});
    views::odd(view, odd);
    std::vector<int> pushed = elements;
    std::erase_if(pushed, [](int x) { return x % 2 == 0; });
    CHECK(odd.read() == pushed);
    if (view.shape().rank() == 2) {
      auto corner = device.stream<int>({1, 1});
      corner.fill(-9);
      views::scattered(corner, view);
      all[static_cast<std::size_t>(model.numbers[0])] = -9;
    } else if (view.shape().rank() == 1 && view.size() > 1) {
      auto four = device.stream<int>({4});
      four.fill(50);
      views::added(four, view);
      all[static_cast<std::size_t>(model.numbers[0])] += 100;
      all[static_cast<std::size_t>(model.numbers[1])] += 100;
    }
    CHECK(stream.read() == all);
  };
  onDrawnLayouts(
      [&](sk::Device& one) { onViews(one, &one == &device("native") ? cases() : sampleCases(), test); });
  // compute programs: a plane and a line
  for (const Case& what : {sampleCases()[0], sampleCases()[2]}) onViews(device("glsl430"), {what}, test);
}

}  // namespace
}  // namespace run_tests
