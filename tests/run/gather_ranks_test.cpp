// SPDX-License-Identifier: MIT
//
// Gathers of rank 3 and 4 against plain C++, in every layout. All results are exact.
#include <cmath>

#include "gather_ranks.sk.hpp"
#include "support/boundary_modes.hpp"
#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float3, sk::int3, sk::int4;

namespace {

/// The element at any position, slowest dimension first, as a boundary mode reads it.
int at(const HostArray<int>& a, Position p, Inside inside) {
  for (int d = 0; d < a.shape().rank(); ++d) {
    auto& i = p[static_cast<std::size_t>(d)];
    i = inside(i, a.shape()[d]);
    if (i < 0) return outsideValue;
  }
  return a[p];
}

HostArray<int> numbered(const sk::Shape& shape) {
  return HostArray<int>(shape, [](std::size_t i) { return static_cast<int>(3 * i + 1); });
}

const std::vector<int> rankIndices = {0,  1,  4,   5,    66,         67,         65536,          1 << 30,
                                      -1, -2, -66, -100, -(1 << 24), 2147483647, -2147483647 - 1};

/// The position of element i of the domain, plus an offset.
Position moved(const sk::Shape& domain, std::size_t i, const Position& offset) {
  Position p = positionOf(domain, i);
  for (std::size_t d = 0; d < p.size(); ++d) p[d] += offset[d];
  return p;
}

struct Mode {
  const char* name;
  Inside inside;
};

template <class Read, class Near, class Stencil>
void checkSpace(sk::Device& device, const Mode& mode, const Read& read, const Near& near,
                const Stencil& stencil) {
  std::vector<int3> triples;
  for (const int z : rankIndices) {
    for (const int y : rankIndices) {
      for (const int x : rankIndices) triples.push_back({x, y, z});
    }
  }
  const auto count = static_cast<std::int64_t>(triples.size());
  auto r = device.stream<int>({count}), s = device.stream<int>({count}), t = device.stream<int>({count});
  for (const sk::Shape& shape :
       {sk::Shape{1, 1, 1}, sk::Shape{2, 3, 5}, sk::Shape{5, 1, 67}, sk::Shape{67, 2, 3}}) {
    INFO(mode.name << ", shape " << sk::toString(shape));
    const auto a = numbered(shape);
    const auto stream = a.on(device);
    read(stream, streamOf<int3>(device, triples), r, s, t);
    const auto expected = [&](std::size_t k) {
      return at(a, {triples[k].z, triples[k].y, triples[k].x}, mode.inside);
    };
    CHECK(difference(r.read(), expected) == "");
    CHECK(difference(s.read(), expected) == "");
    CHECK(difference(t.read(), expected) == "");

    const sk::Shape cube{15, 15, 15};
    auto u = device.stream<int>(cube), v = device.stream<int>(cube);
    near(stream, streamOf<int3>(device, cube, triples), u, v);
    const auto offset = [&](std::size_t k) {
      const Position d{triples[k].z, triples[k].y, triples[k].x};
      return at(a, moved(cube, k, d), mode.inside);
    };
    CHECK(difference(u.read(), offset) == "");
    CHECK(difference(v.read(), offset) == "");

    // Offsets by one, over the gather's own shape and over a larger domain.
    for (const sk::Shape& domain : {shape, sk::Shape{9, 4, 70}}) {
      auto w = device.stream<int>(domain);
      stencil(stream, w);
      CHECK(difference(w.read(), [&](std::size_t k) {
              const auto by = [&](std::int64_t dx, std::int64_t dy, std::int64_t dz) {
                return at(a, moved(domain, k, {dz, dy, dx}), mode.inside);
              };
              return by(0, 0, 0) + 3 * by(1, 0, 0) + 5 * by(-1, 0, 0) + 7 * by(0, 1, 0) + 11 * by(0, -1, 0) +
                     13 * by(0, 0, 1) + 17 * by(1, 1, -1);
            }) == "");
    }
  }
}

template <class Read, class Near>
void checkTime(sk::Device& device, const Mode& mode, const Read& read, const Near& near) {
  std::vector<int4> places;
  for (std::uint32_t i = 0; i < 16 * 81; ++i) {
    const auto one = [&](std::uint32_t c) { return rankIndices[hashed(4 * i + c) % rankIndices.size()]; };
    places.push_back({one(0), one(1), one(2), one(3)});
  }
  const auto count = static_cast<std::int64_t>(places.size());
  auto r = device.stream<int>({count}), s = device.stream<int>({count}), t = device.stream<int>({count});
  for (const sk::Shape& shape : {sk::Shape{1, 1, 1, 1}, sk::Shape{2, 3, 4, 5}, sk::Shape{3, 1, 2, 66}}) {
    INFO(mode.name << ", shape " << sk::toString(shape));
    const auto a = numbered(shape);
    const auto stream = a.on(device);
    read(stream, streamOf<int4>(device, places), r, s, t);
    const auto expected = [&](std::size_t k) {
      return at(a, {places[k].w, places[k].z, places[k].y, places[k].x}, mode.inside);
    };
    CHECK(difference(r.read(), expected) == "");
    CHECK(difference(s.read(), expected) == "");
    CHECK(difference(t.read(), expected) == "");

    const sk::Shape domain{9, 4, 6, 6};
    auto u = device.stream<int>(domain), v = device.stream<int>(domain);
    near(stream, streamOf<int4>(device, domain, places), u, v);
    const auto offset = [&](std::size_t k) {
      const Position d{places[k].w, places[k].z, places[k].y, places[k].x};
      return at(a, moved(domain, k, d), mode.inside);
    };
    CHECK(difference(u.read(), offset) == "");
    CHECK(difference(v.read(), offset) == "");
  }
}

}  // namespace

TEST_CASE("gathers of rank 3 read any index, in every boundary mode") {
  using namespace gather_ranks;
  onSomeLayouts([](sk::Device& device) {
    checkSpace(device, {"wrap", wrapIndex}, space_wrap, space_near_wrap, space_stencil_wrap);
    if (!takesAllCases(device)) return;  // modes are text about rankIndices, not about layouts
    checkSpace(device, {"clamp", clampIndex}, space_clamp, space_near_clamp, space_stencil_clamp);
    checkSpace(device, {"mirror", mirrorIndex}, space_mirror, space_near_mirror, space_stencil_mirror);
    checkSpace(device, {"border", borderIndex}, space_border, space_near_border, space_stencil_border);
  });
}

TEST_CASE("gathers of rank 4 read any index, in every boundary mode") {
  using namespace gather_ranks;
  onSomeLayouts([](sk::Device& device) {
    checkTime(device, {"wrap", wrapIndex}, time_wrap, time_near_wrap);
    if (!takesAllCases(device)) return;  // modes are text about rankIndices, not about layouts
    checkTime(device, {"clamp", clampIndex}, time_clamp, time_near_clamp);
    checkTime(device, {"mirror", mirrorIndex}, time_mirror, time_near_mirror);
    checkTime(device, {"border", borderIndex}, time_border, time_near_border);
  });
}

TEST_CASE("a neighbour in a gather of higher rank than the domain's lies near index 0 of the others") {
  onSomeLayouts([](sk::Device& device) {
    const auto a = numbered({3, 4, 5});
    auto r = device.stream<int>({4, 5}), empty = device.stream<int>({0, 5});
    gather_ranks::space_stencil_wrap(a.on(device), r);
    gather_ranks::space_stencil_wrap(a.on(device), empty);
    CHECK(difference(r.read(), [&](std::size_t k) {
            const Position p = positionOf(r.shape(), k);
            const auto by = [&](std::int64_t dx, std::int64_t dy, std::int64_t dz) {
              return at(a, {dz, p[0] + dy, p[1] + dx}, wrapIndex);
            };
            return by(0, 0, 0) + 3 * by(1, 0, 0) + 5 * by(-1, 0, 0) + 7 * by(0, 1, 0) + 11 * by(0, -1, 0) +
                   13 * by(0, 0, 1) + 17 * by(1, 1, -1);
          }) == "");
  });
}

TEST_CASE("a gather of rank 3 may be a view, whose faces are then the boundary") {
  onEveryLayout([](sk::Device& device) {
    const auto whole = numbered({6, 9, 70});
    auto stream = whole.on(device);
    const sk::Index begin{1, 2, 3}, end{5, 9, 66};
    const auto part = stream.domain(begin, end);
    const HostArray<int> a(part.shape(),
                           [&](std::size_t i) { return whole[inside(begin, positionOf(part.shape(), i))]; });
    const auto check = [&](const auto& kernel, Inside mode) {
      auto r = device.stream<int>(part.shape());
      kernel(part, r);
      CHECK(difference(r.read(), [&](std::size_t k) {
              const auto by = [&](std::int64_t dx, std::int64_t dy, std::int64_t dz) {
                return at(a, moved(part.shape(), k, {dz, dy, dx}), mode);
              };
              return by(0, 0, 0) + 3 * by(1, 0, 0) + 5 * by(-1, 0, 0) + 7 * by(0, 1, 0) + 11 * by(0, -1, 0) +
                     13 * by(0, 0, 1) + 17 * by(1, 1, -1);
            }) == "");
    };
    check(gather_ranks::space_stencil_clamp, clampIndex);
    check(gather_ranks::space_stencil_wrap, wrapIndex);
    check(gather_ranks::space_stencil_mirror, mirrorIndex);
    check(gather_ranks::space_stencil_border, borderIndex);
    // In place, the kernel reads the old elements.
    gather_ranks::space_stencil_wrap(part, part);
    CHECK(stream.domain({0, 0, 0}, {1, 9, 70}).read() ==
          std::vector<int>(whole.elements().begin(), whole.elements().begin() + 630));
  });
}

TEST_CASE("gathers of rank 3 and 4 take float rankIndices, hold structs and know their extents") {
  using gather_ranks::Voxel;
  const sk::Shape shape{3, 4, 5};
  const HostArray<Voxel> a(shape, [](std::size_t i) {
    const int k = static_cast<int>(i);
    return Voxel{valueAt<float>(static_cast<std::uint32_t>(i)), {k, -k, 2 * k}};
  });
  const auto b = numbered({2, 3, 4, 5});
  const std::vector<float3> p = {{0, 0, 0},       {0.49f, 0.5f, 1.5f}, {-0.51f, 6.2f, 2.7f},
                                 {100, -8.5f, 3}, {4.4f, 3.4f, 2.4f},  {-1, -1, -1}};
  const auto nearest = [](float x) { return static_cast<std::int64_t>(std::floor(x + 0.5f)); };
  onSomeLayouts([&](sk::Device& device) {
    const auto count = static_cast<std::int64_t>(p.size());
    auto r = device.stream<Voxel>({count});
    auto s = device.stream<int>({count});
    auto t = device.stream<int4>({count});
    gather_ranks::kinds(a.on(device), b.on(device), streamOf<float3>(device, p), r, s, t);
    const auto voxels = r.read();
    const auto sums = s.read();
    for (std::size_t i = 0; i < p.size(); ++i) {
      const std::int64_t x = nearest(p[i].x), y = nearest(p[i].y), z = nearest(p[i].z);
      const Voxel& wanted = a[{wrapIndex(z, 3), wrapIndex(y, 4), wrapIndex(x, 5)}];
      CHECK(voxels[i].density == wanted.density);
      CHECK(voxels[i].at == wanted.at);
      CHECK(sums[i] == at(b, {2, z, y, x}, mirrorIndex) +
                           at(b, {0, z, static_cast<std::int64_t>(p[i].y), x}, mirrorIndex));
    }
    CHECK(difference(t.read(), [](std::size_t) { return int4{5005, 4004, 3003, 2001}; }) == "");
  });
}

TEST_CASE("helpers and kernels take gathers of rank 3, with the mode that the outermost kernel declares") {
  const sk::Shape shape{4, 5, 6};
  const auto a = numbered(shape), b = numbered({3, 3, 3});
  onSomeLayouts([&](sk::Device& device) {
    auto r = device.stream<int>(shape);
    gather_ranks::handed(a.on(device), b.on(device), a.on(device), r);
    CHECK(difference(r.read(), [&](std::size_t k) {
            const Position p = positionOf(shape, k);
            const auto corners = [&](const HostArray<int>& g, Inside mode) {
              return at(g, p, mode) + 10 * at(g, {p[0] + 1, p[1] + 1, p[2] + 1}, mode);
            };
            const Position next{p[0] + 1, p[1], p[2]};
            const int one = (p[2] & 1) == 0 ? corners(a, wrapIndex) + at(b, next, borderIndex)
                                            : corners(b, borderIndex) + at(a, next, wrapIndex);
            return one + at(b, next, borderIndex) + a.elements()[k];
          }) == "");
  });
}
