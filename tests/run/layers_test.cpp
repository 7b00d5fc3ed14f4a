// SPDX-License-Identifier: MIT
//
// Streams in layers against plain C++, on devices with textures of 16 x 16 texels: every way in which a stream is read,
// written, folded or pushed to. All results are exact.
#include "layers.sk.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;
using layers::Body;
using layers::Ends;
using layers::Six;

namespace {

constexpr std::int32_t limit = 16;

template <class Test>
void onLayers(const Test& test) {
  for (const std::string profile : {"glsl330", "essl300"}) {
    INFO("profile " << profile);
    test(device(profile, limit));
  }
}

const std::vector<sk::Shape> shapes = {{257}, {1021}, {4096}, {67, 41}, {300, 3}, {7, 11, 13}, {5, 6, 7, 8}};

HostArray<int> numbered(const sk::Shape& shape, std::uint32_t seed = 0) {
  return {shape, [&](std::size_t i) {
            return static_cast<int>(hashed(static_cast<std::uint32_t>(i) + seed) >> 12);
          }};
}

/// Pseudorandom indices below `count`; several elements may have the same.
std::vector<int> places(std::size_t elements, int count) {
  std::vector<int> to(elements);
  for (std::size_t i = 0; i < elements; ++i) {
    to[i] = static_cast<int>(hashed(static_cast<std::uint32_t>(i)) % static_cast<unsigned>(count));
  }
  return to;
}

}  // namespace

TEST_CASE("layers keep what is written to them, whole or in part") {
  onLayers([](sk::Device& device) {
    for (const sk::Shape& shape : shapes) {
      INFO("shape " << sk::toString(shape));
      HostArray<int> host = numbered(shape);
      auto stream = host.on(device);
      CHECK(stream.texture().layers > 1);
      CHECK(stream.read() == host.elements());
      sk::Index begin = sk::Index::origin(shape.rank());
      sk::Index end = begin;
      for (int d = 0; d < shape.rank(); ++d) {
        begin[d] = shape[d] / 4;
        end[d] = shape[d] - shape[d] / 5;
      }
      auto part = stream.domain(begin, end);
      const HostArray<int> inner = numbered(part.shape(), 99);
      part.write(inner.elements());
      CHECK(part.read() == inner.elements());
      for (std::size_t i = 0; i < inner.elements().size(); ++i) {
        host[inside(begin, positionOf(part.shape(), i))] = inner.elements()[i];
      }
      CHECK(stream.read() == host.elements());
    }
  });
}

TEST_CASE("indices go on from layer to layer, in a stream and in a view") {
  onLayers([](sk::Device& device) {
    for (const sk::Shape& shape : shapes) {
      INFO("shape " << sk::toString(shape));
      auto r = device.stream<int>(shape);
      auto at = device.stream<sk::int4>(shape);
      layers::number(r, at);
      CHECK(difference(r.read(), [](std::size_t i) { return static_cast<int>(i); }) == "");
      CHECK(difference(at.read(), [&](std::size_t i) {
              const Position p = positionOf(shape, i);
              sk::int4 index{};
              int* components[] = {&index.x, &index.y, &index.z, &index.w};
              for (int d = 0; d < shape.rank(); ++d) {
                *components[d] = static_cast<int>(p[static_cast<std::size_t>(shape.rank() - 1 - d)]);
              }
              return index;
            }) == "");
    }
    HostArray<int> host = numbered({30, 50});
    auto stream = host.on(device);
    auto at = device.stream<sk::int4>({20, 31});
    layers::number(stream.domain({5, 7}, {25, 38}), at);
    for (int i = 0; i < 20 * 31; ++i) host[{5 + i / 31, 7 + i % 31}] = i;
    CHECK(stream.read() == host.elements());
  });
}

TEST_CASE("inputs and gathers in layers, as they are, in views, and beside streams in one texture") {
  onLayers([](sk::Device& device) {
    const HostArray<int> a = numbered({40, 50}), row = numbered({1, 50}, 5), table = numbered(2000, 7);
    const auto looked = [&](int value) {
      const int n = value * 7 - 5;
      return table.elements()[static_cast<std::size_t>(((n % 2000) + 2000) % 2000)];
    };
    auto sa = a.on(device), srow = row.on(device), stable = table.on(device);
    auto sum = device.stream<int>({40, 50}), found = device.stream<int>({40, 50});
    layers::combine(sa, srow, stable, sum, found);
    CHECK(difference(sum.read(),
                     [&](std::size_t i) { return 3 * a.elements()[i] + row.elements()[i % 50]; }) == "");
    CHECK(difference(found.read(), [&](std::size_t i) { return looked(a.elements()[i]); }) == "");

    auto small = device.stream<int>({7, 9}), smallFound = device.stream<int>({7, 9});
    layers::combine(sa.domain({30, 3}, {37, 12}), sa.domain({1, 40}, {8, 49}), stable, small, smallFound);
    CHECK(difference(small.read(), [&](std::size_t i) {
            const Position p = positionOf({7, 9}, i);
            return 3 * a[{p[0] + 30, p[1] + 3}] + a[{p[0] + 1, p[1] + 40}];
          }) == "");

    layers::stencil(sa, sa);  // in place
    CHECK(difference(sa.read(), [&](std::size_t i) {
            const Position p = positionOf(a.shape(), i);
            const auto at = [&](std::int64_t y, std::int64_t x) {
              return y < 0 || y >= 40 || x < 0 || x >= 50 ? -1 : a[{y, x}];
            };
            return at(p[0], p[1] + 1) + 10 * at(p[0] - 1, p[1]) + 100 * at(p[0] + 2, p[1] - 70);
          }) == "");
  });
}

TEST_CASE("structs and iterators over layers") {
  onLayers([](sk::Device& device) {
    const sk::Shape shape{33, 21};
    std::vector<Body> bodies;
    for (int i = 0; i < 33 * 21; ++i) bodies.push_back({{i * 1.0f, i * 0.5f, -i * 1.0f}, i, i % 3 == 0});
    auto b = device.stream<Body>(shape), next = device.stream<Body>(shape);
    b.write(bodies);
    layers::step(b, b, next);
    const std::vector<Body> result = next.read();
    int wrong = 0;
    for (int i = 0; i < 33 * 21; ++i) {
      const auto mirrored = [](int p, int n) { return p < n ? p : 2 * n - 1 - p; };
      const auto j = static_cast<std::size_t>(mirrored(i / 21 + 1, 33) * 21 + mirrored(i % 21 + 3, 21));
      const Body& was = bodies[static_cast<std::size_t>(i)];
      const Body& is = result[static_cast<std::size_t>(i)];
      wrong += is.id != bodies[j].id || is.alive == was.alive ||
               is.place.x != was.place.x + bodies[j].place.x || is.place.z != was.place.z + bodies[j].place.z;
    }
    CHECK(wrong == 0);

    auto r = device.stream<int>(shape);
    auto q = device.stream<sk::float2>(shape);
    layers::ramps(sk::iter(5, 5 + 2 * 693), sk::iter(sk::float2{0, 0}, sk::float2{42, 33}), r, q);
    CHECK(difference(r.read(), [](std::size_t i) { return 5 + 2 * static_cast<int>(i); }) == "");
    CHECK(difference(q.read(), [](std::size_t i) {
            return sk::float2{static_cast<float>(2 * (i % 21)), static_cast<float>(i / 21)};
          }) == "");
  });
}

TEST_CASE("reduces over layers keep the order, to a value and to layers") {
  onLayers([](sk::Device& device) {
    for (const sk::Shape& shape : shapes) {
      INFO("shape " << sk::toString(shape));
      const HostArray<int> x = numbered(shape);
      const Ends ends = layers::ends(x.on(device));
      CHECK(ends.first == x.elements().front());
      CHECK(ends.last == x.elements().back());
      CHECK(ends.count == shape.size());
    }
    const HostArray<int> x = numbered({400, 12});
    auto rows = device.stream<Ends>({400, 1}), pairs = device.stream<Ends>({200, 6}),
         columns = device.stream<Ends>({1, 12});
    layers::ends(x.on(device), rows);
    layers::ends(x.on(device), pairs);
    layers::ends(x.on(device), columns);
    const auto isRight = [&](const std::vector<Ends>& result, int height, int width, int across) {
      for (int i = 0; i < static_cast<int>(result.size()); ++i) {
        const int y = i / across * height, left = i % across * width;
        const Ends& e = result[static_cast<std::size_t>(i)];
        if (e.first != x[{y, left}] || e.last != x[{y + height - 1, left + width - 1}]) return false;
        if (e.count != height * width) return false;
      }
      return true;
    };
    CHECK(isRight(rows.read(), 1, 12, 1));
    CHECK(isRight(pairs.read(), 2, 2, 6));
    CHECK(isRight(columns.read(), 400, 1, 12));
  });
}

TEST_CASE("pushes from layers and to layers, counted and not") {
  onLayers([](sk::Device& device) {
    for (const sk::Shape& shape : {sk::Shape{300}, sk::Shape{4099}, sk::Shape{31, 47}}) {
      INFO("shape " << sk::toString(shape));
      const HostArray<int> x(shape, [](std::size_t i) { return static_cast<int>(i * i % 101); });
      std::vector<int> some, most;
      for (const int value : x.elements()) {
        for (int k = 0; k < value % 3; ++k) some.push_back(10 * value + k);
        if (value % 5 != 0) most.push_back(value);
      }
      auto y = device.stream<int>({0}), z = device.stream<int>({0});
      layers::some(x.on(device), y);
      layers::most(x.on(device), z);
      CHECK(y.read() == some);
      CHECK(z.read() == most);
      auto again = device.stream<int>({0});
      layers::most(y, again);  // the output of one call is the input of the next
      std::erase_if(some, [](int value) { return value % 5 == 0; });
      CHECK(again.read() == some);
    }
  });
}

TEST_CASE("scatters from layers and to layers: stores, sums, extremes") {
  onLayers([](sk::Device& device) {
    for (const int target : {50, 700, 2000}) {
      INFO("to " << target);
      const HostArray<int> x(
          2999, [](std::size_t i) { return static_cast<int>(hashed(static_cast<std::uint32_t>(i))); });
      const std::vector<int> to = places(2999, target);
      auto sto = device.stream<int>(2999);
      sto.write(to);
      const auto size = static_cast<std::size_t>(target);
      std::vector<int> placed(size, -7), counted(size, 3), highest(size, -100);
      std::vector<float> added(size, 0.5f);
      auto sx = x.on(device);
      auto sf = device.stream<float>(2999);
      std::vector<float> floats(2999);
      for (std::size_t i = 0; i < 2999; ++i) floats[i] = static_cast<float>(i % 16);
      sf.write(floats);
      auto rp = device.stream<int>(target), rc = device.stream<int>(target), rh = device.stream<int>(target);
      auto ra = device.stream<float>(target);
      rp.write(placed), rc.write(counted), rh.write(highest), ra.write(added);
      for (std::size_t i = 0; i < 2999; ++i) {
        const auto at = static_cast<std::size_t>(to[i]);
        placed[at] = x.elements()[i];
        ++counted[at];
        highest[at] = std::max(highest[at], x.elements()[i]);
        added[at] += floats[i];
      }
      layers::place(sto, sx, rp);
      layers::count(sto, rc);
      layers::highest(sto, sx, rh);
      layers::add(sto, sf, ra);
      CHECK(rp.read() == placed);
      CHECK(rc.read() == counted);
      CHECK(rh.read() == highest);
      CHECK(ra.read() == added);
    }
  });
}

TEST_CASE("kernels of several passes over layers, whose inputs share array textures") {
  for (const std::string profile : {"glsl330", "essl300"}) {
    for (const std::string limits : {"guaranteed", "device"}) {
      INFO("profile " << profile << ", limits " << limits);
      sk::Device device({.profile = profile, .textureLimit = limit, .limits = limits});
      constexpr int count = 1500;
      std::vector<Six> x, y, z;
      for (int i = 0; i < count; ++i) {
        x.push_back({i, i + 1, i + 2, i + 3, i + 4, i + 5});
        y.push_back({2 * i, 3 * i, 4 * i, 5 * i, 6 * i, 7 * i});
      }
      for (int i = 0; i < 100; ++i) z.push_back({-i, -2 * i, -3 * i, -4 * i, -5 * i, -6 * i});
      auto sx = device.stream<Six>(count), sy = device.stream<Six>(count), sz = device.stream<Six>(100);
      auto r = device.stream<Six>(count), s = device.stream<Six>(count);
      sx.write(x), sy.write(y), sz.write(z);
      layers::many(sx, sy, sz, r, s);
      const auto gotR = r.read(), gotS = s.read();
      int wrong = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Six& other = z[std::min<std::size_t>(i + 1, 99)];
        wrong += gotR[i].a != x[i].a + y[i].a || gotR[i].b != x[i].b || gotR[i].f != x[i].f - other.f;
        wrong += gotS[i].a != other.a || gotS[i].b != other.b + x[i].c * y[i].d || gotS[i].e != y[i].e;
      }
      CHECK(wrong == 0);
    }
  }
}
