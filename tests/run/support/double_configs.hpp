// SPDX-License-Identifier: MIT
//
// How devices represent doubles, and test values that every representation holds exactly.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "support/values.hpp"

namespace run_tests {

struct DoubleConfig {
  std::string profile, doubles;
  bool isNative() const { return doubles == "native"; }
};

inline sk::Device& deviceOf(const DoubleConfig& config) {
  // Never destroyed: some drivers shut down before our static objects are destroyed.
  static auto& devices = *new std::map<std::string, sk::Device>;
  const std::string key = config.profile + config.doubles;
  auto found = devices.find(key);
  if (found == devices.end()) {
    const sk::DeviceOptions options{.profile = config.profile, .doubles = config.doubles};
    found =
        devices.emplace(key, config.profile == "native" ? sk::Device::native() : sk::Device(options)).first;
  }
  return found->second;
}

/// Calls test(device, config) for every configuration. Pairs on glsl330 are left out: the programs are those of essl300 with
/// another header (tests/golden/glslang_test.cpp).
template <class Test>
void onEveryDoubleConfig(const Test& test) {
  for (const DoubleConfig& config : {DoubleConfig{"glsl330", "native"}, DoubleConfig{"essl300", "pairs"},
                                     DoubleConfig{"native", "native"}}) {
    INFO(config.profile << " with " << config.doubles << " doubles");
    test(deviceOf(config), config);
  }
}

/// Random doubles of 48 bits, which pairs hold exactly, with exponents from -range to range.
inline std::vector<double> randomDoubles(std::size_t count, std::uint32_t seed, int range = 30) {
  std::vector<double> list(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t a = hashed(static_cast<std::uint32_t>(i) * 3 + seed), b = hashed(a + 1),
                        c = hashed(b + 2);
    const auto mantissa =
        static_cast<double>((std::uint64_t{a} << 16 | (b & 0xffffu)) | std::uint64_t{1} << 47);
    const int exponent = static_cast<int>(c % static_cast<unsigned>(2 * range + 1)) - range - 47;
    list[i] = std::ldexp(c & 0x10000u ? -mantissa : mantissa, exponent);
  }
  return list;
}

/// The error bound of one operation, relative to its result.
inline long double precisionOf(const DoubleConfig& config) { return config.isNative() ? 0x1p-52L : 0x1p-45L; }

}  // namespace run_tests
