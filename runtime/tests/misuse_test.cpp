// SPDX-License-Identifier: MIT
//
// Each misuse throws one sk::Error that names the kernel, the parameters and the shapes.
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "elements.hpp"
#include "error_of.hpp"
#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

const TestKernel& diffuse() {
  static const TestKernel kernel("heat::diffuse",
                                 "void heat_diffuse(float k, float u, out float v) { v = k * u; }\n",
                                 {uniform<float>("k"), input<float>("u"), output<float>("v")});
  return kernel;
}

const TestKernel& lookup() {
  static const TestKernel kernel("lookup", "void lookup(out float v) { v = sk_at_table(ivec2(0)); }\n",
                                 {gather<float>("table", 2), output<float>("v")});
  return kernel;
}

}  // namespace

TEST_CASE("arguments of a kernel that do not fit") {
  Device device;
  const float k = 1;
  auto u = device.stream<float>({512, 512});
  auto v = device.stream<float>({256, 256});
  auto line = device.stream<float>(512);
  auto pairs = device.stream<float2>({512, 512});
  CHECK(errorOf([&] { diffuse()(k, u, v); }) ==
        "heat::diffuse: 'u' has shape {512, 512}, but the output 'v' has {256, 256}; give them the same "
        "shape, or extent 1 "
        "where 'u' repeats");
  CHECK(errorOf([&] { diffuse()(k, line, u); }) ==
        "heat::diffuse: 'u' has shape {512}, but the output 'v' has {512, 512}; give them the same shape, or "
        "extent 1 where "
        "'u' repeats");
  CHECK(errorOf([&] { diffuse()(k, pairs, u); }) ==
        "heat::diffuse: 'u' is declared as float, but its stream holds float2");
  CHECK(errorOf([&] { diffuse()(k, u); }) == "heat::diffuse: 2 arguments are given, but 3 are declared");
  CHECK(errorOf([&] { lookup()(line, v); }) ==
        "lookup: 'table' is declared with 2 dimension(s), but its stream has shape {512}");
  auto none = device.stream<float>({0, 4});
  CHECK(errorOf([&] { lookup()(none, v); }) ==
        "lookup: 'table' has shape {0, 4}: there is no element to read");
  lookup()(none, none);
}

TEST_CASE("outputs that do not fit each other") {
  static const TestKernel two("two", "void two(out float a, out float b) { a = 1.0; b = 2.0; }\n",
                              {output<float>("a"), output<float>("b")});
  Device device;
  auto a = device.stream<float>({4, 6});
  auto b = device.stream<float>({6, 4});
  CHECK(errorOf([&] { two(a, b); }) ==
        "two: the outputs 'a' and 'b' have shapes {4, 6} and {6, 4}; give them the same shape");
  CHECK(errorOf([&] { two(a, a); }) ==
        "two: the outputs 'a' and 'b' overlap: both write elements of one stream; give them different "
        "streams, or regions "
        "that have no element in common");
  CHECK(errorOf([&] { two(a.domain({0, 0}, {2, 3}), a.domain({1, 2}, {3, 5})); }).find("overlap") !=
        std::string::npos);
  two(a.domain({0, 0}, {2, 3}), a.domain({2, 3}, {4, 6}));
  CHECK(a.domain({0, 0}, {2, 3}).read() == std::vector<float>(6, 1.0f));
  CHECK(a.domain({2, 3}, {4, 6}).read() == std::vector<float>(6, 2.0f));
}

TEST_CASE("streams of two devices, moved streams, streams after their device") {
  Device first;
  Device second;
  const float k = 1;
  auto u = first.stream<float>(3);
  auto v = second.stream<float>(3);
  CHECK(errorOf([&] { diffuse()(k, u, v); }) ==
        "heat::diffuse: 'v' and 'u' are streams of two devices, two sk::Device of '" + first.name() +
            "'; create both by one of them, or copy one stream through host memory");
  auto moved = std::move(u);
  CHECK(errorOf([&] { diffuse()(k, u, v); }) ==
        "heat::diffuse: 'u' holds no stream: it was default-constructed or moved from; make one by "
        "device.stream<T>(shape)");
  auto orphan = [] {
    Device gone;
    auto stream = gone.stream<float>({2, 2});
    stream.write(std::vector<float>(4, 1.0f));
    return stream;
  }();
  CHECK(errorOf([&] { (void)orphan.read(); }) ==
        "read: the device of this stream of shape {2, 2} has been destroyed; keep the device for as long as "
        "its streams are used");
  CHECK(errorOf([&] { orphan.write(std::vector<float>(4)); }).find("has been destroyed") !=
        std::string::npos);
  CHECK(errorOf([&] { diffuse()(k, orphan, orphan); }) ==
        "heat::diffuse: 'v' is a stream whose device has been destroyed; keep the device for as long as its "
        "streams are used");
  CHECK(errorOf([&] { sumOfFloats().value<float>(orphan); }) ==
        "sum: 'x' is a stream whose device has been destroyed; keep the device for as long as its streams "
        "are used");
  orphan = second.stream<float>({1, 1});
  orphan.write(std::vector<float>{5});
  CHECK(orphan.read() == std::vector<float>{5});
}

TEST_CASE("transfers of another size") {
  Device device;
  auto u = device.stream<float>({3, 4});
  CHECK(errorOf([&] { u.write(std::vector<float>(11)); }) ==
        "write: 11 element(s) in host memory, but shape {3, 4} has 12; give exactly as many");
  std::vector<float> memory(13);
  CHECK(errorOf([&] { u.read(memory); }) ==
        "read: 13 element(s) in host memory, but shape {3, 4} has 12; give exactly as many");
  CHECK(errorOf([&] { u.domain({1, 1}, {3, 3}).write(std::vector<float>(12)); }) ==
        "write: 12 element(s) in host memory, but shape {2, 2} has 4; give exactly as many");
  CHECK(errorOf([&] { u.domain({1, 1}, {4, 3}); }) ==
        "domain: {1, 1} (inclusive) to {4, 3} (exclusive) is no box inside shape {3, 4}; give each a "
        "position in every "
        "dimension, rows first");
  CHECK(errorOf([&] { u.domain({2, 1}, {1, 3}); }).find("no box") != std::string::npos);
  CHECK(errorOf([&] { u.domain({-1, 0}, {1, 3}); }).find("no box") != std::string::npos);
  CHECK(errorOf([&] { u.domain(0, 3); }).find("no box") != std::string::npos);
  CHECK(errorOf([&] { (void)u.texture(1); }) == "texture: there is no plane 1; float has 1, from 0");
}

TEST_CASE("shapes that are none, or too large") {
  Device device;
  CHECK(errorOf([&] { device.stream<float>({4, -1}); }) == "{4, -1} is not a shape: an extent is negative");
  constexpr std::int64_t huge = std::int64_t{1} << 62;
  CHECK(errorOf([&] { device.stream<float>({huge, huge, huge}); }) ==
        "{4611686018427387904, 4611686018427387904, 4611686018427387904} is not a shape: the number of "
        "elements does not "
        "fit in 63 bits");
  CHECK(errorOf([&] { device.stream<float>(std::numeric_limits<std::uint64_t>::max()); }) ==
        "an extent or position does not fit in 63 bits");
  CHECK(errorOf([&] { device.stream<float>(Shape()); }) == "a stream needs a shape of 1 to 4 dimensions");
  CHECK(errorOf([&] { device.stream<float>({huge}); }) ==
        "a new stream: a stream of float of shape {4611686018427387904} is too large: its elements would "
        "take 2^61 bytes or more");
  const std::string error = errorOf([&] { device.stream<float>({1 << 20, 1 << 20}); });
  CHECK(error.find(
            "a stream of shape {1048576, 1048576} has 1099511627776 elements, but a texture of this device "
            "holds no more than ") == 0);
  Device small({.textureLimit = 64});
  const std::int64_t most = std::int64_t{64} * 64 * small.limits().textureLayers;
  CHECK(errorOf([&] { small.stream<float>(most + 1); }) ==
        "a stream of shape {" + std::to_string(most + 1) + "} has " + std::to_string(most + 1) +
            " elements, but a texture of this device holds no more than " +
            std::to_string(small.limits().textureLayers) +
            " layers of 64 x 64 texels, and a stream 2147418112 elements; divide it into several streams");
  CHECK(errorOf([&] { device.stream<float>({2, mostExtent + 1}); }) ==
        "a stream of float of shape {2, 1073741824} has an extent above 1073741823, where indices end; give "
        "it rows, or "
        "divide it");
  CHECK(device.limits().elements == mostElements);
  auto none = device.stream<float>({0, huge});
  CHECK(none.read().empty());
}

TEST_CASE("a domain of more elements than have numbers") {
  static const TestKernel multiply("multiply", "void multiply(float x, float y) { sk_put_r(0, x * y); }\n",
                                   {input<float>("x"), input<float>("y"), scatter<float>("r", 1, 1)});
  Device device;
  auto x = device.stream<float>({1 << 16, 1});
  auto y = device.stream<float>({1, 1 << 16});
  auto r = device.stream<float>({1});
  CHECK(errorOf([&] { multiply(x, y, r); }) ==
        "multiply: the domain of shape {65536, 65536} has 4294967296 elements, but '" + device.name() +
            "' numbers 2147418112; divide it");
}

TEST_CASE("more pushes than there are numbers for") {
  static const TestKernel many("many", "void many(float x) { sk_pushed_r = int(x); }\n",
                               {input<float>("x"), variableOutput<float>("r")});
  for (const std::string& profile : profileNames) {
    Device device(DeviceOptions{.profile = profile});
    auto x = device.stream<float>({4096});
    auto r = device.stream<float>({1});
    const std::string error =
        "many: it pushes to 'r' more than 536870910 values in one call; divide the domain";
    x.write(std::vector<float>(4096, 1 << 20));  // 2^32 in all
    CHECK(errorOf([&] { many(x, r); }) == error);
    std::vector<float> one(4096);
    one[77] = 0x1p30F;  // and in one element
    x.write(one);
    CHECK(errorOf([&] { many(x, r); }) == error);
    one[77] = 0;
    x.write(one);
    many(x, r);
    CHECK(r.size() == 0);
  }
}

TEST_CASE("reductions that do not fit") {
  Device device;
  auto x = device.stream<float>({6, 8});
  auto three = device.stream<float>({3, 3});
  auto line = device.stream<float>(6);
  auto pairs = device.stream<float2>({6, 8});
  auto none = device.stream<float>({0, 8});
  CHECK(
      errorOf([&] { sumOfFloats()(x, three); }) ==
      "sum: 'x' has shape {6, 8}, and the output 'total' has {3, 3}; give the output as many dimensions, or "
      "fewer, each extent a divisor of the input's");
  CHECK(errorOf([&] { sumOfFloats()(x, line.domain(0, 5)); }).find("as many dimensions") !=
        std::string::npos);
  CHECK(errorOf([&] { sumOfFloats()(x, line.domain(0, 2)); }) ==
        "sum: 'x' has shape {6, 8}, and the output 'total' has {2}, which could mean {2, 1} or {1, 2}; write "
        "the one that you mean");
  CHECK(errorOf([&] { sumOfFloats()(x, none); }).find("a divisor") != std::string::npos);
  CHECK(errorOf([&] { sumOfFloats().value<float>(pairs); }) ==
        "sum: 'x' is declared as float, but its stream holds float2");
  CHECK(errorOf([&] { sumOfFloats()(x, pairs); }) ==
        "sum: 'total' is declared as float, but its stream holds float2");
}

TEST_CASE("a program that the driver refuses names the line of the .sk file") {
  const auto profile = GENERATE(from_range(profileNames));
  static const TestKernel wrong("wrong", "#line 41 1\n\nvoid wrong(out float r) {\n  r = nothing;\n}\n",
                                {output<float>("r")});
  Device device({.profile = profile});
  auto r = device.stream<float>(1);
  const std::string error = errorOf([&] { wrong(r); });
  CHECK(error.find("wrong: the driver of '" + device.name() + "' refuses the kernel's " + profile +
                   " program:\n") == 0);
  CHECK(error.find("test.sk:43") != std::string::npos);
  CHECK(error.find("nothing") != std::string::npos);
  CHECK(errorOf([&] { wrong(r); }) == error);
}

TEST_CASE("uniforms that a device has no room for") {
  std::vector<program::Parameter> parameters(225, uniform<float4>("k"));
  parameters.push_back(output<float>("v"));
  static const TestKernel kernel("many", "void many(out float v) { v = 0.0; }\n", parameters);
  const float4 k{};
  Device device({.profile = "essl300", .limits = "guaranteed"});
  CHECK(device.limits().uniformComponents == 896);
  auto v = device.stream<float>({3});
  std::vector<Argument> arguments(225, Argument{&k, {}});
  arguments.push_back({nullptr, regionOf(v)});
  CHECK(errorOf([&] { run(kernel.kernel(), arguments); }) ==
        "many: its uniforms have 900 components, but this device has room for 896; read large arrays as "
        "gathers");
}

TEST_CASE("doubles among uniforms take the room of two floats") {
  std::vector<program::Parameter> parameters(113, uniform<double4>("k"));
  parameters.push_back(output<float>("v"));
  static const TestKernel kernel("many", "void many(out float v) { v = 0.0; }\n", parameters);
  const double4 k{};
  Device device({.profile = "essl300", .limits = "guaranteed"});
  auto v = device.stream<float>({3});
  std::vector<Argument> arguments(113, Argument{&k, {}});
  arguments.push_back({nullptr, regionOf(v)});
  CHECK(errorOf([&] { run(kernel.kernel(), arguments); }) ==
        "many: its uniforms have 904 components, but this device has room for 896; read large arrays as "
        "gathers");
}

TEST_CASE("uniforms of a reduce that a device has no room for") {
  std::vector<program::Parameter> parameters(225, uniform<float4>("k"));
  parameters.push_back(input<float>("x"));
  parameters.push_back(accumulator<float>("total", "0.0"));
  static const TestKernel fold("sum", "void sum(float x, inout float total) { total += x; }\n", parameters);
  const program::Reduction reduction{
      .fold = fold.kernel(), .combine = fold.kernel(), .combineOperands = {}, .seeded = false};
  const float4 k{};
  Device device({.profile = "essl300", .limits = "guaranteed"});
  auto x = device.stream<float>({3});
  std::vector<Argument> arguments(225, Argument{&k, {}});
  arguments.push_back({nullptr, regionOf(x)});
  arguments.push_back({});
  float total = 0;
  void* const results[] = {&total};
  CHECK(errorOf([&] { reduce(reduction, arguments, results); }) ==
        "sum: its uniforms have 900 components, but this device has room for 896; read large arrays as "
        "gathers");
}
