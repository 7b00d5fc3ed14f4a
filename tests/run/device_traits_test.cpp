// SPDX-License-Identifier: MIT
//
// Promise: what is assumed of a device (runtime/src/gl/known_devices.def) decides how results are computed, never which, and a
// configuration file changes it. Integers are compared, and floats whose sums are exact.
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "device_traits.sk.hpp"
#include "error_of.hpp"
#include "sk/algorithm.hpp"
#include "sk/sk.hpp"
#include "support/configuration_file.hpp"
#include "support/devices.hpp"

using namespace run_tests;

namespace {

using Integers = std::vector<std::int32_t>;

Integers someIntegers(std::size_t count) {
  Integers list;
  for (std::size_t i = 0; i < count; ++i) list.push_back(static_cast<std::int32_t>(i * 7919 % 1013) - 300);
  return list;
}

template <class T>
sk::Stream<T> filled(sk::Device& device, const sk::Shape& shape, const std::vector<T>& values) {
  auto stream = device.stream<T>(shape);
  stream.write(values);
  return stream;
}

/// What every way of computing leaves.
std::vector<Integers> resultsOf(sk::Device& device) {
  std::vector<Integers> all;
  for (const std::size_t count : {std::size_t{1}, std::size_t{777}, std::size_t{20000}}) {
    const auto size = static_cast<std::int64_t>(count);
    const Integers values = someIntegers(count);
    const auto x = filled(device, {size}, values);
    const auto [total, most] = traits::both(x);
    all.push_back({traits::sum(x), total, most, traits::gathered(x, x)});
    auto s = device.stream<std::int32_t>({size});
    traits::prefix(x, s);
    all.push_back(s.read());
    auto pushed = device.stream<std::int32_t>({size});
    traits::odd(x, pushed);
    all.push_back(pushed.read());
    auto positive = values;
    for (std::int32_t& value : positive) value += 300;
    auto counts = filled(device, {16}, Integers(16, 0));
    traits::counted(filled(device, {size}, positive), counts);
    all.push_back(counts.read());
    auto sorted = filled(device, {size}, values);
    sk::sort(sorted);
    all.push_back(sorted.read());
  }
  const std::vector<float> plane(33 * 65, 0.5F);
  auto a = filled(device, {33, 65}, plane), b = device.stream<float>({33, 65});
  a.domain({3, 5}, {20, 31}).write(std::vector<float>(17 * 26, 2));
  traits::smooth(a, 0.25F, b);
  Integers smoothed;
  for (const float value : b.read()) smoothed.push_back(static_cast<std::int32_t>(8 * value));
  all.push_back(smoothed);
  return all;
}

}  // namespace

TEST_CASE("a file changes what is assumed of a device") {
  const auto traitsWith = [](const std::string& text) {
    const ConfigurationFile file(text);
    std::map<std::string_view, double> values;
    const sk::Device device({.device = "software", .profile = "glsl330", .configuration = file.path});
    for (const sk::DeviceTrait& trait : device.traits()) values[trait.name] = trait.value;
    return values;
  };
  const auto usual = traitsWith("");
  CHECK(usual.at("samplesTexels") == 1);
  CHECK(usual.at("drawnRun") == 64);
  const auto all =
      traitsWith("[devices.\"*\"]\nsamplesTexels = false\ndispatchBelow = 0.25\ndrawnRun = 16\n");
  CHECK(all.at("samplesTexels") == 0);
  CHECK(all.at("dispatchBelow") == 0.25);
  CHECK(all.at("drawnRun") == 16);
  CHECK(all.at("tilesScans") == usual.at("tilesScans"));
  const auto part = traitsWith(
      "[devices.\"*\"]\ndrawnRun = 16\nreadBytes = 0\n[devices.LLVMpipe]\ndrawnRun = "
      "8\n[devices.nvidia]\ndrawnRun = 4\n");
  CHECK(part.at("drawnRun") == 8);
  CHECK(part.at("readBytes") == 0);
  CHECK(sk::Device::native().traits().empty());
  CHECK(sk::Device::native().kind() == "native");

  const auto errorIn = [&](const std::string& text) { return errorOf([&] { traitsWith(text); }); };
  CHECK_THAT(errorIn("[devices.\"*\"]\nshareTexels = true\n"),
             Catch::Contains(":2: a device has no 'shareTexels'; it has samplesTexels, "));
  CHECK_THAT(errorIn("[devices.\"*\"]\nsharesTexels = 1\n"), Catch::EndsWith(") is true or false"));
  CHECK_THAT(errorIn("[devices.\"\"]\n"), Catch::Contains(":1: expected a part of a renderer's name"));
  CHECK_THAT(errorIn("[devices.\"*\"]\ndrawnRun = 65\n"),
             Catch::EndsWith(") is a whole number from 0 to 64"));
  CHECK_THAT(errorIn("[devices.\"*\"]\ndrawnRun = 1.5\n"),
             Catch::EndsWith(") is a whole number from 0 to 64"));
  CHECK_THAT(errorIn("[devices.\"*\"]\ndispatchBelow = nan\n"),
             Catch::EndsWith(") is a number from 0 to 1000000"));
  CHECK_THAT(errorIn("[devices.\"*\"]\ndispatchBelow = -1\n"),
             Catch::EndsWith(") is a number from 0 to 1000000"));
}

TEST_CASE("what is assumed of a device changes no result") {
  const std::vector<Integers> expected = resultsOf(device("native"));
  for (const char* profile : {"glsl330", "glsl430"}) {
    INFO(profile);
    const sk::Device usual({.device = "software", .profile = profile});
    // all constants at one end of their range, at the other, and in between
    for (const int end : {0, 1, 2}) {
      std::string text = "[devices.\"*\"]\n";
      for (const sk::DeviceTrait& trait : usual.traits()) {
        const std::string ends[] = {"0", trait.most < 1e6 ? "64" : "1000000", "7"};
        const std::string value = trait.most > 1 ? ends[end] : end == 1 ? "true" : "false";
        text += std::string(trait.name) + " = " + value + "\n";
      }
      INFO(text);
      const ConfigurationFile file(text);
      sk::Device device({.device = "software", .profile = profile, .configuration = file.path});
      CHECK(resultsOf(device) == expected);
    }
  }
}
