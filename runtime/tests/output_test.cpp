// SPDX-License-Identifier: MIT
//
// Outputs: several at once, outputs that the same call reads, outputs with different layouts.
#include <cstring>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "elements.hpp"
#include "error_of.hpp"
#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

std::vector<float> counted(std::int64_t count, float first = 0) {
  std::vector<float> values(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = first + static_cast<float>(i);
  }
  return values;
}

const TestKernel& increment() {
  static const TestKernel kernel("increment", "void increment(float x, out float r) { r = x + 1.0; }\n",
                                 {input<float>("x"), output<float>("r")});
  return kernel;
}

const TestKernel& two() {
  static const TestKernel kernel(
      "two", "void two(float x, out float a, out float b) { a = x + 1.0; b = x + 1000.0; }\n",
      {input<float>("x"), output<float>("a"), output<float>("b")});
  return kernel;
}

}  // namespace

TEST_CASE("outputs of several types in one pass") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 16);
  Device device({.profile = profile, .textureLimit = limit});
  static const TestKernel split(
      "split",
      "void split(vec4 x, out float a, out vec2 b, out vec3 c, out ivec2 d, out uint e, out bool f, out vec4 "
      "g) {\n"
      "  a = x.x; b = x.yz; c = x.zyx; d = ivec2(x.xy); e = uint(x.w); f = x.x > 3.0; g = x.wzyx;\n}\n",
      {input<float4>("x"), output<float>("a"), output<float2>("b"), output<float3>("c"), output<int2>("d"),
       output<std::uint32_t>("e"), output<bool>("f"), output<float4>("g")});
  constexpr int count = 101;
  std::vector<float4> host(count);
  for (int i = 0; i < count; ++i) {
    const auto v = static_cast<float>(i);
    host[static_cast<std::size_t>(i)] = {v, v + 0.5f, -v, 2 * v};
  }
  auto x = device.stream<float4>(count);
  auto a = device.stream<float>(count);
  auto b = device.stream<float2>(count);
  auto c = device.stream<float3>(count);
  auto d = device.stream<int2>(count);
  auto e = device.stream<std::uint32_t>(count);
  auto f = device.stream<bool>(count);
  auto g = device.stream<float4>(count);
  x.write(host);
  split(x, a, b, c, d, e, f, g);
  for (std::size_t i = 0; i < count; i += 25) {
    const auto v = static_cast<float>(i);
    const auto n = static_cast<std::int32_t>(i);
    CHECK(a.read()[i] == v);
    CHECK(b.read()[i] == float2{v + 0.5f, -v});
    CHECK(c.read()[i] == float3{-v, v + 0.5f, v});
    CHECK(d.read()[i] == int2{n, n});
    CHECK(e.read()[i] == static_cast<std::uint32_t>(2 * n));
    CHECK((f.read()[i] != 0) == (n > 3));
    CHECK(g.read()[i] == float4{2 * v, -v, v + 0.5f, v});
  }
}

TEST_CASE("a stream may be read and written by one call") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 16);
  Device device({.profile = profile, .textureLimit = limit});
  const auto shape = GENERATE(Shape(12), Shape(201), Shape(13, 14), Shape(5, 6, 7));
  auto x = device.stream<float>(shape);
  x.write(counted(shape.size()));
  SECTION("whole, again and again") {
    for (int i = 0; i < 5; ++i) {
      increment()(x, x);
    }
    CHECK(x.read() == counted(shape.size(), 5));
  }
  SECTION("a part of it, at the same place") {
    const Index begin = Index::origin(shape.rank());
    Index end = begin;
    for (int d = 0; d < shape.rank(); ++d) {
      end[d] = shape[d] - 2;
    }
    const auto before = x.domain(begin, end).read();
    increment()(x.domain(begin, end), x.domain(begin, end));
    auto after = x.domain(begin, end).read();
    for (std::size_t i = 0; i < before.size(); ++i) {
      CHECK(after[i] == before[i] + 1);
    }
    CHECK(x.read().back() == static_cast<float>(shape.size() - 1));
  }
  SECTION("a part of it, moved, which is what was there before") {
    Index begin = Index::origin(shape.rank());
    Index end = begin;
    Index movedBegin = begin;
    Index movedEnd = begin;
    for (int d = 0; d < shape.rank(); ++d) {
      end[d] = shape[d] - 1;
      movedBegin[d] = 1;
      movedEnd[d] = shape[d];
    }
    const auto before = x.domain(begin, end).read();
    increment()(x.domain(begin, end), x.domain(movedBegin, movedEnd));
    const auto after = x.domain(movedBegin, movedEnd).read();
    for (std::size_t i = 0; i < before.size(); ++i) {
      CHECK(after[i] == before[i] + 1);
    }
    CHECK(x.read()[0] == 0);
  }
}

TEST_CASE("in place with a gather reads only what was there before") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 39);
  Device device({.profile = profile, .textureLimit = limit});
  static const TestKernel shift("shift", "void shift(out float r) { r = sk_near_a(ivec2(1, 0)); }\n",
                                {gather<float>("a", 2, program::Boundary::Wrap), output<float>("r")});
  auto a = device.stream<float>({40, 31});
  a.write(counted(40 * 31));
  shift(a, a);
  const auto result = a.read();
  for (std::size_t i = 0; i < result.size(); ++i) {
    REQUIRE(result[i] == static_cast<float>(i / 31 * 31 + (i % 31 + 1) % 31));
  }
}

TEST_CASE("structs in place") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 16);
  Device device({.profile = profile, .textureLimit = limit});
  static const TestKernel advance("advance",
                                  "void advance(Hit h, out Hit r) { r = h; r.t += 0.5; r.id -= 1; }\n",
                                  {input<Hit>("h"), output<Hit>("r")}, hitDeclaration);
  auto hits = device.stream<Hit>(100);
  std::vector<Hit> host(100);
  for (std::int32_t i = 0; i < 100; ++i) {
    host[static_cast<std::size_t>(i)] = {static_cast<float>(i), i};
  }
  hits.write(host);
  advance(hits, hits);
  advance(hits.domain(10, 20), hits.domain(10, 20));
  const auto result = hits.read();
  for (std::int32_t i = 0; i < 100; ++i) {
    const int times = i >= 10 && i < 20 ? 2 : 1;
    CHECK(result[static_cast<std::size_t>(i)] ==
          Hit{static_cast<float>(i) + 0.5f * static_cast<float>(times), i - times});
  }
}

TEST_CASE("outputs that lie differently") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device({.profile = profile, .textureLimit = limit});
  auto x = device.stream<float>({10, 10});
  x.write(counted(100));
  auto a = device.stream<float>({10, 10});
  SECTION("the second is a part of a larger stream") {
    auto b = device.stream<float>({20, 100});
    b.write(std::vector<float>(2000, -1.0f));
    two()(x, a, b.domain({5, 6}, {15, 16}));
    CHECK(a.read() == counted(100, 1));
    CHECK(b.domain({5, 6}, {15, 16}).read() == counted(100, 1000));
    CHECK(b.domain({0, 0}, {5, 100}).read() == std::vector<float>(500, -1.0f));
    CHECK(b.domain({5, 16}, {20, 100}).read() == std::vector<float>(15 * 84, -1.0f));
  }
  SECTION("the first is a part of a larger stream, at its start") {
    auto b = device.stream<float>({20, 100});
    b.write(std::vector<float>(2000, -1.0f));
    two()(x, b.domain({0, 0}, {10, 10}), a);
    CHECK(a.read() == counted(100, 1000));
    CHECK(b.domain({0, 0}, {10, 10}).read() == counted(100, 1));
    CHECK(b.domain({10, 0}, {20, 100}).read() == std::vector<float>(1000, -1.0f));
  }
  SECTION("both are parts of one stream") {
    auto b = device.stream<float>({20, 100});
    b.write(std::vector<float>(2000, -1.0f));
    two()(x, b.domain({0, 5}, {10, 15}), b.domain({10, 15}, {20, 25}));
    CHECK(b.domain({0, 5}, {10, 15}).read() == counted(100, 1));
    CHECK(b.domain({10, 15}, {20, 25}).read() == counted(100, 1000));
    CHECK(b.domain({0, 15}, {10, 100}).read() == std::vector<float>(850, -1.0f));
  }
  SECTION("both are parts of the stream that is read") {
    auto b = device.stream<float>({20, 100});
    b.write(counted(2000));
    const auto source = b.domain({0, 0}, {10, 10}).read();
    two()(b.domain({0, 0}, {10, 10}), b.domain({5, 5}, {15, 15}), b.domain({0, 20}, {10, 30}));
    const auto first = b.domain({5, 5}, {15, 15}).read();
    const auto second = b.domain({0, 20}, {10, 30}).read();
    for (std::size_t i = 0; i < 100; ++i) {
      CHECK(first[i] == source[i] + 1);
      CHECK(second[i] == source[i] + 1000);
    }
  }
  SECTION("one is linearised, the other not") {
    auto b = device.stream<float>({3, 5, 10});
    auto c = device.stream<float>({2, 5, 10});
    auto y = device.stream<float>({2, 5, 10});
    y.write(counted(100));
    b.write(std::vector<float>(150, -1.0f));
    two()(y, c, b.domain({1, 0, 0}, {3, 5, 10}));
    CHECK(c.read() == counted(100, 1));
    CHECK(b.domain({1, 0, 0}, {3, 5, 10}).read() == counted(100, 1000));
    CHECK(b.domain({0, 0, 0}, {1, 5, 10}).read() == std::vector<float>(50, -1.0f));
  }
}

TEST_CASE("bits are copied, not computed, on the way to an output that lies elsewhere") {
  const auto limit = GENERATE(0, 64);
  Device device({.textureLimit = limit});
  static const TestKernel keep("keep", "void keep(float x, out float a, out float b) { a = x; b = x; }\n",
                               {input<float>("x"), output<float>("a"), output<float>("b")});
  const std::vector<std::uint32_t> words{0x7f800001, 0xffc12345, 0x80000000,
                                         0x00000001, 0x7fc00000, 0x807fffff};
  std::vector<float> special(words.size());
  std::memcpy(special.data(), words.data(), 4 * words.size());
  auto x = device.stream<float>(special.size());
  auto a = device.stream<float>(special.size());
  auto large = device.stream<float>(100);
  x.write(special);
  keep(x, a, large.domain(20, 26));
  const auto result = large.domain(20, 26).read();
  CHECK(std::memcmp(result.data(), special.data(), 4 * words.size()) == 0);
}

TEST_CASE("eight planes may be written, a ninth is refused") {
  Device device;
  const int most = device.limits().drawBuffers;
  REQUIRE(most >= 4);
  std::string body = "void many(";
  std::vector<std::string> names;
  std::vector<program::Parameter> parameters;
  for (int i = 0; i <= most; ++i) {
    names.push_back("r" + std::to_string(i));
  }
  for (const std::string& name : names) {
    parameters.push_back(output<float>(name));
    body += (parameters.size() == 1 ? "out float " : ", out float ") + name;
  }
  body += ") {";
  for (std::size_t i = 0; i < names.size(); ++i) {
    body += " " + names[i] + " = " + std::to_string(i) + ".0;";
  }
  body += " }\n";
  std::vector<Stream<float>> streams;
  std::vector<Argument> arguments;
  for (std::size_t i = 0; i < names.size(); ++i) {
    streams.push_back(device.stream<float>(10));
    arguments.push_back({nullptr, regionOf(streams.back())});
  }
  const TestKernel many("many", body, parameters);
  const std::string error = errorOf([&] { run(many.kernel(), arguments); });
  CHECK(error == "many: the outputs have " + std::to_string(most + 1) +
                     " planes (one a scalar, vector, or member of a struct), but this device writes " +
                     std::to_string(most) + " in one kernel; divide the kernel");
}
