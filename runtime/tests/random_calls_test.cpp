// SPDX-License-Identifier: MIT
//
// Random calls on random boxes of random streams, in place and across layouts, against loops over host memory: a call reads
// only the values from before it, and changes nothing but its outputs.
#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

/// Two outputs from an element, a repeated element, a wrapped neighbour and the index.
const TestKernel& shuffle(int rank) {
  const auto parameters = [](int gatherRank) {
    return std::vector<program::Parameter>{
        uniform<std::int32_t>("k"), input<std::int32_t>("x"),
        input<std::int32_t>("y"),   gather<std::int32_t>("g", gatherRank, program::Boundary::Wrap),
        output<std::int32_t>("r"),  output<std::int32_t>("s")};
  };
  static const TestKernel plane("shuffle",
                                "void shuffle(int k, int x, int y, out int r, out int s) {\n"
                                "  r = 3 * x + y + k;\n"
                                "  s = sk_near_g(ivec2(1, -2)) - x + sk_index().x + 10 * sk_index().y;\n}\n",
                                parameters(2));
  static const TestKernel box(
      "shuffle",
      "void shuffle(int k, int x, int y, out int r, out int s) {\n"
      "  r = 3 * x + y + k;\n"
      "  s = sk_near_g(ivec3(1, -2, 3)) - x + sk_index().x + 10 * sk_index().y + 100 * sk_index().z;\n}\n",
      parameters(3));
  return rank == 2 ? plane : box;
}

/// The offset of the neighbour in `shuffle`, rows first.
std::vector<std::int64_t> reachOf(int rank) {
  return rank == 2 ? std::vector<std::int64_t>{-2, 1} : std::vector<std::int64_t>{3, -2, 1};
}
/// The factors of the index in `shuffle`, rows first.
std::vector<std::int64_t> scaleOf(int rank) {
  return rank == 2 ? std::vector<std::int64_t>{10, 1} : std::vector<std::int64_t>{100, 10, 1};
}

struct HostStream {
  Shape shape;
  std::vector<std::int32_t> values;
};

struct Box {
  std::size_t stream;
  Index begin;
  Shape shape;
};

/// The element at an index relative to the box.
std::int32_t& elementAt(std::vector<HostStream>& streams, const Box& box, const Index& index) {
  HostStream& stream = streams[box.stream];
  std::int64_t number = 0;
  for (int d = 0; d < box.shape.rank(); ++d) {
    number = number * stream.shape[d] + box.begin[d] + index[d];
  }
  return stream.values[static_cast<std::size_t>(number)];
}

Index indexOf(std::int64_t number, const Shape& shape) {
  Index index = Index::origin(shape.rank());
  for (int d = shape.rank() - 1; d >= 0; --d) {
    index[d] = number % shape[d];
    number /= shape[d];
  }
  return index;
}

class Game {
 public:
  Game(const std::string& profile, unsigned seed, const std::vector<Shape>& shapes)
      : device_({.profile = profile, .textureLimit = 64}), random_(seed), rank_(shapes[0].rank()) {
    for (const Shape& shape : shapes) {
      HostStream host{shape, std::vector<std::int32_t>(static_cast<std::size_t>(shape.size()))};
      for (std::int32_t& value : host.values) {
        value = between(-1000, 1000);
      }
      streams_.push_back(device_.stream<std::int32_t>(shape));
      streams_.back().write(host.values);
      hosts_.push_back(host);
    }
  }

  void round() {
    const Box r = anyBox();
    const Box s = boxOf(r.shape);
    if (overlap(r, s)) {
      return;
    }
    const Box x = boxOf(r.shape);
    Shape repeated = r.shape;
    for (int d = 0; d < rank_; ++d) {
      repeated = between(0, 3) == 0 ? repeated.with(d, 1) : repeated;
    }
    const Box y = boxOf(repeated);
    const Box g = anyBox();
    const std::int32_t k = between(-9, 9);
    shuffle(rank_)(k, view(x), view(y), view(g), view(r), view(s));
    runOnHost(k, x, y, g, r, s);
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      REQUIRE(streams_[i].read() == hosts_[i].values);
    }
  }

 private:
  std::int32_t between(std::int64_t least, std::int64_t most) {
    return static_cast<std::int32_t>(std::uniform_int_distribution<std::int64_t>(least, most)(random_));
  }
  std::size_t anyStream() {
    return static_cast<std::size_t>(between(0, static_cast<std::int64_t>(hosts_.size()) - 1));
  }

  Box anyBox() {
    const std::size_t stream = anyStream();
    Shape shape = hosts_[stream].shape;
    Index begin = Index::origin(rank_);
    const bool isWhole = between(0, 3) == 0;
    for (int d = 0; d < rank_ && !isWhole; ++d) {
      begin[d] = between(0, shape[d] - 1);
      shape = shape.with(d, between(1, shape[d] - begin[d]));
    }
    return {stream, begin, shape};
  }

  /// A box of this shape in a random stream that is large enough.
  Box boxOf(const Shape& shape) {
    for (;;) {
      const std::size_t stream = anyStream();
      const Shape& all = hosts_[stream].shape;
      bool fits = true;
      Index begin = Index::origin(rank_);
      for (int d = 0; d < rank_; ++d) {
        fits = fits && all[d] >= shape[d];
        begin[d] = fits ? between(0, all[d] - shape[d]) : 0;
      }
      if (fits) {
        return {stream, begin, shape};
      }
    }
  }

  bool overlap(const Box& a, const Box& b) const {
    bool overlaps = a.stream == b.stream;
    for (int d = 0; d < rank_; ++d) {
      overlaps = overlaps && a.begin[d] < b.begin[d] + b.shape[d] && b.begin[d] < a.begin[d] + a.shape[d];
    }
    return overlaps;
  }

  View<std::int32_t> view(const Box& box) {
    Index end = box.begin;
    for (int d = 0; d < rank_; ++d) {
      end[d] += box.shape[d];
    }
    return streams_[box.stream].domain(box.begin, end);
  }

  // Sums wrap around, as on the device.
  void runOnHost(std::int32_t k, const Box& x, const Box& y, const Box& g, const Box& r, const Box& s) {
    std::vector<HostStream> before = hosts_;
    for (std::int64_t number = 0; number < r.shape.size(); ++number) {
      const Index index = indexOf(number, r.shape);
      Index repeated = index;
      Index neighbour = index;
      std::int64_t scaled = 0;
      for (int d = 0; d < rank_; ++d) {
        const auto axis = static_cast<std::size_t>(d);
        repeated[d] = std::min(index[d], y.shape[d] - 1);
        neighbour[d] = ((index[d] + reachOf(rank_)[axis]) % g.shape[d] + g.shape[d]) % g.shape[d];
        scaled += scaleOf(rank_)[axis] * index[d];
      }
      const auto here = static_cast<std::uint32_t>(elementAt(before, x, index));
      const auto other = static_cast<std::uint32_t>(elementAt(before, y, repeated));
      const auto near = static_cast<std::uint32_t>(elementAt(before, g, neighbour));
      elementAt(hosts_, r, index) =
          static_cast<std::int32_t>(3 * here + other + static_cast<std::uint32_t>(k));
      elementAt(hosts_, s, index) =
          static_cast<std::int32_t>(near - here + static_cast<std::uint32_t>(scaled));
    }
  }

  Device device_;
  std::mt19937 random_;
  int rank_;
  std::vector<Stream<std::int32_t>> streams_;
  std::vector<HostStream> hosts_;
};

}  // namespace

TEST_CASE("random calls on random boxes do what the same loops do") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto seed = GENERATE(1u, 2u);
  const auto shapes = GENERATE(
      std::vector<Shape>{Shape(5, 6, 7), Shape(5, 6, 7), Shape(8, 9, 10), Shape(3, 12, 13), Shape(1, 1, 20)},
      std::vector<Shape>{Shape(20, 30), Shape(20, 30), Shape(12, 70), Shape(70, 12), Shape(40, 50),
                         Shape(1, 64)});
  Game game(profile, seed, shapes);
  for (int i = 0; i < 80; ++i) {
    INFO("seed " << seed << ", round " << i);
    game.round();
  }
}
