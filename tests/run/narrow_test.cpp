// SPDX-License-Identifier: MIT
//
// Storage types against those of C++, and half and normalized types against formulas in double: every value of 8 and 16
// bits, and floats at and next to every rounding boundary. All results are exact, because devices round with integer
// arithmetic.
#include "narrow.sk.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "support/devices.hpp"
#include "support/folds.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Every value of a type of 8 or 16 bits.
template <class T>
std::vector<T> everyValue() {
  std::vector<T> all;
  for (int i = std::numeric_limits<T>::min(); i <= std::numeric_limits<T>::max(); ++i) {
    all.push_back(static_cast<T>(i));
  }
  return all;
}

template <class T>
std::vector<T> everyNormalized() {
  using Integer = decltype(T().integer());
  std::vector<T> all;
  for (const Integer i : everyValue<Integer>()) all.push_back(T::fromInteger(i));
  return all;
}

std::vector<sk::half> everyHalf() {
  std::vector<sk::half> all;
  for (const std::uint16_t bits : everyValue<std::uint16_t>()) all.push_back(sk::half::fromBits(bits));
  return all;
}

void addAround(std::vector<float>& list, float x) {
  for (const float y : {x, std::nextafter(x, infinity), std::nextafter(x, -infinity)}) {
    list.push_back(y);
    list.push_back(-y);
  }
}

/// All halves, the midpoints between them, and the neighbours of both.
std::vector<float> floatsForHalf() {
  std::vector<float> list = {infinity, -infinity, std::nanf(""), 3e38f, -3e38f, 65519.99f, 65520.0f, 1e-30f};
  for (std::uint16_t bits = 0; bits < 0x7c00; ++bits) {
    const float here = sk::half::fromBits(bits);
    const float next =
        bits == 0x7bff ? 65536.0f : float(sk::half::fromBits(static_cast<std::uint16_t>(bits + 1)));
    list.push_back(here);
    addAround(list, (here + next) / 2);
  }
  return list;
}

/// Values of the normalized type, values between them, and values outside its range.
template <class T>
std::vector<float> floatsFor() {
  std::vector<float> list = {infinity, -infinity, std::nanf(""), -0.0f, 1e-40f, 2.0f, -2.0f, 1e30f, -1e30f};
  const int scale = static_cast<int>(T::scale);
  for (int i = 0; i <= 2 * scale; i += 1 + scale / 5000)
    addAround(list, static_cast<float>(i) / (2 * T::scale));
  addAround(list, 1.0f);
  return list;
}

/// The nearest half, computed in double, where everything but the last rounding is exact.
float nearestHalf(float x) {
  if (std::isnan(x) || std::isinf(x)) return x;
  int exponent = 0;
  std::frexp(x, &exponent);
  const double unit = std::ldexp(1.0, std::max(exponent - 11, -24));
  const double rounded = std::nearbyint(double{x} / unit) * unit;
  return std::fabs(rounded) > 65504 ? std::copysign(infinity, x) : static_cast<float>(rounded);
}

template <class T>
float nearestNormalized(float x) {
  if (std::isnan(x)) return 0;
  const float least = std::is_signed_v<decltype(T().integer())> ? -1.0f : 0.0f;
  return std::nearbyint(std::min(std::max(x, least), 1.0f) * T::scale) / T::scale;
}

template <class T, class Kernel, class Rounding>
void checkTo(sk::Device& device, const Kernel& kernel, const std::vector<float>& floats, Rounding rounding) {
  auto r = device.stream<T>({static_cast<std::int64_t>(floats.size())});
  kernel(streamOf<float>(device, floats), r);
  const std::vector<T> result = r.read();
  std::vector<float> values(result.begin(), result.end());
  CHECK(difference(values, [&](std::size_t i) { return rounding(floats[i]); }) == "");
  CHECK(difference(values, [&](std::size_t i) { return float(T(floats[i])); }) == "");  // on the host
}

template <class To, class T, class Kernel>
void checkFrom(sk::Device& device, const Kernel& kernel, const std::vector<T>& all) {
  const auto x = streamOf<T>(device, all);
  auto r = device.stream<To>({static_cast<std::int64_t>(all.size())});
  kernel(x, r);
  CHECK(difference(r.read(), [&](std::size_t i) { return static_cast<To>(all[i]); }) == "");
  const std::vector<T> back = x.read();
  CHECK(std::memcmp(back.data(), all.data(), all.size() * sizeof(T)) == 0);
}

template <class T, class Kernel>
void checkWrap(sk::Device& device, const Kernel& kernel) {
  std::vector<int> ints = {2147483647, -2147483647 - 1, 65536, -65536, 32768, -32769, 16777217};
  for (int i = -70000; i < 70000; i += 7) ints.push_back(i);
  auto r = device.stream<T>({static_cast<std::int64_t>(ints.size())});
  kernel(streamOf<int>(device, ints), r);
  CHECK(difference(r.read(), [&](std::size_t i) { return static_cast<T>(ints[i]); }) == "");
}

template <class T>
std::vector<T> hashedValues(std::size_t count, std::uint32_t seed) {
  std::vector<T> list;
  for (std::size_t i = 0; i < count; ++i)
    list.push_back(static_cast<T>(hashed(static_cast<std::uint32_t>(i) + seed * 977u)));
  return list;
}

/// Halves in [-8, 8).
sk::half halfAt(std::size_t i) { return sk::half(valueAt<float>(static_cast<std::uint32_t>(i))); }

sk::unorm8 unormAt(std::size_t i) {
  return sk::unorm8::fromInteger(static_cast<std::uint8_t>(hashed(static_cast<std::uint32_t>(i))));
}

}  // namespace

TEST_CASE("floats become the nearest value of a narrow type") {
  onEveryTarget([](sk::Device& device) {
    checkTo<sk::half>(device, narrow::toHalf, floatsForHalf(), nearestHalf);
    checkTo<sk::unorm8>(device, narrow::toUnorm8, floatsFor<sk::unorm8>(), nearestNormalized<sk::unorm8>);
    checkTo<sk::snorm8>(device, narrow::toSnorm8, floatsFor<sk::snorm8>(), nearestNormalized<sk::snorm8>);
    checkTo<sk::unorm16>(device, narrow::toUnorm16, floatsFor<sk::unorm16>(), nearestNormalized<sk::unorm16>);
    checkTo<sk::snorm16>(device, narrow::toSnorm16, floatsFor<sk::snorm16>(), nearestNormalized<sk::snorm16>);
  });
}

TEST_CASE("integers wrap as in C") {
  onEveryTarget([](sk::Device& device) {
    checkWrap<std::int8_t>(device, narrow::toChar);
    checkWrap<std::uint8_t>(device, narrow::toUchar);
    checkWrap<std::int16_t>(device, narrow::toShort);
    checkWrap<std::uint16_t>(device, narrow::toUshort);
  });
}

TEST_CASE("every value of a narrow type is read as it is, and comes back bit for bit") {
  onEveryTarget([](sk::Device& device) {
    checkFrom<float>(device, narrow::fromHalf, everyHalf());
    checkFrom<float>(device, narrow::fromUnorm8, everyNormalized<sk::unorm8>());
    checkFrom<float>(device, narrow::fromSnorm8, everyNormalized<sk::snorm8>());
    checkFrom<float>(device, narrow::fromUnorm16, everyNormalized<sk::unorm16>());
    checkFrom<float>(device, narrow::fromSnorm16, everyNormalized<sk::snorm16>());
    checkFrom<int>(device, narrow::fromChar, everyValue<std::int8_t>());
    checkFrom<int>(device, narrow::fromUchar, everyValue<std::uint8_t>());
    checkFrom<int>(device, narrow::fromShort, everyValue<std::int16_t>());
    checkFrom<int>(device, narrow::fromUshort, everyValue<std::uint16_t>());
  });
}

TEST_CASE("narrow integers compute in int and wrap where they are kept") {
  const std::size_t n = 1009;
  const auto c = hashedValues<std::int8_t>(n, 1);
  const auto u = hashedValues<std::uint8_t>(n, 2);
  const auto s = hashedValues<std::int16_t>(n, 3);
  const auto w = hashedValues<std::uint16_t>(n, 4);
  onSomeLayouts([&](sk::Device& device) {
    auto wide = device.stream<sk::int4>({n});
    auto cr = device.stream<std::int8_t>({n});
    auto ur = device.stream<std::uint8_t>({n});
    auto sr = device.stream<std::int16_t>({n});
    auto wr = device.stream<std::uint16_t>({n});
    narrow::integers(streamOf<std::int8_t>(device, c), streamOf<std::uint8_t>(device, u),
                     streamOf<std::int16_t>(device, s), streamOf<std::uint16_t>(device, w), wide, cr, ur, sr,
                     wr);
    CHECK(difference(wide.read(), [&](std::size_t i) {
            return sk::int4{c[i] + u[i], s[i] * s[i], w[i] - s[i], ~u[i]};
          }) == "");
    CHECK(difference(cr.read(), [&](std::size_t i) {
            return static_cast<std::int8_t>(static_cast<std::int8_t>(c[i] * 3) + u[i]);
          }) == "");
    CHECK(difference(ur.read(), [&](std::size_t i) { return static_cast<std::uint8_t>((u[i] - 1) << 1); }) ==
          "");
    CHECK(difference(sr.read(), [&](std::size_t i) {
            return static_cast<std::int16_t>(static_cast<std::int16_t>(s[i] + 1) * c[i]);
          }) == "");
    CHECK(difference(wr.read(),
                     [&](std::size_t i) { return static_cast<std::uint16_t>((-w[i] - 1) ^ s[i]); }) == "");
  });
}

TEST_CASE("vectors of narrow types wrap and round at each operation") {
  const std::size_t n = 509;
  std::vector<sk::char4> c;
  std::vector<sk::uchar3> u;
  std::vector<sk::half4> h;
  std::vector<sk::half2> k;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t bits = hashed(static_cast<std::uint32_t>(i));
    c.push_back({static_cast<std::int8_t>(bits), static_cast<std::int8_t>(bits >> 8),
                 static_cast<std::int8_t>(bits >> 16), static_cast<std::int8_t>(bits >> 24)});
    u.push_back({static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 9),
                 static_cast<std::uint8_t>(bits >> 20)});
    h.push_back({halfAt(4 * i), halfAt(4 * i + 1), halfAt(4 * i + 2), halfAt(4 * i + 3)});
    k.push_back({halfAt(i + 7), halfAt(i + 9)});
  }
  onSomeLayouts([&](sk::Device& device) {
    auto cr = device.stream<sk::char4>({n});
    auto ur = device.stream<sk::uchar3>({n});
    auto hr = device.stream<sk::half4>({n});
    auto kr = device.stream<sk::half2>({n});
    narrow::vectors(streamOf<sk::char4>(device, c), streamOf<sk::uchar3>(device, u),
                    streamOf<sk::half4>(device, h), streamOf<sk::half2>(device, k), cr, ur, hr, kr);
    CHECK(difference(cr.read(), [&](std::size_t i) {
            const auto one = [](int v, int kept) {
              return static_cast<std::int8_t>(v < kept ? kept : -kept);
            };
            const auto squared = [](int v) {
              return static_cast<std::int8_t>(static_cast<std::int8_t>(v * v) + 100);
            };
            const std::int8_t x = squared(c[i].x);
            return sk::char4{one(c[i].x, x), one(c[i].y, c[i].x > c[i].y ? c[i].x : c[i].y),
                             one(c[i].z, squared(c[i].z)), one(c[i].w, squared(c[i].w))};
          }) == "");
    CHECK(difference(ur.read(), [&](std::size_t i) {
            const auto twice = [](int v) { return static_cast<std::uint8_t>(v + v); };
            return sk::uchar3{static_cast<std::uint8_t>(twice(u[i].x) + u[i].y), twice(u[i].y),
                              static_cast<std::uint8_t>(twice(u[i].z) + u[i].x)};
          }) == "");
    const auto folded = [&](sk::half x) { return sk::half(sk::half(sk::half(x * x) + x) / 3.0f); };
    const auto folds = [&](std::size_t i) {
      return sk::half4{folded(h[i].x), h[i].x, folded(h[i].z), folded(h[i].w)};
    };
    CHECK(difference(hr.read(), folds) == "");
    CHECK(difference(kr.read(), [&](std::size_t i) {
            const sk::half4 r = folds(i);
            return k[i].x < r.x && k[i].y < r.y ? k[i] : sk::half2{r.z, r.w};
          }) == "");
  });
}

TEST_CASE("vectors of normalized values") {
  const std::size_t n = 300;
  std::vector<sk::unorm8x4> x;
  std::vector<sk::snorm16x2> y;
  std::vector<sk::unorm8x3> z;
  for (std::size_t i = 0; i < n; ++i) {
    x.push_back({unormAt(4 * i), unormAt(4 * i + 1), unormAt(4 * i + 2), unormAt(4 * i + 3)});
    y.push_back({sk::snorm16(valueAt<float>(static_cast<std::uint32_t>(i)) / 8), sk::snorm16(-1.0f)});
    z.push_back({unormAt(i), unormAt(i + 1), unormAt(i + 2)});
  }
  const sk::unorm8x4 colour = {unormAt(1), unormAt(2), unormAt(3), sk::unorm8(1.0f)};
  onSomeLayouts([&](sk::Device& device) {
    auto r = device.stream<sk::unorm8x4>({15, 20});
    auto s = device.stream<sk::snorm16x2>({15, 20});
    auto t = device.stream<sk::unorm8x3>({15, 20});
    narrow::pixels(colour, streamOf<sk::unorm8x4>(device, {15, 20}, x),
                   streamOf<sk::snorm16x2>(device, {15, 20}, y), streamOf<sk::unorm8x3>(device, {15, 20}, z),
                   r, s, t);
    CHECK(difference(r.read(), [&](std::size_t i) {
            const auto one = [](sk::unorm8 v, sk::unorm8 k) { return sk::unorm8(v * k + 0.25f); };
            return sk::unorm8x4{one(x[i].x, colour.x), one(x[i].y, colour.y), one(x[i].z, colour.z),
                                sk::unorm8(one(x[i].w, colour.w) * 0.5f)};
          }) == "");
    CHECK(difference(s.read(), [&](std::size_t i) {
            return sk::snorm16x2{sk::snorm16(-y[i].x), sk::snorm16(1.0f)};
          }) == "");
    CHECK(difference(t.read(), [&](std::size_t i) { return sk::unorm8x3{z[i].z, z[i].y, z[i].x}; }) == "");
  });
}

namespace {

bool agree(const narrow::Sample& a, const narrow::Sample& b) {
  return a.weight == b.weight && a.level == b.level && a.colour == b.colour && a.cell == b.cell &&
         a.value == b.value;
}

narrow::Sample sampleAt(std::size_t i) {
  const std::uint32_t bits = hashed(static_cast<std::uint32_t>(i) + 5u);
  return {halfAt(i),
          static_cast<std::int8_t>(bits),
          {unormAt(i), unormAt(i + 3), unormAt(i + 5), unormAt(i + 7)},
          {static_cast<std::uint16_t>(bits >> 3), static_cast<std::uint16_t>(bits >> 11)},
          valueAt<float>(bits)};
}

}  // namespace

TEST_CASE("structs of narrow types as uniforms, gathers, outputs, in place and on views") {
  const narrow::Sample shift = sampleAt(1000);
  for (const std::int64_t count : {0, 1, 7, 211}) {
    std::vector<narrow::Sample> a;
    for (std::int64_t i = 0; i < count; ++i) a.push_back(sampleAt(static_cast<std::size_t>(i)));
    const auto expected = [&](std::size_t i, std::size_t end) {
      const narrow::Sample& next = a[std::min(i + 1, end)];
      narrow::Sample r = a[i];
      r.weight = r.weight + shift.weight;
      r.level = static_cast<std::int8_t>(r.level + next.level + shift.level);
      r.colour = {next.colour.x * shift.colour.x, next.colour.y * shift.colour.y,
                  next.colour.z * shift.colour.z, next.colour.w * shift.colour.w};
      r.cell.y = static_cast<std::uint16_t>(next.cell.x + shift.cell.y);
      r.value = r.weight + shift.value;
      return r;
    };
    onSomeLayouts([&](sk::Device& device) {
      const std::size_t last = a.empty() ? 0 : a.size() - 1;
      auto stream = streamOf<narrow::Sample>(device, a);
      auto r = device.stream<narrow::Sample>({count});
      if (count > 3) {
        narrow::samples(shift, stream.domain({1}, {count - 1}), r.domain({2}, {count}));
        const auto part = r.domain({2}, {count}).read();
        CHECK(difference(
                  part, part.size(), [&](std::size_t i) { return expected(i + 1, last - 1); }, agree) == "");
      }
      narrow::samples(shift, stream, stream);
      CHECK(
          difference(stream.read(), a.size(), [&](std::size_t i) { return expected(i, last); }, agree) == "");
    });
  }
}

TEST_CASE("reduces over narrow types") {
  for (const std::int64_t count :
       {1, 2, 997, 3989}) {  // the last is near the most that a device with the small limit holds
    const auto n = static_cast<std::size_t>(count);
    const auto bytes = hashedValues<std::uint8_t>(n, 9);
    std::vector<sk::half> halves;
    std::vector<sk::unorm8x4> colours;
    std::vector<narrow::Sample> samples;
    for (std::size_t i = 0; i < n; ++i) {
      halves.push_back(halfAt(i));
      colours.push_back({unormAt(i), unormAt(i + 1), sk::unorm8(0.5f), sk::unorm8(0.0f)});
      samples.push_back(sampleAt(i));
    }
    const int sum = std::accumulate(bytes.begin(), bytes.end(), 0);
    const float most = *std::max_element(halves.begin(), halves.end());
    narrow::Sample latest = samples[0];
    sk::unorm8x4 brightest = colours[0];
    for (std::size_t i = 1; i < n; ++i) {
      if (samples[i].level >= latest.level) latest = samples[i];
      brightest.x = std::max<float>(brightest.x, colours[i].x);
      brightest.y = std::max<float>(brightest.y, colours[i].y);
    }
    onSomeLayouts([&](sk::Device& device) {
      const auto x = streamOf<std::uint8_t>(device, bytes);
      CHECK(narrow::sumBytes(x) == sum);
      CHECK(narrow::wrapped(x) == static_cast<std::uint8_t>(sum));
      CHECK(float(narrow::largest(streamOf<sk::half>(device, halves))) == most);
      CHECK(narrow::brightest(streamOf<sk::unorm8x4>(device, colours)) == brightest);
      CHECK(agree(narrow::latest(streamOf<narrow::Sample>(device, samples)), latest));
    });
  }
}

TEST_CASE("empty reduces of narrow types give the identity") {
  onEveryTarget([](sk::Device& device) {
    CHECK(narrow::wrapped(device.stream<std::uint8_t>({0})) == 0);
    CHECK(narrow::brightest(device.stream<sk::unorm8x4>({0})) == sk::unorm8x4{0.0f, 0.0f, 0.0f, 0.0f});
  });
}

TEST_CASE("constants, arrays and overloads of narrow types") {
  const std::uint8_t k = 250;
  const sk::half h = 1.5f;
  std::vector<int> i;
  for (int n = -300; n < 300; ++n) i.push_back(n < 0 ? n * -7 : n);
  onGlAndNative([&](sk::Device& device) {
    const auto count = static_cast<std::int64_t>(i.size());
    auto r = device.stream<sk::half>({count});
    auto n = device.stream<int>({count});
    auto m = device.stream<std::uint8_t>({count});
    narrow::constants(streamOf<int>(device, i), k, h, r, n, m);
    constexpr std::uint8_t table[5] = {1, 200, 255, 253, 7};
    const sk::half third = 1.0f / 3.0f;
    const auto mAt = [&](std::size_t e) {
      std::uint8_t local[4] = {1, 2, 3, 4};
      local[i[e] & 3] = static_cast<std::uint8_t>(local[i[e] & 3] + k);
      return static_cast<std::uint8_t>(local[i[e] & 3] + local[(i[e] + 1) & 3]);
    };
    CHECK(difference(r.read(), [&](std::size_t e) {
            return sk::half(float(sk::half(third + third)) * h + static_cast<float>(table[i[e] % 5]));
          }) == "");
    CHECK(difference(m.read(), mAt) == "");
    CHECK(difference(n.read(), [&](std::size_t e) {
            const std::uint8_t value = mAt(e);
            return value == 5 ? -1 : value == 'a' ? -2 : 2 * static_cast<std::int8_t>(i[e]);
          }) == "");
  });
}
