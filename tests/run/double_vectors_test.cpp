// SPDX-License-Identifier: MIT
//
// Vectors, structs, arrays, uniforms, gathers, reduces, variable and scatter outputs of doubles, in every representation. Values are
// small multiples of 1/256, so that sums and products are exact even in pairs of floats; other tests state their bound.
#include "doubles.sk.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "support/double_configs.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

std::vector<double> smallDoubles(std::size_t count, std::uint32_t seed) {
  std::vector<double> list;
  for (const float f : values<float>(static_cast<std::int64_t>(count), seed)) list.push_back(f);
  return list;
}

template <class T>
std::vector<T> vectorsOf(std::size_t count, std::uint32_t seed) {
  constexpr std::size_t width = sizeof(T) / sizeof(double);
  const std::vector<double> all = smallDoubles(count * width, seed);
  std::vector<T> list(count);
  std::memcpy(list.data(), all.data(), all.size() * sizeof(double));
  return list;
}

constexpr std::size_t count = 257;
constexpr auto extent = static_cast<std::int64_t>(count);

}  // namespace

TEST_CASE("swizzles and components of vectors of doubles") {
  const auto v = vectorsOf<sk::double4>(count, 1);
  std::vector<int> n(count);
  std::iota(n.begin(), n.end(), 0);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<sk::double4>({extent});
    auto s = device.stream<sk::double3>({extent});
    swizzles(streamOf<sk::double4>(device, v), streamOf<int>(device, n), r, s);
    const auto actual = r.read();
    const auto others = s.read();
    for (std::size_t i = 0; i < count; ++i) {
      double w[4] = {v[i].w, v[i].z, v[i].y, v[i].x};
      w[0] = v[i].y * 2;
      w[2] = v[i].w * 2;
      w[1] += w[n[i] & 3];
      w[n[i] & 3] *= 0.5;
      std::swap(w[1], w[3]);
      w[(n[i] + 1) & 3] += 0.25;
      w[2] += 1;
      w[2] -= 1;
      w[1] -= 1;
      INFO(i);
      CHECK((actual[i] == sk::double4{w[0], w[1], w[2], w[3]}));
      const double t[3] = {w[0] + 1 - n[i], w[1] + 1 - 2, v[i].x + 1 - 0};
      CHECK((others[i] == sk::double3{t[2], t[1], t[0] + 1}));
    }
  });
}

TEST_CASE("masks choose among doubles") {
  auto a = vectorsOf<sk::double3>(count, 2);
  const auto b = vectorsOf<sk::double3>(count, 3);
  for (std::size_t i = 0; i < count; i += 3) a[i].y = b[i].y;
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    auto r = device.stream<sk::double3>({extent});
    auto counts = device.stream<int>({extent});
    auto some = device.stream<bool>({extent});
    chosen(streamOf<sk::double3>(device, a), streamOf<sk::double3>(device, b), r, counts, some);
    const auto actual = r.read();
    const auto actualCounts = counts.read();
    const auto actualSome = some.read();
    const auto one = [](double x, double y) { return x == y ? 0.1 : x < y ? x : y; };
    for (std::size_t i = 0; i < count; ++i) {
      INFO(i);
      const double error = config.isNative() ? 0 : 0.1 * 0x1p-47;
      CHECK(std::fabs(actual[i].x - one(a[i].x, b[i].x)) <= error);
      CHECK(std::fabs(actual[i].y - one(a[i].y, b[i].y)) <= error);
      CHECK(std::fabs(actual[i].z - one(a[i].z, b[i].z)) <= error);
      const bool less[] = {a[i].x < b[i].x, a[i].y < b[i].y, a[i].z < b[i].z};
      CHECK(actualCounts[i] == -int{less[0]} - int{less[1]});
      CHECK((actualSome[i] != 0) == !(less[0] && less[1] && less[2]));
    }
  });
}

TEST_CASE("geometry of doubles") {
  const auto a = vectorsOf<sk::double3>(count, 4), b = vectorsOf<sk::double3>(count, 5);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<sk::double4>({extent});
    auto c = device.stream<sk::double3>({extent});
    geometry(streamOf<sk::double3>(device, a), streamOf<sk::double3>(device, b), r, c);
    const auto actual = r.read();
    const auto crosses = c.read();
    for (std::size_t i = 0; i < count; ++i) {
      const auto [x, y, z] = a[i];
      const auto [u, v, w] = b[i];
      INFO(i);
      CHECK(actual[i].x == x * u + y * v + z * w);
      const double length = std::sqrt(x * x + y * y + z * z);
      const double distance = std::sqrt((x - u) * (x - u) + (y - v) * (y - v) + (z - w) * (z - w));
      CHECK(std::fabs(actual[i].y - length) <= length * 0x1p-45);
      CHECK(std::fabs(actual[i].z - distance) <= distance * 0x1p-45);
      CHECK(std::fabs(actual[i].w - 1) <= 0x1p-43);
      CHECK((crosses[i] == sk::double3{y * w - z * v, z * u - x * w, x * v - y * u}));
    }
  });
}

TEST_CASE("an index outside a vector of doubles takes the nearest component") {
  const std::vector<int> indices = {-2147483647 - 1, -5, -1, 0, 1, 2, 3, 4, 2147483647};
  const std::vector<sk::double3> a(indices.size(), sk::double3{1, 2, 4});
  const auto n = static_cast<std::int64_t>(indices.size());
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto read = device.stream<sk::double2>({n}), known = device.stream<sk::double2>({n});
    auto written = device.stream<sk::double3>({n}), changed = device.stream<sk::double3>({n});
    outside(streamOf<sk::double3>(device, a), streamOf<int>(device, indices), read, written, changed, known);
    const auto reads = read.read(), knowns = known.read();
    const auto writes = written.read(), changes = changed.read();
    for (std::size_t i = 0; i < indices.size(); ++i) {
      INFO(indices[i]);
      const auto at = static_cast<std::size_t>(std::clamp(indices[i], 0, 2));
      const std::size_t unsignedAt = indices[i] < 0 ? 2 : at;
      double wanted[3] = {1, 2, 4};
      CHECK(reads[i].x == wanted[at]);
      CHECK(reads[i].y == (unsignedAt == 0 ? 2 : 1));
      wanted[at] = 0.5;
      CHECK(writes[i] == sk::double3{wanted[0], wanted[1], wanted[2]});
      double sums[3] = {1, 2, 4};
      sums[unsignedAt] += 0.25;
      CHECK(changes[i] == sk::double3{sums[0], sums[1], sums[2]});
      CHECK(knowns[i] == sk::double2{5, 4});
    }
  });
}

TEST_CASE("lengths and directions of vectors whose squares overflow or vanish") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  std::vector<double> scales = {1,       0x1p-20, 0x1p20,  0x1p-50, 0x1p50,
                                0x1p-80, 0x1p80,  0x1p100, 0x1p-98, 0x1p123};
  const std::size_t ofPairs = scales.size();
  scales.insert(scales.end(),
                {0x1p300, 0x1p-300, 0x1p600, 0x1p-600, 0x1p1000, 0x1p-1000, 0x1p1021, 0x1p-1020});
  const std::size_t ofGl = scales.size();
  scales.insert(scales.end(), {0x1p-1030, 0x1p-1074});
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    const std::size_t tried = config.profile == "native" ? scales.size() : config.isNative() ? ofGl : ofPairs;
    std::vector<sk::double2> a;
    std::vector<sk::double3> b;
    std::vector<sk::double4> c;
    for (std::size_t i = 0; i < tried; ++i) {
      const double s = scales[i];
      a.push_back({3 * s, -4 * s});
      b.push_back({-s, 2 * s, -2 * s});
      c.push_back({s, -s, s, s});
    }
    a.insert(a.end(), {{0, -0.0}, {inf, 1}, {NAN, -inf}, {NAN, 1}});
    b.insert(b.end(), {{0, 0, 0}, {1, -inf, 2}, {-inf, 1, NAN}, {1, 2, NAN}});
    c.insert(c.end(), {{0, 0, 0, 0}, {1, 1, 1, inf}, {inf, NAN, 0, 0}, {NAN, NAN, NAN, NAN}});
    const auto n = static_cast<std::int64_t>(a.size());
    auto r = device.stream<sk::double4>({n}), w = device.stream<sk::double4>({n});
    auto u = device.stream<sk::double2>({n});
    auto v = device.stream<sk::double3>({n});
    lengths(streamOf<sk::double2>(device, a), streamOf<sk::double3>(device, b),
            streamOf<sk::double4>(device, c), r, u, v, w);
    const auto length = r.read(), fours = w.read();
    const auto twos = u.read();
    const auto threes = v.read();
    const double bound = static_cast<double>(precisionOf(config)) * 4;
    const auto isNear = [&](double got, double wanted) {
      return std::fabs(got - wanted) <= bound * std::fabs(wanted) + 0x1p-1074;
    };
    for (std::size_t i = 0; i < tried; ++i) {
      INFO(scales[i]);
      CHECK(isNear(length[i].x, 5 * scales[i]));
      CHECK(isNear(length[i].y, 3 * scales[i]));
      CHECK(isNear(length[i].z, 2 * scales[i]));
      CHECK(isNear(length[i].w, std::sqrt(5.0) * scales[i]));
      CHECK((isNear(twos[i].x, 0.6) && isNear(twos[i].y, -0.8)));
      CHECK((isNear(threes[i].x, -1 / 3.0) && isNear(threes[i].y, 2 / 3.0) && isNear(threes[i].z, -2 / 3.0)));
      CHECK((isNear(fours[i].x, 0.5) && isNear(fours[i].y, -0.5) && isNear(fours[i].w, 0.5)));
    }
    CHECK((length[tried].x == 0 && length[tried].y == 0 && length[tried].z == 0 && length[tried].w == 0));
    CHECK((twos[tried] == sk::double2{0, 0} && threes[tried] == sk::double3{0, 0, 0}));
    CHECK(fours[tried] == sk::double4{0, 0, 0, 0});
    for (std::size_t i = 1; i < 3; ++i)
      CHECK((length[tried + i].x == inf && length[tried + i].y == inf && length[tried + i].z == inf));
    CHECK((std::isnan(length[tried + 3].x) && std::isnan(length[tried + 3].y) &&
           std::isnan(length[tried + 3].z)));
    auto magnitude = device.stream<double>({4}), direction = device.stream<double>({4});
    oneSigned(streamOf<double>(device, {-1e30, 1e-30, -0.0, -inf}), magnitude, direction);
    CHECK((isNear(magnitude.read()[0], 1e30) && magnitude.read()[2] == 0 && magnitude.read()[3] == inf));
    CHECK((direction.read()[0] == -1 && direction.read()[1] == 1 && direction.read()[2] == 0));
  });
}

TEST_CASE("functions of vectors of floats and of doubles in one kernel") {
  onEveryDoubleConfig([](sk::Device& device, const DoubleConfig& config) {
    const std::vector<float> x = {0.5F, -2, 3};
    const std::vector<double> y = {0.1, -1.7, 2.9};
    auto r = device.stream<float>({3});
    auto s = device.stream<double>({3});
    auto v = device.stream<sk::float3>({3});
    ofBothTypes(streamOf<float>(device, x), streamOf<double>(device, y), r, s, v);
    for (std::size_t i = 0; i < x.size(); ++i) {
      CHECK(std::fabs(r.read()[i] - std::sin(x[i])) < 1e-6);
      CHECK(std::fabs(s.read()[i] - std::sin(y[i])) < (config.isNative() ? 1e-15 : 1e-12));
      CHECK(std::fabs(v.read()[i].z - std::sqrt(std::fabs(x[i]))) < 1e-6);
    }
  });
}

TEST_CASE("conversions of vectors of doubles") {
  const auto d = vectorsOf<sk::double2>(count, 6);
  const auto i = values<sk::int2>(extent);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto f = device.stream<sk::float2>({extent});
    auto n = device.stream<sk::int2>({extent});
    auto r = device.stream<sk::double2>({extent});
    converted(streamOf<sk::double2>(device, d), streamOf<sk::int2>(device, i), f, n, r);
    const auto floats = f.read();
    const auto ints = n.read();
    const auto doubles = r.read();
    for (std::size_t k = 0; k < count; ++k) {
      INFO(k);
      CHECK((floats[k] == sk::float2{static_cast<float>(d[k].x), static_cast<float>(d[k].y)}));
      CHECK((ints[k] == sk::int2{static_cast<int>(d[k].x), static_cast<int>(d[k].y)}));
      CHECK((doubles[k] == sk::double2{i[k].x + d[k].x + (i[k].x != 0), i[k].y + d[k].y + (i[k].y != 0)}));
    }
  });
}

TEST_CASE("structs with doubles") {
  const auto positions = vectorsOf<sk::double3>(count, 7);
  const auto spins = vectorsOf<sk::double2>(count, 8);
  std::vector<Body> bodies(count);
  for (std::size_t i = 0; i < count; ++i) {
    bodies[i] = {positions[i], 0.5f, spins[i], positions[i].y, static_cast<int>(i)};
  }
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<Body>({extent});
    moved(0.25, streamOf<Body>(device, bodies), r);
    const auto actual = r.read();
    for (std::size_t i = 0; i < count; ++i) {
      const Body& b = bodies[i];
      INFO(i);
      CHECK((actual[i].position == sk::double3{b.position.x + 0.25 * b.spin.x, b.position.y + 0.25 * b.spin.y,
                                               b.position.z + 0.25 * b.charge}));
      CHECK((actual[i].spin == sk::double2{b.spin.x, 0.5}));
      CHECK(actual[i].charge == b.charge);
      CHECK(actual[i].mass == 0.5f);
      CHECK(actual[i].id == b.id + 1);
    }
  });
}

TEST_CASE("uniforms with doubles") {
  const Setup s = {0.5, {1, 2, 3}, {0.25, 0.75}, {{1, 2, 3, 4}, {5, 6, 7, 8}}};
  const std::array<double, 3> w = {10, 20, 30};
  const std::array<sk::double3, 2> v = {{{1.5, 2.5, 3.5}, {4.5, 5.5, 6.5}}};
  std::vector<int> i(count);
  std::iota(i.begin(), i.end(), 0);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<double>({extent});
    for (const double last : {1e-3, 17.0}) {
      fromUniforms(s, w, v, {0, 0, 0, last}, streamOf<int>(device, i), r);
      const auto actual = r.read();
      for (std::size_t k = 0; k < count; ++k) {
        const double sums = s.table[k & 1] + w[k % 3] + s.pair[k & 1].w + v[k & 1].y;
        const double wanted = s.scale * sums + s.offset.z + s.pair[1].y + last + v[0].z;
        INFO(k);
        CHECK(std::fabs(actual[k] - wanted) <= wanted * 0x1p-45);
      }
    }
  });
}

TEST_CASE("gathers of doubles") {
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    for (const auto& [height, width] : {std::pair{1, 1}, std::pair{13, 29}, std::pair{3, 64}}) {
      const auto n = static_cast<std::size_t>(height * width);
      const auto u = smallDoubles(n, 9);
      const auto w = vectorsOf<sk::double2>(7, 10);
      auto r = device.stream<double>({height, width});
      stencil(streamOf<double>(device, {height, width}, u), streamOf<sk::double2>(device, w), r);
      const auto actual = r.read();
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const auto at = [&, h = height, c = width](int i, int j) {
            return i < 0 || i >= h || j < 0 || j >= c ? 0.1 : u[static_cast<std::size_t>(i * c + j)];
          };
          const double wanted =
              at(y - 1, x) + at(y, x + 1) - 2 * at(y, x) + w[static_cast<std::size_t>(x + 2) % 7].y;
          CHECK(std::fabs(actual[static_cast<std::size_t>(y * width + x)] - wanted) <= 32 * 0x1p-45);
        }
      }
    }
  });
}

TEST_CASE("kernels of doubles call each other") {
  const auto x = smallDoubles(count, 11);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto r = device.stream<double>({extent});
    auto s = device.stream<sk::double2>({extent});
    chain(streamOf<double>(device, x), r, s);
    const auto actual = r.read();
    const auto pairs = s.read();
    for (std::size_t k = 0; k < count; ++k) {
      double b[2] = {2 * x[k] + 0.1, x[k]};
      CHECK(std::fabs(actual[k] - b[0]) <= 20 * 0x1p-45);
      for (int i = 0; b[i & 1] > 1 && i < 40;) b[++i & 1] /= 2;
      CHECK(std::fabs(pairs[k].x - b[0]) <= 20 * 0x1p-45);
      CHECK(pairs[k].y == b[1]);
    }
  });
}

TEST_CASE("reduces of doubles") {
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    CHECK(sum(device.stream<double>({0})) == 0);
    for (const std::size_t n : {std::size_t{1}, std::size_t{31}, std::size_t{10007}}) {
      const auto x = randomDoubles(n, 12, 8);
      const auto stream = streamOf<double>(device, x);
      long double total = 0, size = 0;
      for (const double v : x) {
        total += v;
        size += std::fabs(static_cast<long double>(v));
      }
      // No element passes through more than 200 additions on its way to the root.
      const long double error = 200 * precisionOf(config) * size;
      CHECK(std::fabs(sum(stream) - total) <= error);
      CHECK(largest(stream) == *std::max_element(x.begin(), x.end()));
      const sk::double2 ends = range(stream);
      CHECK(ends.x == *std::min_element(x.begin(), x.end()));
      CHECK(ends.y == *std::max_element(x.begin(), x.end()));
      const Moments m = moments(stream);
      CHECK(std::fabs(m.sum - total) <= error);
      CHECK(m.count == static_cast<int>(n));
      const auto v = vectorsOf<sk::double2>(n, 13);
      double expected = 0;
      for (const auto& [a, b] : v) expected += a * a + b * b;
      CHECK(squares(streamOf<sk::double2>(device, v)) == expected);  // exact: 2^-16 times integers below 2^40
    }
    const auto x = smallDoubles(24, 14);
    auto rows = device.stream<double>({6, 1});
    sum(streamOf<double>(device, {6, 4}, x), rows);
    CHECK(difference(rows.read(), [&](std::size_t i) {
            return x[4 * i] + x[4 * i + 1] + x[4 * i + 2] + x[4 * i + 3];
          }) == "");
  });
}

TEST_CASE("reduces of floats to doubles, with uniforms, gathers and several accumulators") {
  const auto x = values<float>(extent, 21);
  const auto y = vectorsOf<sk::double2>(count, 22);
  const auto w = smallDoubles(count, 23);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig& config) {
    double wanted = 0, size = 0;
    sk::double3 most = {-1e30, -1e30, -1e30};
    for (std::size_t i = 0; i < count; ++i) {
      wanted += 0.3 * x[i] * w[i] + 0.1;
      size += std::fabs(0.3 * x[i] * w[i]) + 0.1;
      most = {std::max(most.x, y[i].x), std::max(most.y, y[i].y), std::max(most.z, double{x[i]})};
    }
    const auto [total, ends, n] = weighed(0.3, streamOf<float>(device, x), streamOf<sk::double2>(device, y),
                                          streamOf<double>(device, w));
    CHECK(std::fabs(total - wanted) <= 100 * static_cast<double>(precisionOf(config)) * size);
    CHECK(ends == most);
    CHECK(n == static_cast<int>(count));
  });
}

TEST_CASE("variable and scatter outputs of doubles") {
  const auto x = smallDoubles(count, 15);
  const auto v = vectorsOf<sk::double2>(count, 16);
  std::vector<int> to(count);
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<int>((i * 7) % count);
  onEveryDoubleConfig([&](sk::Device& device, const DoubleConfig&) {
    auto found = device.stream<double>({1});
    onlyPositive(streamOf<double>(device, x), found);
    std::vector<double> wanted;
    for (const double one : x) {
      if (one > 0) wanted.push_back(one);
    }
    CHECK(found.read() == wanted);
    auto r = device.stream<sk::double2>({extent});
    permuted(streamOf<sk::double2>(device, v), streamOf<int>(device, to), r);
    const auto actual = r.read();
    for (std::size_t i = 0; i < count; ++i) {
      CHECK((actual[static_cast<std::size_t>(to[i])] == sk::double2{v[i].y, v[i].x}));
    }
  });
}

TEST_CASE("doubles beyond the planes of a pass") {
  std::vector<State> states(count);
  const auto positions = vectorsOf<sk::double3>(count, 17), velocities = vectorsOf<sk::double3>(count, 18);
  for (std::size_t i = 0; i < count; ++i) {
    states[i] = {positions[i], velocities[i], {positions[i].x, positions[i].y}, 2};
  }
  const auto a = vectorsOf<sk::double4>(count, 19);
  for (const char* profile : {"glsl330", "essl300"}) {
    for (const char* doubles : {"native", "pairs"}) {
      INFO(profile << " with " << doubles << " doubles");
      sk::Device device(sk::DeviceOptions{.profile = profile, .limits = "guaranteed", .doubles = doubles});
      auto r = device.stream<State>({extent});
      auto e = device.stream<double>({extent});
      advance(0.5, streamOf<State>(device, states), r, e);
      const auto actual = r.read();
      const auto energy = e.read();
      for (std::size_t i = 0; i < count; ++i) {
        const auto& [position, velocity, spin, mass] = states[i];
        const double square = velocity.x * velocity.x + velocity.y * velocity.y + velocity.z * velocity.z;
        INFO(i);
        CHECK((actual[i].position == sk::double3{position.x + 0.5 * velocity.x, position.y + 0.5 * velocity.y,
                                                 position.z + 0.5 * velocity.z}));
        CHECK((actual[i].velocity == sk::double3{velocity.x, velocity.y, velocity.z - square}));
        CHECK((actual[i].spin == sk::double2{spin.y * 0.5, spin.x * 0.5}));
        CHECK(energy[i] == square);
      }
      const auto v = streamOf<sk::double4>(device, a);
      const auto u = streamOf<sk::double3>(device, positions);
      gathered(v, v, v, v, v, v, v, v, u, e, e);
      const auto sums = e.read();
      for (std::size_t i = 0; i < count; ++i) {
        const double dots = 4 * (a[i].x * a[i].x + a[i].y * a[i].y + a[i].z * a[i].z + a[i].w * a[i].w);
        CHECK(sums[i] == dots + positions[i].z + energy[i]);
      }
    }
  }
}
