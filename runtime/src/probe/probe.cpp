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

/// Operations that a compiler may combine, cancel or contract; without divisions, which need not be rounded correctly.
const program::Kernel& ownOperations() {
  using program::Role;
  static constexpr std::array<program::Parameter, 4> parameters{
      {{.name = "x", .symbol = "x", .role = Role::Input, .element = &ElementTraits<float4>::element()},
       {.name = "p", .symbol = "p", .role = Role::Output, .element = &ElementTraits<float4>::element()},
       {.name = "q", .symbol = "q", .role = Role::Output, .element = &ElementTraits<float4>::element()},
       {.name = "r", .symbol = "r", .role = Role::Output, .element = &ElementTraits<float4>::element()}}};
  static constexpr program::Kernel kernel{
      .name = "operations as they are written",
      .entry = "sk_own_operations",
      .declarations = {},
      .body =
          "void sk_own_operations(vec4 x, out vec4 p, out vec4 q, out vec4 r) {\n"
          "  p = vec4(x.x * 0.1 * 10.0, x.x * 0.3 * 0.7, x.x + 1e6 + 3.3, x.x + 1e6 - 1e6);\n"
          "  q = vec4(x.x + x.y - x.x, x.x * x.y + x.x * x.z, x.x * x.y - x.z, x.x - x.y + x.y);\n"
          "  r = vec4(dot(x.xyz, x.yzw), dot(x, x.wzyx), x.z - (x.z - x.x), x.x * x.x - x.y * x.y);\n"
          "}\n",
      .parameters = parameters,
      .sources = {}};
  return kernel;
}

/// What these operations are according to IEEE 754. Each result is stored, so that no compiler of the host contracts it.
std::array<float4, 3> operationsAsWritten(const float4& x) {
  const auto times = [](float a, float b) {
    volatile float product = a * b;
    return float{product};
  };
  const auto plus = [](float a, float b) {
    volatile float sum = a + b;
    return float{sum};
  };
  const float sum = plus(plus(times(x.x, x.y), times(x.y, x.z)), times(x.z, x.w));
  const float all = plus(plus(plus(times(x.x, x.w), times(x.y, x.z)), times(x.z, x.y)), times(x.w, x.x));
  return {{{times(times(x.x, 0.1F), 10), times(times(x.x, 0.3F), 0.7F), plus(plus(x.x, 1e6F), 3.3F),
            plus(plus(x.x, 1e6F), -1e6F)},
           {plus(plus(x.x, x.y), -x.x), plus(times(x.x, x.y), times(x.x, x.z)), plus(times(x.x, x.y), -x.z),
            plus(plus(x.x, -x.y), x.y)},
           {sum, all, plus(x.z, -plus(x.z, -x.x)), plus(times(x.x, x.x), -times(x.y, x.y))}}};
}

/// True if the device computes them so without a barrier.
bool computesAsWritten(GlDevice& device, std::string_view key) {
  if (const std::optional<std::string> text = device.cache.read("arithmetic", key)) return *text == "kept\n";
  std::vector<float4> given;
  std::mt19937 random(2026);
  const auto number = [&] { return 1 + 99 * static_cast<float>(random() >> 8) * 0x1p-24F; };
  for (std::size_t i = 0; i < pairCount; ++i) given.push_back({number(), number(), number(), number()});
  const Shape shape{32, static_cast<std::int64_t>(given.size()) / 32};
  const auto make = [&] {
    return device.createStream(ElementTraits<float4>::element(), shape, Storage::Single);
  };
  const auto x = make(), p = make(), q = make(), r = make();
  const std::array<Argument, 4> arguments{{{.region = detail::wholeRegion(x.get())},
                                           {.region = detail::wholeRegion(p.get())},
                                           {.region = detail::wholeRegion(q.get())},
                                           {.region = detail::wholeRegion(r.get())}}};
  detail::write(arguments[0].region, given.data(), given.size());
  device.runUnchecked(ownOperations(), arguments, {.contraction = Contraction::Fast});
  bool isKept = true;
  for (std::size_t output = 0; output < 3; ++output) {
    std::vector<float4> found(given.size());
    detail::read(arguments[output + 1].region, found.data(), found.size());
    for (std::size_t i = 0; i < given.size(); ++i)
      isKept = isKept && found[i] == operationsAsWritten(given[i])[output];
  }
  device.cache.write("arithmetic", key, isKept ? "kept\n" : "changed\n");
  return isKept;
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
