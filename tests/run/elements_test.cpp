// SPDX-License-Identifier: MIT
//
// Elements, structs and uniforms of every type, in every layout: a kernel passes them on bit for bit.
#include <bit>
#include <limits>

#include "streams.sk.hpp"
#include "support/devices.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

/// Shapes of every rank: empty, one element, prime extents, rows longer than a texture of the small devices.
const std::vector<sk::Shape> shapes = {
    {0},     {1},     {2},      {64},      {65},      {1021},       {0, 3},       {1, 1},       {13, 17},
    {1, 67}, {67, 1}, {61, 65}, {3, 5, 7}, {4, 0, 2}, {2, 3, 4, 5}, {1, 1, 1, 1}, {3, 1, 67, 2}};

template <class T, class Kernel>
void checkKept(sk::Device& device, const sk::Shape& shape, const Kernel& kernel) {
  using T2 = sk::Vector2<T>;
  using T3 = sk::Vector3<T>;
  using T4 = sk::Vector4<T>;
  const auto a = values<T>(shape.size());
  const auto b = values<T2>(shape.size());
  const auto c = values<T3>(shape.size());
  const auto d = values<T4>(shape.size());
  auto a2 = device.stream<T>(shape);
  auto b2 = device.stream<T2>(shape);
  auto c2 = device.stream<T3>(shape);
  auto d2 = device.stream<T4>(shape);
  kernel(streamOf<T>(device, shape, a), streamOf<T2>(device, shape, b), streamOf<T3>(device, shape, c),
         streamOf<T4>(device, shape, d), a2, b2, c2, d2);
  CHECK(difference(a2.read(), a) == "");
  CHECK(difference(b2.read(), [&](std::size_t i) { return T2{b[i].y, b[i].x}; }) == "");
  CHECK(difference(c2.read(), [&](std::size_t i) { return T3{c[i].z, c[i].x, c[i].y}; }) == "");
  CHECK(difference(d2.read(), [&](std::size_t i) { return T4{d[i].w, d[i].z, d[i].y, d[i].x}; }) == "");
}

streams::Mark markAt(std::uint32_t i) {
  return {
      valueAt<sk::uint2>(i), {valueAt<sk::float3>(i), valueAt<bool>(i)}, int(valueAt<std::uint32_t>(i) >> 2)};
}

std::string differenceOfMarks(const std::vector<streams::Mark>& actual,
                              const std::vector<streams::Mark>& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool isSameMark = actual[i].id == expected[i].id && actual[i].place.at == expected[i].place.at &&
                            actual[i].place.isSet == expected[i].place.isSet &&
                            actual[i].weight == expected[i].weight;
    if (!isSameMark) return "mark " + std::to_string(i) + " differs";
  }
  return actual.size() == expected.size() ? "" : "another number of marks";
}

}  // namespace

TEST_CASE("elements of every type go in and come out, whatever the shape") {
  onEveryLayout([](sk::Device& device) {
    for (const sk::Shape& shape : shapes) {
      INFO("shape " << sk::toString(shape));
      checkKept<float>(device, shape, streams::keep_float);
      if (shape.rank() > 2) continue;   // the layout does not depend on the type
      checkKept<int>(device, shape, streams::keep_int);
      checkKept<std::uint32_t>(device, shape, streams::keep_uint);
      checkKept<bool>(device, shape, streams::keep_bool);
    }
  });
}

TEST_CASE("what is special in float is kept bit for bit") {
  using Limits = std::numeric_limits<float>;
  // No NaN with a payload, which a device may change, and no denormal, which a kernel may flush to 0.
  const std::vector<float> special = {0.0f,
                                      -0.0f,
                                      Limits::infinity(),
                                      -Limits::infinity(),
                                      Limits::max(),
                                      Limits::min(),
                                      Limits::epsilon(),
                                      16777217.0f,
                                      Limits::quiet_NaN()};
  const auto count = static_cast<std::int64_t>(special.size());
  onSomeLayouts([&](sk::Device& device) {
    const auto x = streamOf<float>(device, special);
    CHECK(difference(x.read(), [&](std::size_t i) { return special[i]; }) == "");
    auto y = device.stream<float>({count});
    auto y2 = device.stream<sk::float2>({count});
    auto y3 = device.stream<sk::float3>({count});
    auto y4 = device.stream<sk::float4>({count});
    streams::keep_float(x, streamOf<sk::float2>(device, values<sk::float2>(count)),
                        streamOf<sk::float3>(device, values<sk::float3>(count)),
                        streamOf<sk::float4>(device, values<sk::float4>(count)), y, y2, y3, y4);
    const auto read = y.read();
    for (std::size_t i = 0; i + 1 < special.size(); ++i) {
      CHECK(std::bit_cast<std::uint32_t>(read[i]) == std::bit_cast<std::uint32_t>(special[i]));
    }
    CHECK(std::isnan(read.back()));
  });
}

TEST_CASE("structs lie in planes and come back whole") {
  onEveryLayout([](sk::Device& device) {
    for (const sk::Shape& shape : {sk::Shape{1}, sk::Shape{131}, sk::Shape{11, 13}, sk::Shape{3, 4, 5}}) {
      INFO("shape " << sk::toString(shape));
      std::vector<streams::Mark> marks;
      for (std::uint32_t i = 0; i < shape.size(); ++i) marks.push_back(markAt(i));
      const auto input = streamOf<streams::Mark>(device, shape, marks);
      CHECK(differenceOfMarks(input.read(), marks) == "");
      auto output = device.stream<streams::Mark>(shape);
      streams::move(input, {1, 2, 3}, output);
      std::vector<streams::Mark> moved = marks;
      for (streams::Mark& m : moved) {
        m.place.at = {m.place.at.y + 2, m.place.at.x + 1, m.place.at.z + 3};
        m.place.isSet = !m.place.isSet;
        m.weight -= int(m.id.x & 0xffu);
        m.id.y ^= 0x80000000u;
      }
      CHECK(differenceOfMarks(output.read(), moved) == "");
    }
  });
}

TEST_CASE("structs are made from scalars and taken apart") {
  const auto x = values<float>(97);
  auto n = values<int>(97);
  for (int& k : n) k = k % 1000;
  onSomeLayouts([&](sk::Device& device) {
    auto marks = device.stream<streams::Mark>({97});
    streams::makeMark(streamOf<float>(device, x), streamOf<int>(device, n), marks);
    auto sum = device.stream<float>({97});
    auto weight = device.stream<int>({97});
    streams::weigh(marks, sum, weight);
    CHECK(difference(sum.read(), [&](std::size_t i) { return n[i] > 0 ? x[i] * 3 + float(n[i]) : 0.0f; }) ==
          "");
    CHECK(difference(weight.read(), [&](std::size_t i) { return 7 - n[i]; }) == "");
  });
}

namespace {

template <class T, class Kernel>
void checkUniforms(sk::Device& device, const Kernel& kernel) {
  for (std::uint32_t round = 0; round < 3;
       ++round) {   // the same program with other values, then with the first values again
    const std::uint32_t seed = round % 2 * 40;
    const T a = valueAt<T>(seed);
    const auto b = valueAt<sk::Vector2<T>>(seed + 1);
    const auto c = valueAt<sk::Vector3<T>>(seed + 2);
    const auto d = valueAt<sk::Vector4<T>>(seed + 3);
    auto r = device.stream<sk::Vector4<T>>({3});
    auto s = device.stream<sk::Vector4<T>>({3});
    kernel(a, b, c, d, streamOf<T>(device, values<T>(3)), r, s);
    CHECK(difference(r.read(),
                     [&](std::size_t i) { return i == 1 ? d : sk::Vector4<T>{a, b.x, b.y, c.x}; }) == "");
    CHECK(difference(s.read(), [&](std::size_t) { return sk::Vector4<T>{c.y, c.z, d.w, d.x}; }) == "");
  }
}

}  // namespace

TEST_CASE("uniforms of every type reach the kernel") {
  onEveryTarget([](sk::Device& device) {
    checkUniforms<float>(device, streams::uniform_float);
    checkUniforms<int>(device, streams::uniform_int);
    checkUniforms<std::uint32_t>(device, streams::uniform_uint);
    checkUniforms<bool>(device, streams::uniform_bool);
  });
}

TEST_CASE("structs are uniforms, member by member") {
  onGlAndNative([](sk::Device& device) {
    const streams::Settings s = {2, {false, {5, -6}}, {7, 8, 9}, {true, false, true}, {1, 2, 3, 4}};
    const auto x = streamOf<float>(device, {0.5f, 1.5f});
    auto a = device.stream<sk::float4>({2});
    auto b = device.stream<sk::int4>({2});
    streams::uniform_struct(s, x, 11, {true, {12, 13}}, a, b);
    CHECK(a.read() == std::vector<sk::float4>{{2.5f, 4.5f, 6.5f, 8.5f}, {3.5f, 5.5f, 7.5f, 9.5f}});
    CHECK(b.read() == std::vector<sk::int4>(2, {5 + 7 + 90, -6 + 1 + 4 + 8, 11, 13}));
    streams::Settings t = s;
    t.inner.isOn = true;
    streams::uniform_struct(t, x, 11, {false, {12, 13}}, a, b);
    CHECK(a.read()[1] == sk::float4{-1, 5.5f, 7.5f, 9.5f});
    CHECK(b.read()[0].y == -6 + 1 + 4);
  });
}

TEST_CASE("one call writes several outputs of different types") {
  std::vector<int> n;
  for (int i = 0; i < 300; ++i) n.push_back(i);
  onSomeLayouts([&](sk::Device& device) {
    const sk::Shape shape{3, 100};
    auto a = device.stream<float>(shape);
    auto b = device.stream<sk::int3>(shape);
    auto c = device.stream<bool>(shape);
    auto d = device.stream<sk::uint2>(shape);
    streams::manyOutputs(streamOf<int>(device, shape, n), a, b, c, d);
    CHECK(difference(a.read(), [](std::size_t i) { return float(i) * 0.5f; }) == "");
    CHECK(difference(b.read(), [](std::size_t i) { return sk::int3{int(i), int(i) + 1, int(i) + 2}; }) == "");
    CHECK(difference(c.read(), [](std::size_t i) { return std::uint8_t(i & 1u); }) == "");
    CHECK(difference(d.read(), [](std::size_t i) { return sk::uint2{unsigned(i), 3 * unsigned(i)}; }) == "");
  });
}

TEST_CASE("writing a stream after a call changes no other stream") {
  onSomeLayouts([](sk::Device& device) {
    for (const sk::Shape& shape : {sk::Shape{10}, sk::Shape{5, 70}}) {
      const auto first = values<int>(shape.size(), 1), second = values<int>(shape.size(), 2);
      auto x = streamOf<int>(device, shape, values<int>(shape.size()));
      const auto y = streamOf<int>(device, shape, first);
      auto r = device.stream<int>(shape);
      streams::add(x, y, r);
      x.write(second);
      CHECK(difference(x.read(), second) == "");
      CHECK(difference(y.read(), first) == "");
      streams::add(x, y, r);
      CHECK(difference(r.read(),
                       [&](std::size_t i) { return int(unsigned(first[i]) + unsigned(second[i])); }) == "");
    }
  });
}
