// SPDX-License-Identifier: MIT
//
// Kernels whose inputs share array textures (stacks) against plain C++, on devices with guaranteed and with their own
// limits. All results are exact.
#include "stacks.sk.hpp"

#include <array>
#include <utility>

#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;
using sk::float2;
using stacks::Narrow;

namespace {

/// Calls test(device) on devices with the guaranteed limits, with and without layers, and on one with its own limits.
template <class Test>
void onEveryLimit(const Test& test) {
  struct Limits {
    const char* profile;
    const char* limits;
    std::int32_t texture;
  };
  for (const auto& [profile, limits, texture] :
       {Limits{"glsl330", "guaranteed", 0}, Limits{"glsl330", "device", 0},
        Limits{"essl300", "guaranteed", smallLimits[1]}}) {
    INFO("profile " << profile << ", limits " << limits << ", texture limit " << texture);
    sk::Device device({.profile = profile, .textureLimit = texture, .limits = limits});
    test(device);
  }
}

/// Lists of elements; make(list number, element number) makes an element.
template <class T, class Make>
std::vector<std::vector<T>> listsOf(std::size_t lists, std::size_t count, const Make& make) {
  std::vector<std::vector<T>> all(lists);
  for (std::size_t n = 0; n < lists; ++n) {
    for (std::size_t i = 0; i < count; ++i) all[n].push_back(make(static_cast<int>(n), static_cast<int>(i)));
  }
  return all;
}

/// Calls kernel(stream of the first list, stream of the second list, ..., rest ...).
template <std::size_t lists, class T, class Kernel, class... Rest>
void callWith(const Kernel& kernel, sk::Device& device, const sk::Shape& shape,
              const std::vector<std::vector<T>>& all, Rest&&... rest) {
  [&]<std::size_t... n>(std::index_sequence<n...>) {
    kernel(streamOf<T>(device, shape, all[n])..., rest...);
  }(std::make_index_sequence<lists>());
}

Narrow narrowAt(int n, int i) {
  return {{sk::half(static_cast<float>(i - n)), sk::half(0.5f), sk::half(1.0f),
           sk::half(static_cast<float>(i * n % 50))},
          sk::unorm8((i + n) % 3 == 0 ? 1.0f : 0.0f),
          {static_cast<std::int8_t>(i * 7 + n), static_cast<std::int8_t>(-i + n)},
          static_cast<std::uint16_t>(i * 9000 + n)};
}

int wrapped(std::int64_t i, std::int64_t n) { return static_cast<int>(((i % n) + n) % n); }
int clamped(std::int64_t i, std::int64_t n) {
  return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
}
int asInt(std::int64_t x) { return static_cast<int>(static_cast<std::uint32_t>(x)); }

}  // namespace

TEST_CASE("narrow planes share textures") {
  constexpr std::size_t count = 67;
  constexpr int rounds = 9;
  const auto g = listsOf<Narrow>(15, count, narrowAt);
  onEveryLimit([&](sk::Device& device) {
    auto r = device.stream<int>({count}), s = device.stream<int>({count});
    callWith<15>(stacks::narrow, device, {count}, g, rounds, r);
    callWith<15>(stacks::inputs, device, {count}, g, s);
    CHECK(difference(r.read(), [&](std::size_t p) {
            int t = 0;
            for (int k = 0; k < rounds; ++k) {
              for (const auto& list : g) {
                const Narrow& v =
                    list[static_cast<std::size_t>(wrapped(static_cast<int>(p) + k * (t & 3), count))];
                t += static_cast<int>(float(v.a.w)) + 3 * v.c.y + v.d;
                if (float(v.b) > 0.5f) t ^= k;
              }
            }
            return t;
          }) == "");
    CHECK(difference(s.read(), [&](std::size_t p) {
            int t = 0;
            for (const auto& list : g) {
              const Narrow& v = list[p];
              const int more = float(v.b) > 0.5f ? 1000 : 0;
              t = asInt(std::int64_t{t} * 3 + static_cast<int>(float(v.a.x)) + v.c.x - v.d + more);
            }
            return t;
          }) == "");
  });
}

TEST_CASE("rows of matrices share textures") {
  constexpr std::size_t height = 7, width = 11;
  constexpr int rounds = 6;
  const auto m = listsOf<sk::float4x4>(5, height * width, [](int n, int i) {
    sk::float4x4 matrix;
    for (int row = 0; row < 4; ++row) {
      const auto f = static_cast<float>(n * 100 + i + row * 10);
      matrix[static_cast<std::size_t>(row)] = {f, f + 1, -f, f - 2};
    }
    return matrix;
  });
  const auto n = listsOf<sk::float3x3>(5, height * width, [](int k, int i) {
    const auto f = static_cast<float>(k + i);
    return sk::float3x3{{{f, -f, 1}, {2, f + 1, 3}, {4, 5 - f, 6}}};
  });
  onEveryLimit([&](sk::Device& device) {
    auto r = device.stream<int>({height, width});
    std::vector<sk::Stream<sk::float3x3>> inputs;
    for (const auto& list : n) inputs.push_back(streamOf<sk::float3x3>(device, {height, width}, list));
    callWith<5>(stacks::matrices, device, {height, width}, m, inputs[0], inputs[1], inputs[2], inputs[3],
                inputs[4], rounds, r);
    CHECK(difference(r.read(), [&](std::size_t i) {
            int t = 0;
            for (int k = 0; k < rounds; ++k) {
              for (const auto& list : m) {
                const auto& row = list[i][static_cast<std::size_t>(k & 3)];
                const std::size_t x = i % width, y = i / width;
                const auto beside =
                    static_cast<std::size_t>(clamped(static_cast<std::int64_t>(x) + k, width));
                const std::array<float, 4> parts = {row.x, row.y, row.z, row.w};
                t = static_cast<int>(static_cast<float>(t) + (parts[static_cast<std::size_t>(t & 3)] +
                                                              list[y * width + beside][1].z));
              }
              for (const auto& list : n) {
                t = static_cast<int>(static_cast<float>(t) - list[i][static_cast<std::size_t>(k % 3)].y);
              }
            }
            return t;
          }) == "");
  });
}

TEST_CASE("doubles share textures") {
  constexpr std::size_t count = 67;
  const auto d = listsOf<sk::double3>(
      10, count, [](int n, int i) { return sk::double3{0.5, n * 3.0 + i, i * 0x1p-20}; });
  onEveryLimit([&](sk::Device& device) {
    auto r = device.stream<double>({count});
    callWith<10>(stacks::doubles, device, {count}, d, r);
    CHECK(difference(r.read(), [&](std::size_t p) {
            double sum = 0;
            for (const auto& list : d) {
              const int at = clamped(static_cast<int>(p) + static_cast<int>(sum) % 3, count);
              sum += list[static_cast<std::size_t>(at)].y + list[p].z;
            }
            return sum;
          }) == "");
  });
}

TEST_CASE("gathers that share textures are interpolated without the device's filter") {
  constexpr std::size_t height = 5, width = 6, count = 50;
  const auto a = listsOf<float2>(20, height * width,
                                 [](int n, int i) { return float2{-1, static_cast<float>((n + i) % 16)}; });
  std::vector<float2> where;
  for (std::size_t i = 0; i < count; ++i) {
    where.push_back({static_cast<float>(i % 10) / 4, static_cast<float>(i % 4)});  // the weight along y is 0
  }
  onEveryLimit([&](sk::Device& device) {
    // The device may filter the gathers that keep their own textures, with weights of at least 8 bits.
    const auto x = streamOf<float2>(device, where);
    auto r = device.stream<float>({count});
    callWith<20>(stacks::sampled, device, {height, width}, a, x, r);
    const auto mirrored = [&](int i) {
      return i < static_cast<int>(width) ? i : 2 * static_cast<int>(width) - 1 - i;
    };
    CHECK(difference(
              r.read(),
              [&](std::size_t i) {
                double sum = 0;
                float px = where[i].x;
                const auto row = static_cast<std::size_t>(where[i].y) * width;
                for (const auto& list : a) {
                  const int left = static_cast<int>(px);
                  const float t = px - static_cast<float>(left);
                  const auto at = [&](int k) { return list[row + static_cast<std::size_t>(mirrored(k))].y; };
                  sum += at(left) * (1 - t) + at(left + 1) * t;
                  px += 0.25f;
                }
                return sum;
              },
              20 * 16 * 0x1p-8, 0) == "");
  });
}

TEST_CASE("as many gathers as a kernel may have") {
  // Only rows of 68 elements can be packed.
  const std::size_t count = GENERATE(std::size_t{67}, std::size_t{68});
  const auto g = listsOf<int>(120, count, [](int n, int i) { return n * 31 + i * i - 500; });
  onEveryLimit([&](sk::Device& device) {
    auto r = device.stream<int>({count});
    callWith<120>(stacks::most, device, {count}, g, r);
    CHECK(difference(r.read(), [&](std::size_t p) {
            int t = 0;
            for (const auto& list : g) {
              const int at = clamped(static_cast<int>(p) + t % 3, count);
              t = asInt(std::int64_t{t} * 5 + list[static_cast<std::size_t>(at)]);
            }
            return t;
          }) == "");
  });
}
