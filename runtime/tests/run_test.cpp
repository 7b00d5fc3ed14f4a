// SPDX-License-Identifier: MIT
//
// Kernels over streams: types, uniforms, shapes, layouts, repeated inputs, indices.
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "elements.hpp"
#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

const TestKernel& indices() {
  static const TestKernel kernel("indices", "void indices(out ivec4 r) { r = sk_index(); }\n",
                                 {output<int4>("r")});
  return kernel;
}

std::vector<float> steps(std::int64_t count, float step = 1.0f) {
  std::vector<float> values(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = step * static_cast<float>(i);
  }
  return values;
}

/// The index of element `number` of a shape, x first.
int4 kernelIndexOf(std::int64_t number, const Shape& shape) {
  std::int32_t index[4] = {0, 0, 0, 0};
  for (int d = shape.rank() - 1; d >= 0; --d) {
    index[shape.rank() - 1 - d] = static_cast<std::int32_t>(number % shape[d]);
    number /= shape[d];
  }
  return {index[0], index[1], index[2], index[3]};
}

}  // namespace

TEST_CASE("a kernel runs over each element of any shape") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device({.profile = profile, .textureLimit = limit});
  const std::vector<Shape> shapes{{0},       {1},       {2},          {64},        {65},     {1021},
                                  {4095},    {4096},    {3, 5},       {0, 3},      {64, 64}, {61, 67},
                                  {2, 3, 4}, {1, 1, 1}, {16, 16, 16}, {3, 1, 5, 7}};
  for (const Shape& shape : shapes) {
    INFO("shape " << toString(shape));
    auto x = device.stream<float>(shape);
    auto y = device.stream<float>(shape);
    auto r = device.stream<float>(shape);
    const auto hostX = steps(shape.size());
    const auto hostY = steps(shape.size(), -2.0f);
    x.write(hostX);
    y.write(hostY);
    const float a = 0.5f;
    saxpy()(a, x, y, r);
    std::vector<float> expected(hostX.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      expected[i] = a * hostX[i] + hostY[i];
    }
    CHECK(r.read() == expected);
    auto index = device.stream<int4>(shape);
    indices()(index);
    std::vector<int4> expectedIndex(hostX.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      expectedIndex[i] = kernelIndexOf(static_cast<std::int64_t>(i), shape);
    }
    CHECK(index.read() == expectedIndex);
  }
}

TEST_CASE("an argument that changes between calls is seen") {
  Device device;
  auto x = device.stream<float>(4);
  auto r = device.stream<float>(4);
  x.write(steps(4));
  for (const float a : {1.0f, 2.0f, 2.0f, -3.0f}) {
    saxpy()(a, x, x, r);
    CHECK(r.read() == steps(4, a + 1));
  }
}

TEST_CASE("uniform arguments of every type arrive") {
  const auto profile = GENERATE(from_range(profileNames));
  Device device({.profile = profile});
  static const TestKernel kernel(
      "uniforms",
      "void uniforms(bool a, bvec3 b, int c, ivec2 d, uint e, uvec4 f, vec3 g, Hit h, out vec4 r) {\n"
      "  r = vec4(float(a) + 2.0 * float(b.x) + 4.0 * float(b.y) + 8.0 * float(b.z), float(c) + 10.0 * "
      "float(d.x) + 100.0 * float(d.y),\n"
      "           float(e) + float(f.x + f.y * 10u + f.z * 100u + f.w * 1000u), dot(g, vec3(1.0, 10.0, "
      "100.0)) + h.t + 1000.0 * float(h.id));\n"
      "}\n",
      {uniform<bool>("a"), uniform<bool3>("b"), uniform<std::int32_t>("c"), uniform<int2>("d"),
       uniform<std::uint32_t>("e"), uniform<uint4>("f"), uniform<float3>("g"), uniform<Hit>("h"),
       output<float4>("r")},
      hitDeclaration);
  auto r = device.stream<float4>(1);
  kernel(true, bool3{true, false, true}, 3, int2{4, -5}, 6u, uint4{1, 2, 3, 4}, float3{1, 2, 3}, Hit{0.5f, 7},
         r);
  CHECK(r.read() == std::vector<float4>{{11, -457, 4327, 7321.5f}});
  kernel(false, bool3{false, true, false}, -3, int2{4, 5}, 0u, uint4{0, 0, 0, 1}, float3{0, 0, 0},
         Hit{0.25f, 0}, r);
  CHECK(r.read() == std::vector<float4>{{4, 537, 1000, 0.25f}});
}

TEST_CASE("inputs and outputs of structs and bools") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 16);
  Device device({.profile = profile, .textureLimit = limit});
  static const TestKernel kernel(
      "age",
      "void age(Particle p, bool kill, out Particle r, out bool was) {\n"
      "  was = p.alive;\n  r = p;\n  r.position += vec3(1.0);\n  r.alive = p.alive && !kill;\n  r.cell = "
      "p.cell.yx;\n"
      "  r.flags = not(p.flags);\n  r.color = p.color ^ 0xffu;\n}\n",
      {input<Particle>("p"), input<bool>("kill"), output<Particle>("r"), output<bool>("was")},
      particleDeclaration);
  constexpr std::size_t count = 199;
  std::vector<Particle> particles(count);
  std::vector<std::uint8_t> kill(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<std::int32_t>(i);
    particles[i] = {{static_cast<float>(n), 0, -1},
                    n % 3 != 0,
                    {n, -n},
                    {n % 2 == 0, true, false},
                    static_cast<std::uint32_t>(n)};
    kill[i] = n % 5 == 0;
  }
  auto p = device.stream<Particle>(count);
  auto k = device.stream<bool>(count);
  auto r = device.stream<Particle>(count);
  auto was = device.stream<bool>(count);
  p.write(particles);
  k.write(kill);
  kernel(p, k, r, was);
  const auto result = r.read();
  const auto wasAlive = was.read();
  for (std::size_t i = 0; i < count; ++i) {
    const Particle& from = particles[i];
    const Particle expected{{from.position.x + 1, 1, 0},
                            from.alive && kill[i] == 0,
                            {from.cell.y, from.cell.x},
                            {!from.flags.x, !from.flags.y, !from.flags.z},
                            from.color ^ 0xffu};
    CHECK(result[i] == expected);
    CHECK((wasAlive[i] != 0) == from.alive);
  }
}

TEST_CASE("an input of extent 1 repeats") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 8);
  Device device({.profile = profile, .textureLimit = limit});
  static const TestKernel add("add", "void add(float a, float b, out float r) { r = a + b; }\n",
                              {input<float>("a"), input<float>("b"), output<float>("r")});
  auto column = device.stream<float>({5, 1});
  auto row = device.stream<float>({1, 11});
  auto r = device.stream<float>({5, 11});
  column.write(steps(5, 100));
  row.write(steps(11));
  add(column, row, r);
  const auto result = r.read();
  for (std::size_t i = 0; i < result.size(); ++i) {
    CHECK(result[i] == static_cast<float>(i / 11 * 100 + i % 11));
  }
  auto one = device.stream<float>({1, 1, 1});
  auto box = device.stream<float>({2, 3, 4});
  auto sum = device.stream<float>({2, 3, 4});
  one.write(std::vector<float>{1000});
  box.write(steps(24));
  add(one, box, sum);
  CHECK(sum.read()[23] == 1023);
  CHECK(sum.read()[0] == 1000);
}

TEST_CASE("views as inputs and outputs") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device({.profile = profile, .textureLimit = limit});
  static const TestKernel copyIndex(
      "copyIndex",
      "void copyIndex(float x, out float r, out ivec4 i) { r = x; i = sk_index_x() * 100 + sk_index(); }\n",
      {input<float>("x"), output<float>("r"), output<int4>("i")});
  const Shape shape(30, 70);
  auto x = device.stream<float>(shape);
  auto r = device.stream<float>(shape);
  auto index = device.stream<int4>({10, 20});
  x.write(steps(shape.size()));
  r.write(std::vector<float>(static_cast<std::size_t>(shape.size()), -1.0f));
  SECTION("from one place to another") {
    copyIndex(x.domain({3, 5}, {13, 25}), r.domain({15, 18}, {25, 38}), index);
    const auto result = r.read();
    for (std::size_t row = 0; row < 30; ++row) {
      for (std::size_t column = 0; column < 70; ++column) {
        const bool inside = row >= 15 && row < 25 && column >= 18 && column < 38;
        const auto expected = static_cast<float>((row - 12) * 70 + column - 13);
        CHECK(result[row * 70 + column] == (inside ? expected : -1.0f));
      }
    }
    const auto indexes = index.read();
    CHECK(indexes[0] == int4{0, 0, 0, 0});
    CHECK(indexes[21] == int4{101, 101, 0, 0});
    CHECK(indexes[199] == int4{19 * 101, 9 * 101, 0, 0});
  }
  SECTION("at the same place") {
    copyIndex(x.domain({3, 5}, {13, 25}), r.domain({3, 5}, {13, 25}), index);
    const auto view = r.domain({3, 5}, {13, 25});
    CHECK(view.read() == x.domain({3, 5}, {13, 25}).read());
    CHECK(r.read()[0] == -1.0f);
    CHECK(r.read()[29 * 70 + 69] == -1.0f);
  }
  SECTION("of no element") {
    copyIndex(x.domain({3, 5}, {3, 25}), r.domain({4, 5}, {4, 25}), index.domain({0, 0}, {0, 20}));
    CHECK(r.read() == std::vector<float>(static_cast<std::size_t>(shape.size()), -1.0f));
  }
}

TEST_CASE("views of linearised streams of any rank") {
  const auto profile = GENERATE(from_range(profileNames));
  Device device({.profile = profile, .textureLimit = 64});
  static const TestKernel negate("negate", "void negate(float x, out float r) { r = -x; }\n",
                                 {input<float>("x"), output<float>("r")});
  const auto shape = GENERATE(Shape(1000), Shape(100, 33), Shape(7, 9, 11), Shape(3, 4, 5, 6));
  auto x = device.stream<float>(shape);
  auto r = device.stream<float>(shape);
  x.write(steps(shape.size()));
  r.write(std::vector<float>(static_cast<std::size_t>(shape.size()), 0.5f));
  Index begin = Index::origin(shape.rank());
  Index end = begin;
  for (int d = 0; d < shape.rank(); ++d) {
    begin[d] = 1;
    end[d] = shape[d] - 1;
  }
  negate(x.domain(begin, end), r.domain(begin, end));
  const auto result = r.read();
  for (std::size_t i = 0; i < result.size(); ++i) {
    bool isInside = true;
    auto rest = static_cast<std::int64_t>(i);
    for (int d = shape.rank() - 1; d >= 0; --d) {
      isInside = isInside && rest % shape[d] >= 1 && rest % shape[d] < shape[d] - 1;
      rest /= shape[d];
    }
    REQUIRE(result[i] == (isInside ? -static_cast<float>(i) : 0.5f));
  }
}

TEST_CASE("what lies beside the domain never runs a kernel") {
  // The loop ends on the elements, but on no other value that a texture or the space around it may hold: a single fragment
  // outside the domain would keep the device busy until its driver gives up.
  const auto profile = GENERATE(from_range(profileNames));
  Device device({.profile = profile, .textureLimit = 64});
  static const TestKernel doublings(
      "doublings",
      "void doublings(float x, out float r) { r = 0.0; while (x < 5.0) { x *= 2.0; r += 1.0; } }\n",
      {input<float>("x"), output<float>("r")});
  auto poison = device.stream<float>({64, 64});
  poison.write(std::vector<float>(64 * 64, -1.0f));
  {
    auto released = std::move(poison);
  }
  const auto shape = GENERATE(Shape(1), Shape(33), Shape(31, 33), Shape(65), Shape(1023), Shape(1025),
                              Shape(4033), Shape(3, 5, 7));
  auto x = device.stream<float>(shape);
  auto r = device.stream<float>(shape);
  x.write(std::vector<float>(static_cast<std::size_t>(shape.size()), 1.0f));
  r.write(std::vector<float>(static_cast<std::size_t>(shape.size()), 0.0f));
  doublings(x, r);
  CHECK(r.read() == std::vector<float>(static_cast<std::size_t>(shape.size()), 3.0f));
}

TEST_CASE("elements beside a view never run its kernel") {
  const auto profile = GENERATE(from_range(profileNames));
  Device device({.profile = profile, .textureLimit = 64});
  static const TestKernel halvings(
      "halvings",
      "void halvings(float x, out float r) { r = 0.0; while (x > 1.0) { x *= 0.5; r += 1.0; } }\n",
      {input<float>("x"), output<float>("r")});
  const auto width = GENERATE(as<std::int64_t>{}, 33, 99);
  auto x = device.stream<float>({30, width});
  auto r = device.stream<float>({30, width});
  x.write(std::vector<float>(static_cast<std::size_t>(30 * width), std::numeric_limits<float>::infinity()));
  const auto from = x.domain({3, 5}, {20, 20});
  const auto to = r.domain({3, 5}, {20, 20});
  from.write(std::vector<float>(17 * 15, 16.0f));
  halvings(from, to);
  CHECK(to.read() == std::vector<float>(17 * 15, 4.0f));
}
