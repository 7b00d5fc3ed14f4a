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
#include <span>
#include <string>
#include <vector>

#include "call/resolved_call.hpp"
#include "device/stream_state.hpp"
#include "gl_device/gl_device.hpp"
#include "probe/own_operations.hpp"
#include "sk/error.hpp"
#include "sk/types.hpp"
#include "support/cache_folder.hpp"

namespace sk {

namespace {

constexpr std::int64_t rowLength = 32;
constexpr std::size_t pairCount = 32 * rowLength;
constexpr std::int32_t foldCount = 8;

/// The kernel calls the functions that implement pairs of floats (assemble/glsl/doubles.cpp). Like the programs that count on
/// the barrier, it does so in straight code, in a loop that compilers unroll, and in one that they cannot.
const program::Kernel& exactSums() {
  using program::Role;
  static constexpr std::array<program::Parameter, 5> parameters{
      {{.name = "x", .symbol = "x", .role = Role::Input, .element = &ElementTraits<float2>::element()},
       {.name = "row",
        .symbol = "row",
        .role = Role::Gather,
        .element = &ElementTraits<float2>::element(),
        .rank = 2,
        .usesAt = true},
       {.name = "count",
        .symbol = "count",
        .role = Role::Uniform,
        .element = &ElementTraits<std::int32_t>::element()},
       {.name = "r", .symbol = "r", .role = Role::Output, .element = &ElementTraits<float4>::element()},
       {.name = "s", .symbol = "s", .role = Role::Output, .element = &ElementTraits<float4>::element()}}};
  static_assert(foldCount == 8 && rowLength == 32);
  static constexpr program::Kernel kernel{
      .name = "exact sums",
      .entry = "sk_exact_sums",
      .declarations = {},
      .body =
          "vec2 sk_fold_next(vec2 sum, int k) {\n"
          "  ivec2 at = sk_index().xy;\n"
          "  sk_double s = sk_two_sum(sum.x, sk_at_row(ivec2((at.x + k) & 31, at.y)).x);\n"
          "  return vec2(s.hi, sum.y + s.lo);\n"
          "}\n"
          "void sk_exact_sums(vec2 x, int count, out vec4 r, out vec4 s) {\n"
          "  sk_double a = sk_two_sum(x.x, x.y), p = sk_two_product(x.x, x.y);\n"
          "  r = vec4(a.hi, a.lo, p.hi, p.lo);\n"
          "  vec2 unrolled = vec2(x.x, 0.0), looped = unrolled;\n"
          "  for (int k = 1; k < 8; ++k) unrolled = sk_fold_next(unrolled, k);\n"
          "  for (int k = 1; k < count; ++k) looped = sk_fold_next(looped, k);\n"
          "  s = vec4(unrolled, looped);\n"
          "}\n",
      .parameters = parameters,
      .sources = {},
      .usesIndex = true,
      .usesLoops = true,
      .usesDoubles = true};
  return kernel;
}

/// A compensated sum: a reduction that adds the rounding errors of its sums, as skc writes one.
const program::Reduction& compensatedSum() {
  using program::Role;
  const auto parameter = [](std::string_view name, Role role, std::string_view identity) {
    return program::Parameter{.name = name,
                              .symbol = name,
                              .role = role,
                              .element = &ElementTraits<float>::element(),
                              .identity = identity};
  };
  static const std::array<program::Parameter, 3> folded{parameter("x", Role::Input, {}),
                                                        parameter("t", Role::Accumulator, "-0.0"),
                                                        parameter("lost", Role::Accumulator, "0.0")};
  static const std::array<program::Parameter, 4> combined{
      parameter("x", Role::Input, {}), parameter("t", Role::Accumulator, {}),
      parameter("part", Role::Input, {}), parameter("lost", Role::Accumulator, {})};
  static constexpr std::string_view functions =
      "float sk_trial_error(float a, float b) {\n"
      "  sk_precise float s = sk_keep(a + b);\n"
      "  bool isLarge = bool(step(abs(b), abs(a)));\n"
      "  float large = mix(b, a, isLarge);\n"
      "  float small = mix(a, b, isLarge);\n"
      "  sk_precise float c = sk_keep(s - large);\n"
      "  sk_precise float d = sk_keep(small - c);\n"
      "  return d;\n"
      "}\n"
      "float sk_trial_sum(float a, float b) {\n"
      "  sk_precise float s = sk_keep(a + b);\n"
      "  return s;\n"
      "}\n";
  static const program::Reduction reduction{
      .fold = {.name = "compensated sums",
               .entry = "sk_trial_fold",
               .declarations = functions,
               .body = "void sk_trial_fold(float x, $pinout float t, $pinout float lost) {\n"
                       "  lost += sk_trial_error(t, x);\n"
                       "  t = sk_trial_sum(t, x);\n"
                       "}\n",
               .parameters = folded,
               .sources = {},
               .usesExactSums = true},
      .combine = {.name = "compensated sums",
                  .entry = "sk_trial_combine",
                  .declarations = functions,
                  .body =
                      "void sk_trial_combine(float x, $pinout float t, float part, $pinout float lost) {\n"
                      "  lost += part;\n"
                      "  lost += sk_trial_error(t, x);\n"
                      "  t = sk_trial_sum(t, x);\n"
                      "}\n",
                  .parameters = combined,
                  .sources = {},
                  .usesExactSums = true},
      .combineOperands = {},
      .seeded = false,
      .commutative = true};
  return reduction;
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

/// Whether the folds of the row from an element on are right: the sum to the bit, and its rounding errors but for their own.
bool areFolds(std::span<const float2> given, std::size_t element, const float4& found) {
  const std::size_t first = element / rowLength * rowLength;
  float sum = given[element].x, errors = 0, magnitude = 0;
  for (std::size_t k = 1; k < foldCount; ++k) {
    const float4 next = exactSumAndProduct({sum, given[first + (element + k) % rowLength].x});
    sum = next.x;
    errors += next.y;
    magnitude += std::abs(next.y);
  }
  // Beyond that range, errors are no numbers, or denormal ones, which devices may flush.
  if (!(std::abs(sum) < 0x1p100F) || !(magnitude > 0x1p-90F)) return true;
  const float most = magnitude * 0x1p-10F;
  return found.x == sum && found.z == sum && std::abs(found.y - errors) <= most &&
         std::abs(found.w - errors) <= most;
}

/// Elements whose sum is small: those of the second half cancel those of the first but for their last bits, and not before the last
/// partial results are combined. All are multiples of 2^-13 below 2^12.
struct Cancelling {
  std::vector<float> elements;
  double sum = 0;
};
Cancelling cancelling(std::size_t count) {
  Cancelling made;
  std::mt19937 random(1965);
  std::vector<float> large(count / 2);
  for (float& one : large) one = 1024 + static_cast<float>(random() >> 8) * 0x1p-13F;
  for (const float one : large) made.elements.push_back(one + static_cast<float>(random() >> 15) * 0x1p-24F);
  for (std::size_t i = large.size(); i > 0; --i) made.elements.push_back(-large[i - 1]);
  for (const float one : made.elements) made.sum += one;  // exact
  return made;
}

/// Whether the programs that reduce keep the rounding errors as well: a long stream to one result, and rows to one each. Errors
/// add up to some 2^3, of which each step rounds 2^-24 away; the result without them is off by 2^-4 and more.
bool holdsInReductions(GlDevice& device, Target target) {
  constexpr std::int64_t length = 6144, rows = 4;
  const Cancelling given = cancelling(length);
  for (const bool isInRows : {false, true}) {
    const Shape shape = isInRows ? Shape{rows, length} : Shape{length};
    const Shape results = isInRows ? Shape{rows, 1} : Shape{1};
    const auto stream = [&](const Shape& of) {
      return device.createStream(ElementTraits<float>::element(), of, Storage::Single);
    };
    const auto x = stream(shape), t = stream(results), lost = stream(results);
    const std::array<Argument, 3> arguments{{{.region = detail::wholeRegion(x.get())},
                                             {.region = detail::wholeRegion(t.get())},
                                             {.region = detail::wholeRegion(lost.get())}}};
    std::vector<float> elements;
    for (std::int64_t row = 0; row < (isInRows ? rows : 1); ++row)
      elements.insert(elements.end(), given.elements.begin(), given.elements.end());
    detail::write(arguments[0].region, elements.data(), elements.size());
    device.reduce({.device = device,
                   .reduction = compensatedSum(),
                   .arguments = arguments,
                   .domain = shape,
                   .blocks = results,
                   .options = {.target = target}});
    std::vector<float> sums(static_cast<std::size_t>(results.size())), errors(sums.size());
    detail::read(arguments[1].region, sums.data(), sums.size());
    detail::read(arguments[2].region, errors.data(), errors.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
      if (!(std::abs(double{sums[i]} + double{errors[i]} - given.sum) <= 0x1p-12)) return false;
  }
  return true;
}

/// Whether programs of a target keep the rounding errors.
bool holds(GlDevice& device, Barrier barrier, Target target) {
  device.programs().setBarrier(barrier);
  const std::vector<float2> given = trialPairs(pairCount);
  const Shape shape{static_cast<std::int64_t>(given.size()) / rowLength, rowLength};
  const auto x = device.createStream(ElementTraits<float2>::element(), shape, Storage::Single);
  const auto r = device.createStream(ElementTraits<float4>::element(), shape, Storage::Single);
  const auto s = device.createStream(ElementTraits<float4>::element(), shape, Storage::Single);
  const auto regionOf = [](const auto& stream) {
    return Argument{.region = detail::wholeRegion(stream.get())};
  };
  const std::array<Argument, 5> arguments{
      regionOf(x), regionOf(x), {.value = &foldCount}, regionOf(r), regionOf(s)};
  std::vector<float4> found(given.size()), folds(given.size());
  detail::write(arguments[0].region, given.data(), given.size());
  try {
    device.runUnchecked(exactSums(), arguments, {.precision = Precision::Extended, .target = target});
  } catch (const Error& error) {
    if (barrier != Barrier::Precise || error.kind() != Error::Kind::Compile) throw;
    return false;  // the compiler claims to support `precise`, but rejects it
  }
  detail::read(arguments[3].region, found.data(), found.size());
  detail::read(arguments[4].region, folds.data(), folds.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (found[i] != exactSumAndProduct(given[i]) || !areFolds(given, i, folds[i])) return false;
  }
  return holdsInReductions(device, target);
}

/// Whether the device also runs compute programs, which drivers compile by other rules.
bool mayDispatch(const GlDevice& device) {
  return device.capabilities.hasCompute && device.target != Target::Fragment;
}

bool holds(GlDevice& device, Barrier barrier) {
  return holds(device, barrier, Target::Fragment) &&
         (!mayDispatch(device) || holds(device, barrier, Target::Compute));
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

constexpr std::string_view cacheKind = "barriers-2";  ///< the second set of trials

/// The result of an earlier process; nullopt if there is none.
std::optional<Barrier> kept(const GlDevice& device, std::string_view key) {
  const std::optional<std::string> text = device.cache.read(cacheKind, key);
  if (text == "precise\n" && device.capabilities.hasPrecise) return Barrier::Precise;
  return text == "xor\n" ? std::optional(Barrier::Xor) : std::nullopt;
}

}  // namespace

Arithmetic probeArithmetic(GlDevice& device) {
  const std::string driver = driverKey(device.name(), device.driver(), device.profileName());
  const std::string key = driver + (mayDispatch(device) ? ", drawn and dispatched" : ", drawn");
  const Barrier strongest = device.programs().barrier();
  std::optional<Barrier> found = kept(device, key);
  if (!found) {
    try {
      found = firstThatHolds(device);
    } catch (...) {
      device.programs().setBarrier(strongest);  // the trial has changed it
      throw;
    }
    // failures are not cached, because they may be due to exhausted memory
    if (found) device.cache.write(cacheKind, key, std::string(nameOf(*found)) + '\n');
  }
  device.programs().setBarrier(found.value_or(strongest));
  return {.exactSums = found.has_value(),
          .barrier = found.value_or(Barrier::None),
          .asWritten = device.programs().barrier() == Barrier::Xor && computesAsWritten(device, driver)};
}

}  // namespace sk
