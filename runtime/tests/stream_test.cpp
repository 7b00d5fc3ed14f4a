// SPDX-License-Identifier: MIT
//
// A stream gives back what was written to it, bit for bit, in every type, shape, layout and profile, as a whole and in
// parts.
#include <bit>
#include <cstring>
#include <stdexcept>
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

using namespace std::string_literals;

const std::string noStream =
    "there is no stream: it was default-constructed or moved from; make one by device.stream<T>(shape)";

Device makeDevice(const std::string& profile, int textureLimit = 0) {
  return Device({.profile = profile, .textureLimit = textureLimit});
}

}  // namespace

TEMPLATE_TEST_CASE("a stream gives back what was written", "", float, float2, float3, float4, std::int32_t,
                   int2, int3, int4, std::uint32_t, uint2, uint3, uint4) {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device = makeDevice(profile, limit);
  const std::vector<Shape> shapes{
      {0},       {1},       {7},          {64},           {65},           {1021},  {4096},
      {3, 5},    {1, 1},    {5, 0},       {64, 64},       {65, 3},        {3, 65}, {2, 3, 4},
      {1, 1, 1}, {7, 0, 2}, {3, 1, 5, 7}, {13, 11, 3, 2}, {1, 1, 1, 4095}};
  for (const Shape& shape : shapes) {
    auto stream = device.stream<TestType>(shape);
    const auto elements = patterned<TestType>(static_cast<std::size_t>(shape.size()));
    stream.write(elements);
    INFO("shape " << toString(shape));
    CHECK(haveSameBits(stream.read(), elements));
    std::vector<TestType> memory(elements.size());
    stream.read(memory);
    CHECK(haveSameBits(memory, elements));
  }
}

TEST_CASE("floats keep their bits: NaN payloads, infinities, denormals, zeros") {
  const auto profile = GENERATE(from_range(profileNames));
  Device device = makeDevice(profile);
  SECTION("chosen ones") {
    const std::vector<std::uint32_t> words{0x00000000, 0x80000000, 0x00000001, 0x807fffff,
                                           0x00800000, 0x7f7fffff, 0x7f800000, 0xff800000,
                                           0x7f800001, 0xffbfffff, 0x7fc00000, 0xffffffff};
    std::vector<float> floats(words.size());
    std::memcpy(floats.data(), words.data(), words.size() * 4);
    auto stream = device.stream<float>(floats.size());
    stream.write(floats);
    CHECK(haveSameBits(stream.read(), floats));
  }
  SECTION("one in 256 of all there are") {
    Device large = makeDevice(profile, 4096);
    auto stream = large.stream<float>({4096, 4096});
    const auto floats = patterned<float>(4096u * 4096u);
    stream.write(floats);
    CHECK(haveSameBits(stream.read(), floats));
  }
}

TEST_CASE("streams of bool take and give bools and bytes") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device = makeDevice(profile, limit);
  auto stream = device.stream<bool>(101);
  std::vector<std::uint8_t> bytes(101);
  std::vector<bool> bits(101);
  std::array<bool, 101> bools{};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bits[i] = bools[i] = (i * i / 7) % 2 == 1;
    bytes[i] = bools[i] ? static_cast<std::uint8_t>(1 + i) : 0;
  }
  SECTION("an array of bool") { stream.write(bools); }
  SECTION("bytes, of which any but 0 is true") { stream.write(bytes); }
  SECTION("a std::vector<bool>") { stream.write(bits); }
  SECTION("what another stream gave") {
    auto other = device.stream<bool>(101);
    other.write(bools);
    stream.write(other.read());
  }
  std::array<bool, 101> memory{};
  stream.read(memory);
  CHECK(memory == bools);
  const std::vector<std::uint8_t> read = stream.read();
  for (std::size_t i = 0; i < read.size(); ++i) {
    CHECK(read[i] == static_cast<std::uint8_t>(bools[i]));
  }
}

TEST_CASE("vectors of bool keep their components") {
  const auto profile = GENERATE(from_range(profileNames));
  Device device = makeDevice(profile);
  auto pairs = device.stream<bool2>(3);
  const std::vector<bool2> two{{true, false}, {false, true}, {true, true}};
  pairs.write(two);
  CHECK(pairs.read() == two);
  auto triples = device.stream<bool3>({2, 2});
  const std::vector<bool3> three{
      {true, false, true}, {false, true, false}, {true, true, true}, {false, false, false}};
  triples.write(three);
  CHECK(triples.read() == three);
}

TEST_CASE("structs keep their members") {
  const auto profile = GENERATE(from_range(profileNames));
  const auto limit = GENERATE(0, 64);
  Device device = makeDevice(profile, limit);
  const auto count = GENERATE(as<std::size_t>{}, 1, 37, 1031);
  std::vector<Particle> particles(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<std::int32_t>(i);
    particles[i] = {{0.5f * static_cast<float>(n), -1.0f, 3.0f},
                    n % 3 == 0,
                    {-n, n * 7},
                    {n % 2 == 0, true, n % 5 == 0},
                    0xffffffffu - static_cast<std::uint32_t>(n)};
  }
  auto stream = device.stream<Particle>(count);
  stream.write(particles);
  CHECK(stream.read() == particles);
  for (int plane = 0; plane < 5; ++plane) {
    CHECK(stream.texture(plane).name != 0);
  }
}

TEST_CASE("a view of structs and of a view") {
  const auto limit = GENERATE(0, 64);
  Device device = makeDevice("essl300", limit);
  auto stream = device.stream<Hit>({50, 70});
  std::vector<Hit> hits(50 * 70);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    hits[i] = {static_cast<float>(i), static_cast<std::int32_t>(i)};
  }
  stream.write(hits);
  const auto view = stream.domain({10, 20}, {45, 65}).domain({5, 1}, {7, 4});
  CHECK(view.shape() == Shape(2, 3));
  CHECK(view.read() == std::vector<Hit>{hits[15 * 70 + 21], hits[15 * 70 + 22], hits[15 * 70 + 23],
                                        hits[16 * 70 + 21], hits[16 * 70 + 22], hits[16 * 70 + 23]});
  const Stream<Hit>& constant = stream;
  CHECK(constant.domain({0, 0}, {1, 1}).read() == std::vector<Hit>{hits[0]});
}

TEST_CASE("a stream tells where its elements are") {
  Device device({.textureLimit = 64});
  auto plane = device.stream<float>({3, 5});
  CHECK(plane.texture().width == 5);
  CHECK(plane.texture().height == 3);
  CHECK_FALSE(plane.texture().linear);
  CHECK(plane.texture().internalFormat == 0x822E);
  auto linear = device.stream<float4>(1000);
  CHECK(linear.texture().linear);
  CHECK(linear.texture().width == 32);
  CHECK(linear.texture().height == 32);
  auto empty = device.stream<float>({0, 4});
  CHECK(empty.texture().name == 0);
  CHECK(empty.shape() == Shape(0, 4));
  CHECK(empty.size() == 0);
}

TEST_CASE("a stream may be default-constructed, and be set later") {
  struct Simulation {
    Stream<float> field;
  };
  Simulation simulation;
  CHECK_FALSE(simulation.field);
  CHECK(simulation.field.size() == 0);
  CHECK(errorOf([&] { simulation.field.write(std::vector<float>{1}); }) == "write: "s + noStream);
  CHECK(errorOf([&] { (void)simulation.field.readAsync(); }) == "readAsync: "s + noStream);
  Device device;
  simulation.field = device.stream<float>(2);
  CHECK(simulation.field);
  simulation.field.write(std::vector<float>{1, 2});
  CHECK(simulation.field.read() == std::vector<float>{1, 2});
}

TEST_CASE("errors say of which kind they are") {
  Device device;
  auto stream = device.stream<float>(3);
  const auto kindOf = [](auto&& action) {
    try {
      action();
    } catch (const Error& error) {
      return error.kind();
    }
    throw std::logic_error("nothing was thrown");
  };
  using Kind = Error::Kind;
  CHECK(kindOf([] { Device("gpu:x"); }) == Kind::Device);
  CHECK(kindOf([&] { stream.write(std::vector<float>(4)); }) == Kind::Shape);
  CHECK(kindOf([&] { device.stream<float>({std::int64_t{1} << 40, std::int64_t{1} << 40}); }) == Kind::Shape);
  CHECK(kindOf([&] { device.stream<std::int32_t>(3).readReals(); }) == Kind::Type);
  CHECK(kindOf([&] { (void)Stream<float>().read(); }) == Kind::Lost);
  CHECK(kindOf([] { Device({.configuration = "no/such/file.toml"}); }) == Kind::File);
  CHECK(kindOf([&] { (void)device.passCount(); }) == Kind::Misuse);
  CHECK(Error("of an application").kind() == Kind::Misuse);
}

TEST_CASE("streams and devices move") {
  Device first;
  auto a = first.stream<float>(3);
  a.write(std::vector<float>{1, 2, 3});
  Device second = std::move(first);
  auto b = std::move(a);
  CHECK(b.read() == std::vector<float>{1, 2, 3});
  auto c = second.stream<float>(2);
  c.write(std::vector<float>{4, 5});
  b = std::move(c);
  CHECK(b.read() == std::vector<float>{4, 5});
  CHECK(errorOf([&] { first.stream<float>(1); }) == "the device was moved from");
  CHECK(errorOf([&] { (void)a.read(); }) == "read: "s + noStream);
  CHECK(errorOf([&] { a.domain(0, 0); }) == "domain: "s + noStream);
  CHECK(errorOf([&] { (void)a.texture(); }) == "texture: "s + noStream);
  CHECK(a.size() == 0);
}

namespace {

/// Compares fill() and copyTo() of a stream and of its parts with the same on the host.
template <class T>
void checkFillAndCopy(Device& device, const Shape& shape) {
  INFO(device.name() << ", " << device.profile() << ", shape " << toString(shape));
  const std::vector<T> given = patterned<T>(static_cast<std::size_t>(shape.size()));
  const T value = patterned<T>(2).back();
  auto x = device.stream<T>(shape);
  auto y = device.stream<T>(shape);
  x.write(given);
  y.fill(value);
  CHECK(haveSameBits(y.read(), std::vector<T>(given.size(), value)));
  x.copyTo(y);
  CHECK(haveSameBits(y.read(), given));

  // a box at (1, 2), and one that overlaps it
  const std::int64_t rows = shape[0] - 2, columns = shape[1] - 3;
  std::vector<T> expected = given;
  const auto at = [&](std::int64_t row, std::int64_t column) {
    return static_cast<std::size_t>(row * shape[1] + column);
  };
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t column = 0; column < columns; ++column) expected[at(row + 1, column + 2)] = value;
  }
  y.domain({1, 2}, {rows + 1, columns + 2}).fill(value);
  CHECK(haveSameBits(y.read(), expected));

  expected = given;
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t column = 0; column < columns; ++column)
      expected[at(row + 1, column + 2)] = given[at(row, column)];
  }
  x.domain({0, 0}, {rows, columns}).copyTo(x.domain({1, 2}, {rows + 1, columns + 2}));
  CHECK(haveSameBits(x.read(), expected));
}

}  // namespace

TEST_CASE("streams are filled and copied on the device, in whole and in parts") {
  const auto check = [](Device& device) {
    for (const Shape& shape : {Shape{5, 8}, Shape{6, 7}, Shape{70, 68}}) {
      checkFillAndCopy<float>(device, shape);
      checkFillAndCopy<int3>(device, shape);
      checkFillAndCopy<Hit>(device, shape);
    }
  };
  SECTION("with GL") {
    Device device = makeDevice(GENERATE(from_range(profileNames)), 64);
    check(device);
  }
  SECTION("natively") {
    Device device = Device::native();
    check(device);
  }
}

TEST_CASE("streams are copied between storages, devices and precisions") {
  Device device = makeDevice({});
  Device reference = Device::reference();
  const std::vector<float> values{0.1F, -2.5F, 65504.0F, 1e-7F, 3.0F};
  auto x = device.stream<float>({5});
  x.write(values);
  SECTION("to halves and back, rounded to nearest") {
    auto halves = device.stream<float>({5}, Storage::Half);
    auto back = device.stream<float>({5});
    x.copyTo(halves);
    halves.copyTo(back);
    CHECK(back.read() == halves.read());
    CHECK(back.read()[0] == float{half(0.1F)});
    halves.fill(0.1F);
    CHECK(halves.read() == std::vector<float>(5, float{half(0.1F)}));
  }
  SECTION("to another device") {
    auto y = reference.stream<float>({5});
    x.copyTo(y);
    CHECK(y.read() == values);
  }
  SECTION("doubles of a reference stay doubles") {
    auto y = reference.stream<float>({2});
    auto z = reference.stream<float>({2});
    y.writeReals(std::vector<double>{0.1, 1.0 / 3});
    y.copyTo(z);
    CHECK(z.readReals() == std::vector<double>{0.1, 1.0 / 3});
  }
  SECTION("bools, and what is empty") {
    auto flags = device.stream<bool>({3});
    flags.fill(true);
    CHECK(flags.read() == std::vector<std::uint8_t>{1, 1, 1});
    auto none = device.stream<float>({0});
    none.fill(1);
    none.copyTo(none);
    CHECK(none.read().empty());
  }
  SECTION("other shapes are refused") {
    auto y = device.stream<float>({4});
    CHECK(errorOf([&] { x.copyTo(y); }) ==
          "copyTo: the source has shape {5}, the target {4}; copy between equal shapes, such as a part of "
          "one, domain(begin, end)");
    CHECK(errorOf([&] { Stream<float>().fill(1); }) == "fill: " + noStream);
    CHECK(errorOf([&] { x.copyTo(Stream<float>().domain({0}, {1})); }) == "domain: " + noStream);
  }
}
