// SPDX-License-Identifier: MIT
//
// Streams with rows of a multiple of four elements: GL devices pack four scalars in a texel until an operation needs them
// unpacked. The results must be those of native code, which has no texels, in every layout.
#include "packing.sk.hpp"

#include <cstdint>
#include <functional>
#include <type_traits>
#include <vector>

#include "skip.hpp"
#include "support/devices.hpp"

using namespace run_tests;

namespace {

/// Small integers, which floats add exactly; never 0, so that a missing element shows.
template <class T>
std::vector<T> numbers(const sk::Shape& shape, int seed) {
  std::vector<T> made;
  for (std::int64_t i = 0; i < shape.size(); ++i) {
    const int n = static_cast<int>((i * 37 + seed * 11) % 97) + 1;
    if constexpr (std::is_same_v<T, sk::float4>) {
      const auto x = static_cast<float>(n);
      made.push_back({x, x + 1, x + 2, x + 3});
    } else if constexpr (std::is_same_v<T, sk::unorm8>) {
      made.push_back(sk::unorm8(static_cast<float>(n) / 255));
    } else if constexpr (std::is_same_v<T, sk::snorm16>) {
      made.push_back(sk::snorm16(static_cast<float>(n) / 32767));
    } else {
      made.push_back(T(static_cast<float>(n)));
    }
  }
  return made;
}

template <class T>
sk::Stream<T> filled(sk::Device& device, const sk::Shape& shape, int seed = 1) {
  auto stream = device.stream<T>(shape);
  if constexpr (std::is_same_v<T, bool>) {
    std::vector<std::uint8_t> bytes;
    for (std::int64_t i = 0; i < shape.size(); ++i) bytes.push_back((i * 5 + seed) % 3 == 0);
    stream.write(bytes);
  } else {
    stream.write(numbers<T>(shape, seed));
  }
  return stream;
}

/// The results of a scenario on a device, as bytes.
class Results {
 public:
  template <class S>
  void add(const S& stream) {
    const auto elements = stream.read();
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(elements.data());
    all_.emplace_back(bytes, bytes + elements.size() * sizeof(elements[0]));
  }
  void add(int value) {
    all_.push_back({reinterpret_cast<std::uint8_t*>(&value), reinterpret_cast<std::uint8_t*>(&value) + 4});
  }

  const std::vector<std::vector<std::uint8_t>>& all() const { return all_; }

 private:
  std::vector<std::vector<std::uint8_t>> all_;
};

using Scenario = std::function<void(sk::Device& device, Results& results)>;

void sameAsNative(const Scenario& scenario, std::span<const Layout> where = someLayouts) {
  Results expected;
  scenario(device("native"), expected);
  detail::onLayouts(where, [&](sk::Device& one) {
    Results found;
    scenario(one, found);
    REQUIRE(found.all().size() == expected.all().size());
    for (std::size_t i = 0; i < expected.all().size(); ++i) {
      const bool isSame = found.all()[i] == expected.all()[i];  // printing both would not help
      INFO("result " << i);
      CHECK(isSame);
    }
  });
}

const std::vector<sk::Shape> planes = {{1, 4}, {3, 8}, {8, 12}, {5, 64}, {13, 20}, {70, 76}};
const std::vector<sk::Shape> shapes = {{4},    {12},     {64},     {1024},    {1, 4},
                                       {3, 8}, {13, 20}, {70, 76}, {3, 5, 8}, {2, 3, 2, 12}};

}  // namespace

TEST_CASE("elements and indices of packed streams") {
  for (const sk::Shape& shape : shapes) {
    INFO("shape " << sk::toString(shape));
    sameAsNative([&](sk::Device& one, Results& results) {
      auto r = one.stream<float>(shape);
      packing::add(filled<float>(one, shape), filled<float>(one, shape, 2), r);
      results.add(r);
      auto n = one.stream<int>(shape);
      packing::number(filled<int>(one, shape), n);
      results.add(n);
      packing::add(r, r, r);
      packing::looped(r, 3, r);
      results.add(r);
      packing::add(r, r, r);
      results.add(r);
    });
  }
}

TEST_CASE("neighbours in packed planes") {
  for (const sk::Shape& shape : planes) {
    INFO("shape " << sk::toString(shape));
    sameAsNative([&](sk::Device& one, Results& results) {
      const auto u = filled<float>(one, shape);
      auto r = one.stream<float>(shape);
      packing::clamped(u, r);
      results.add(r);
      packing::wrapped(u, r);
      results.add(r);
      packing::mirrored(u, r);
      results.add(r);
      packing::bordered(u, r);
      results.add(r);
      packing::bordered(r, r);
      results.add(r);
      packing::gathered(u, u, r);
      results.add(r);
    });
  }
}

TEST_CASE("neighbours in packed rows and boxes") {
  for (const int length : {4, 8, 12, 64, 68, 1000, 5000}) {
    INFO("length " << length);
    sameAsNative([&](sk::Device& one, Results& results) {
      const auto u = filled<float>(one, {length});
      auto r = one.stream<float>({length});
      packing::clampedRow(u, r);
      results.add(r);
      packing::wrappedRow(u, r);
      results.add(r);
      packing::mirroredRow(u, r);
      results.add(r);
      packing::borderedRow(u, r);
      results.add(r);
    });
  }
  sameAsNative([](sk::Device& one, Results& results) {
    const auto u = filled<float>(one, {5, 6, 12});
    auto r = one.stream<float>({5, 6, 12});
    packing::deep(u, r);
    results.add(r);
  });
}

TEST_CASE("packed streams beside others, as domains and as arguments of other extents") {
  for (const sk::Shape& shape : planes) {
    INFO("shape " << sk::toString(shape));
    sameAsNative([&](sk::Device& one, Results& results) {
      const auto x = filled<float>(one, shape);
      const auto y = filled<sk::float4>(one, shape);
      auto r = one.stream<float>(shape);
      auto s = one.stream<sk::float4>(shape);
      auto n = one.stream<int>(shape);
      packing::mixed(x, y, r, s);
      results.add(r);
      results.add(s);
      packing::narrowed(s, r);
      results.add(r);
      packing::two(r, r, n);
      results.add(r);
      results.add(n);
      packing::add(filled<float>(one, {shape[0], 1}), filled<float>(one, {1, shape[1]}), r);
      results.add(r);
      packing::add(sk::stretch(filled<float>(one, {shape[0], shape[1] / 4})),
                   sk::stride(filled<float>(one, {shape[0] * 2, shape[1] * 3})), r);
      results.add(r);
      auto i = one.stream<float>({shape[1]});
      packing::ramp(sk::iter(0.0F, static_cast<float>(shape[1])), i);
      results.add(i);
    });
  }
}

TEST_CASE("views of packed streams, of whole texels or not") {
  struct Box {
    sk::Index begin, end;
  };
  for (const auto& [begin, end] : {Box{{1, 4}, {7, 16}}, Box{{0, 0}, {9, 8}}, Box{{2, 1}, {5, 18}},
                                   Box{{3, 4}, {4, 11}}, Box{{0, 3}, {9, 7}}}) {
    INFO("from " << sk::toString(begin) << " to " << sk::toString(end));
    sameAsNative([&](sk::Device& one, Results& results) {
      auto u = filled<float>(one, {9, 20});
      auto v = filled<float>(one, {9, 20}, 3);
      auto r = filled<float>(one, {9, 20}, 5);
      packing::add(u.domain(begin, end), v.domain(begin, end), r.domain(begin, end));
      results.add(r);
      packing::clamped(u.domain(begin, end), r.domain(begin, end));
      results.add(r);
      packing::wrapped(u, v);
      packing::add(v.domain(begin, end), r.domain(begin, end), v.domain(begin, end));
      results.add(v);
      results.add(v.domain(begin, end));
      const auto some = numbers<float>(v.domain(begin, end).shape(), 8);
      v.domain(begin, end).write(some);
      results.add(v);
      packing::looped(u.domain(begin, end), 2, v.domain(begin, end));
      results.add(v);
      const auto later = v.domain(begin, end).readAsync();
      packing::add(u, u, v);
      v.domain(begin, end).writeAsync(some);
      results.add(v);
    });
  }
}

TEST_CASE("scalars of every type are packed") {
  for (const sk::Shape& shape : planes) {
    INFO("shape " << sk::toString(shape));
    sameAsNative([&](sk::Device& one, Results& results) {
      const auto a = filled<sk::half>(one, shape);
      const auto b = filled<std::uint8_t>(one, shape);
      const auto c = filled<std::int16_t>(one, shape);
      const auto d = filled<bool>(one, shape);
      const auto e = filled<sk::unorm8>(one, shape);
      const auto f = filled<sk::snorm16>(one, shape);
      const auto g = filled<std::uint32_t>(one, shape);
      auto ra = one.stream<sk::half>(shape);
      auto rb = one.stream<std::uint8_t>(shape);
      auto rc = one.stream<std::int16_t>(shape);
      auto rd = one.stream<bool>(shape);
      auto re = one.stream<sk::unorm8>(shape);
      auto rf = one.stream<sk::snorm16>(shape);
      auto rg = one.stream<std::uint32_t>(shape);
      packing::types(a, b, c, d, e, f, g, ra, rb, rc, rd, re, rf, rg);
      for (int k = 0; k < 2; ++k) {
        results.add(ra);
        results.add(rb);
        results.add(rc);
        results.add(rd);
        results.add(re);
        results.add(rf);
        results.add(rg);
        packing::moved(b, d, e, rb, rd, re);
      }
    });
  }
}

TEST_CASE("reduces of packed streams") {
  for (const sk::Shape& shape : shapes) {
    INFO("shape " << sk::toString(shape));
    sameAsNative([&](sk::Device& one, Results& results) {
      const auto x = filled<int>(one, shape);
      const auto y = filled<int>(one, shape, 4);
      results.add(packing::sum(x));
      results.add(packing::dot(x, y));
      results.add(packing::first(x));
      results.add(packing::weigh(x));
      results.add(static_cast<int>(packing::largest(filled<float>(one, shape))));
    });
  }
}

TEST_CASE("reduces of blocks, and of views, of packed streams") {
  sameAsNative([](sk::Device& one, Results& results) {
    auto x = filled<int>(one, {12, 24});
    for (const sk::Shape& blocks : {sk::Shape{12, 1}, {1, 24}, {6, 3}, {12, 12}, {3, 6}, {12, 24}, {4, 2}}) {
      auto r = one.stream<int>(blocks);
      packing::sum(x, r);
      results.add(r);
      packing::first(x, r);
      results.add(r);
    }
    results.add(packing::sum(x.domain({2, 4}, {9, 20})));
    results.add(packing::sum(x.domain({2, 3}, {9, 20})));
    results.add(packing::dot(x.domain({0, 4}, {9, 20}), x.domain({2, 3}, {11, 19})));
    auto whole = filled<int>(one, {12, 24}, 7);
    auto rows = whole.domain({0, 4}, {12, 5});
    packing::sum(x, rows);
    results.add(whole);
  });
}

TEST_CASE("what is pushed and scattered from packed streams, and to them") {
  sameAsNative(
      [](sk::Device& one, Results& results) {
        const sk::Shape shape{9, 16};
        auto x = filled<float>(one, shape);
        auto at = filled<int>(one, shape, 6);
        auto pushed = one.stream<float>({4});
        packing::positive(x, pushed);
        results.add(pushed);
        auto target = filled<float>(one, {100}, 2);
        packing::spread(x, at, target);
        results.add(target);
        packing::add(target, target, target);
        results.add(target);
      },
      drawnLayouts);
}

TEST_CASE("a packed stream gives a texture of its elements") {
  for (const std::string profile : {"glsl330", "glsl430", "essl300"}) {
    sk::Device& one = device(profile);
    if (one.profile() == "native") {
      skip("SK_DEVICE chooses native code, whose streams are no textures");
      continue;
    }
    auto u = filled<float>(one, {6, 8});
    const sk::StreamTexture texture = u.texture();
    CHECK(texture.width == 8);
    CHECK(texture.height == 6);
    CHECK(u.read() == numbers<float>({6, 8}, 1));
    packing::add(u, u, u);
    CHECK(u.texture().width == 8);
  }
}
