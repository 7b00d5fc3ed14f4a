// SPDX-License-Identifier: MIT
//
// Specialisation constants: every value gives the right results. An argument that a value switches off may be left out;
// one that is needed may not.
#include "spec.sk.hpp"

#include <limits>

#include "support/devices.hpp"
#include "support/host_array.hpp"
#include "support/values.hpp"

using namespace run_tests;

namespace {

const std::vector<sk::Shape> specShapes = {{1}, {7}, {1021}, {13, 17}, {67, 3}, {2, 3, 5}};

std::vector<float> numbered(const sk::Shape& shape, float first) {
  std::vector<float> numbers(static_cast<std::size_t>(shape.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = first + static_cast<float>(i);
  return numbers;
}

}  // namespace

TEST_CASE("an input that is switched off may be left out") {
  onSomeLayouts([](sk::Device& device) {
    for (const sk::Shape& shape : specShapes) {
      INFO("shape " << sk::toString(shape));
      auto x = streamOf<float>(device, shape, numbered(shape, 1));
      auto y = streamOf<float>(device, shape, numbered(shape, 100));
      auto r = device.stream<float>(shape);
      spec::pick(true, x, y, r);
      CHECK(difference(r.read(), [](std::size_t i) { return 101 + 2 * static_cast<float>(i); }) == "");
      for (int round = 0; round < 2; ++round) {
        spec::pick(false, x, sk::none, r);
        CHECK(difference(r.read(), [](std::size_t i) { return 1 + static_cast<float>(i); }) == "");
        spec::pick(true, x, y, y);
        spec::pick(true, x, y, r);
      }
    }
  });
}

TEST_CASE("what is given and not needed is not looked at") {
  onGlAndNative([](sk::Device& device) {
    auto x = streamOf<float>(device, {3}, {1, 2, 3});
    auto other = device.stream<float>({5, 5});
    auto r = device.stream<float>({3});
    spec::pick(false, x, other, r);
    CHECK(r.read() == std::vector<float>{1, 2, 3});
    sk::Device native = sk::Device::native();
    auto ofAnother = native.stream<float>({3});
    spec::pick(false, x, ofAnother, r);
    CHECK(r.read() == std::vector<float>{1, 2, 3});
  });
}

TEST_CASE("outputs and gathers that a switch leaves out") {
  onSomeLayouts([](sk::Device& device) {
    auto x = streamOf<float>(device, {70}, numbered({70}, 1));
    auto y = streamOf<float>(device, {70}, numbered({70}, 2));
    auto sum = device.stream<float>({70});
    auto product = device.stream<float>({70});
    spec::modes(0, x, y, sum, sk::none);
    CHECK(difference(sum.read(), [](std::size_t i) { return 3 + 2 * static_cast<float>(i); }) == "");
    spec::modes(1, x, y, sk::none, product);
    const auto products = [](std::size_t i) {
      return (1 + static_cast<float>(i)) * (2 + static_cast<float>(i));
    };
    CHECK(difference(product.read(), products) == "");
    sum.write(numbered({70}, 0));
    product.write(numbered({70}, 0));
    spec::modes(2, x, y, sum, product);
    CHECK(difference(sum.read(), [](std::size_t i) { return 3 + 2 * static_cast<float>(i); }) == "");
    CHECK(difference(product.read(), products) == "");
    product.write(numbered({70}, 0));
    spec::modes(0, x, y, sum, product);  // `product` is given, but not written: it keeps its elements
    CHECK(product.read() == numbered({70}, 0));
    spec::modes(7, sk::none, sk::none, sk::none, sk::none);  // nothing is left to do
  });
}

TEST_CASE("each value is exactly itself") {
  onGlAndNative([](sk::Device& device) {
    auto r = device.stream<float>({1});
    const auto value = [&](int i, unsigned u, float f, unsigned edge) {
      spec::values(i, u, f, edge, r);
      return r.read()[0];
    };
    CHECK(value(-3, 0, 0, 0) == -3.0F);
    CHECK(value(std::numeric_limits<int>::min(), 0, 0, 0) == -2147483648.0F);
    CHECK(value(0, 4294967040U, 0, 0) == 4294967040.0F);
    CHECK(value(0, 0, 0.1F, 0) == 0.1F);
    CHECK(value(0, 0, 1e-20F, 0) == 1e-20F);
    CHECK(value(0, 0, 3, 1) == 3.5F);
    CHECK(value(0, 0, std::numeric_limits<float>::infinity(), 1) == std::numeric_limits<float>::infinity());
    for (int i = 0; i < 20; ++i) CHECK(value(i, 1, 0, 0) == static_cast<float>(i + 1));
  });
}

TEST_CASE("conditions go through functions, locals and early returns") {
  onGlAndNative([](sk::Device& device) {
    auto a = streamOf<float>(device, {3}, {1, 2, 3});
    auto b = streamOf<float>(device, {4}, {10, 20, 30, 40});
    auto r = device.stream<float>({3});
    spec::viaFunction(0, a, sk::none, r);
    CHECK(r.read() == std::vector<float>{1, 2, 3});
    spec::viaFunction(1, a, sk::none, r);
    CHECK(r.read() == std::vector<float>{1, 4, 9});
    spec::viaFunction(3, a, b, r);
    CHECK(r.read() == std::vector<float>{105, 406, 907});
    CHECK_THROWS_WITH(spec::viaFunction(3, a, sk::none, r), Catch::Contains("viaFunction") &&
                                                                Catch::Contains("'b' is sk::none") &&
                                                                Catch::Contains("level > 2"));
  });
}

TEST_CASE("conditions go through what functions return") {
  onGlAndNative([](sk::Device& device) {
    auto a = streamOf<float>(device, {3}, {1, 2, 3});
    auto b = streamOf<float>(device, {3}, {10, 20, 30});
    auto c = streamOf<float>(device, {3}, {100, 200, 300});
    auto r = device.stream<float>({3});
    const auto first = [&] { return r.read()[0]; };
    spec::viaResult({0, false}, sk::none, sk::none, sk::none, r);  // order 1
    CHECK(first() == 1);
    for (const int level : {1, 2}) {
      spec::viaResult({level, false}, sk::none, b, sk::none, r);
      CHECK(first() == 11);
    }
    for (const int level : {-1, 3, 7}) {
      spec::viaResult({level, false}, a, b, c, r);
      CHECK(first() == 112);
      spec::viaResult({level, true}, sk::none, b, sk::none, r);
      CHECK(first() == (level == 7 ? 11 : 1));
    }
    spec::viaResult({-2, false}, sk::none, b, c, r);
    CHECK(first() == 111);
    spec::viaResult({0, true}, sk::none, sk::none, sk::none, r);
    CHECK(first() == 1);
    CHECK_THROWS_WITH(spec::viaResult({3, false}, sk::none, b, c, r), Catch::Contains("'a' is sk::none"));
    CHECK_THROWS_WITH(spec::viaResult({1, false}, sk::none, sk::none, sk::none, r),
                      Catch::Contains("'b' is sk::none"));
    CHECK_THROWS_WITH(spec::viaResult({-2, false}, a, b, sk::none, r), Catch::Contains("'c' is sk::none"));
  });
}

TEST_CASE("several flags") {
  onGlAndNative([](sk::Device& device) {
    auto x = streamOf<float>(device, {1}, {1});
    auto y = streamOf<float>(device, {1}, {10});
    auto z = streamOf<float>(device, {1}, {100});
    auto r = device.stream<float>({1});
    spec::both(false, false, x, sk::none, sk::none, r);
    CHECK(r.read()[0] == 1);
    spec::both(true, false, x, sk::none, z, r);
    CHECK(r.read()[0] == 101);
    spec::both(true, true, x, y, z, r);
    CHECK(r.read()[0] == 111);
    CHECK_THROWS_AS(spec::both(true, true, x, sk::none, z, r), sk::Error);
  });
}

TEST_CASE("structs are left out as a whole") {
  onSomeLayouts([](sk::Device& device) {
    auto x = streamOf<float>(device, {67}, numbered({67}, 0));
    auto r = device.stream<float>({67});
    spec::shade(false, x, sk::none, sk::none, r, sk::none);
    CHECK(r.read() == numbered({67}, 0));
    const std::vector<spec::Surface> lights(67, {{1, 2, 3}, 4});
    auto light = device.stream<spec::Surface>({67});
    light.write(lights);
    auto surface = device.stream<spec::Surface>({67});
    spec::shade(true, x, light, light, r, surface);
    CHECK(surface.read()[66].normal == sk::float3{1, 2, 3});
    CHECK(surface.read()[66].id == 4);
  });
}
