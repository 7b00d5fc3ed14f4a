// SPDX-License-Identifier: MIT
//
// The trial of a device's arithmetic: pairs of floats, a kernel that adds and multiplies them, and the
// expected results.
#include "probe/probe.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "device/stream_state.hpp"
#include "gl_device/gl_device.hpp"
#include "probe/own_operations.hpp"
#include "sk/error.hpp"
#include "sk/types.hpp"
#include "support/cache_folder.hpp"

namespace sk {

namespace {

constexpr std::size_t pairCount = 1024;

/// The kernel calls the functions that implement pairs of floats (assemble/glsl/doubles.cpp).
const program::Kernel& exactSums() {
  using program::Role;
  static constexpr std::array<program::Parameter, 2> parameters{
      {{.name = "x", .symbol = "x", .role = Role::Input, .element = &ElementTraits<float2>::element()},
       {.name = "r", .symbol = "r", .role = Role::Output, .element = &ElementTraits<float4>::element()}}};
  static constexpr program::Kernel kernel{
      .name = "exact sums",
      .entry = "sk_exact_sums",
      .declarations = {},
      .body =
          "void sk_exact_sums(vec2 x, out vec4 r) {\n"
          "  sk_double s = sk_two_sum(x.x, x.y), p = sk_two_product(x.x, x.y);\n"
          "  r = vec4(s.hi, s.lo, p.hi, p.lo);\n"
          "}\n",
      .parameters = parameters,
      .sources = {},
      .usesDoubles = true};
  return kernel;
}

}  // namespace

std::vector<float2> trialPairs(std::size_t count) {
  std::vector<float2> operands{{1, 0x1p-24F},
                               {1, -0x1p-25F},
                               {1, 0x1.000002p-24F},
                               {0x1.fffffep0F, 0x1p-24F},
                               {1, 0},
                               {0, 0x1.234568p5F},
                               {0x1.234568p5F, -0x1.234568p5F},
                               {0x1p24F, 1},
                               {0x1p24F, 3},
                               {0x1p25F, 0x1.8p1F},
                               {0x1.fffffep62F, 0x1p38F},
                               {0x1p63F, -0x1.fffffep62F},
                               {0x1.fffffep127F, 0x1p-24F},
                               {0x1p-78F, 0x1.fffffep0F},
                               {0x1.555556p-1F, 3},
                               {0x1.99999ap-4F, 10},
                               {0x1.921fb6p1F, 0x1.5bf0a8p1F},
                               {0x1.fffffep0F, 0x1.fffffep0F},
                               {16777215, 16777215},
                               {-16777215, 16777213}};
  std::mt19937 random(2004);
  const auto number = [&](int exponent) {
    const std::uint32_t bits = static_cast<std::uint32_t>(random());
    const float mantissa = std::bit_cast<float>((bits & 0x807fffffU) | 0x3f800000U);
    return std::ldexp(mantissa, exponent);
  };
  while (operands.size() < count) {
    const int i = static_cast<int>(operands.size());
    const int exponent =
        i % 4 == 0 ? static_cast<int>(random() % 100) - 38 : static_cast<int>(random() % 41) - 20;
    operands.push_back({number(exponent), number(exponent / 4 - static_cast<int>(random() % 30))});
    if (i % 2 == 0) std::swap(operands.back().x, operands.back().y);
  }
  return operands;
}

// A double represents every product of two floats exactly.
float4 exactSumAndProduct(const float2& x) {
  const float sum = x.x + x.y;
  const float back = sum - x.x;
  const float product = x.x * x.y;
  const double lost = double{x.x} * double{x.y} - double{product};
  return {sum, (x.x - (sum - back)) + (x.y - back), product, static_cast<float>(lost)};
}

namespace {

bool holds(GlDevice& device, Barrier barrier) {
  device.barrier = barrier;
  const std::vector<float2> given = trialPairs(pairCount);
  const Shape shape{32, static_cast<std::int64_t>(given.size()) / 32};
  const auto x = device.createStream(ElementTraits<float2>::element(), shape, Storage::Single);
  const auto r = device.createStream(ElementTraits<float4>::element(), shape, Storage::Single);
  const std::array<Argument, 2> arguments{
      {{.region = detail::wholeRegion(x.get())}, {.region = detail::wholeRegion(r.get())}}};
  std::vector<float4> found(given.size());
  detail::write(arguments[0].region, given.data(), given.size());
  try {
    device.runUnchecked(exactSums(), arguments, {.precision = Precision::Extended});
  } catch (const Error& error) {
    if (barrier != Barrier::Precise || error.kind() != Error::Kind::Compile) throw;
    return false;  // the compiler claims to support `precise`, but rejects it
  }
  detail::read(arguments[1].region, found.data(), found.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (found[i] != exactSumAndProduct(given[i])) return false;
  }
  return true;
}

std::optional<Barrier> firstThatHolds(GlDevice& device) {
  if (device.capabilities.hasPrecise && holds(device, Barrier::Precise)) return Barrier::Precise;
  if (holds(device, Barrier::Xor)) return Barrier::Xor;
  return std::nullopt;
}

std::string_view nameOf(Barrier barrier) {
  for (const auto& [one, name] : barrierNames) {
    if (one == barrier) return name;
  }
  return {};
}

/// The result of an earlier process; nullopt if there is none.
std::optional<Barrier> kept(const GlDevice& device, std::string_view key) {
  const std::optional<std::string> text = device.cache.read("barrier", key);
  if (text == "precise\n" && device.capabilities.hasPrecise) return Barrier::Precise;
  return text == "xor\n" ? std::optional(Barrier::Xor) : std::nullopt;
}

}  // namespace

Arithmetic probeArithmetic(GlDevice& device) {
  const std::string key = driverKey(device.name(), device.driver(), device.profileName());
  const Barrier strongest = device.barrier;
  std::optional<Barrier> found = kept(device, key);
  if (!found) {
    try {
      found = firstThatHolds(device);
    } catch (...) {
      device.barrier = strongest;  // the trial has changed it
      throw;
    }
    // failures are not cached, because they may be due to exhausted memory
    if (found) device.cache.write("barrier", key, std::string(nameOf(*found)) + '\n');
  }
  device.barrier = found.value_or(strongest);
  return {.exactSums = found.has_value(),
          .barrier = found.value_or(Barrier::None),
          .asWritten = device.barrier == Barrier::Xor && computesAsWritten(device, key)};
}

}  // namespace sk
