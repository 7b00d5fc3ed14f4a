// SPDX-License-Identifier: MIT
#include "probe/own_operations.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "device/stream_state.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/types.hpp"
#include "support/cache_folder.hpp"

namespace sk {

namespace own_operations {
namespace {

using program::Role;

constexpr int side = 32;  ///< of the streams
constexpr std::size_t elementCount = side * side;
constexpr int folded = 8;  ///< elements that each result of a loop folds
constexpr float infinity = std::numeric_limits<float>::infinity();

using Values = std::vector<float4>;

program::Parameter parameter(std::string_view name, Role role) {
  return {.name = name, .symbol = name, .role = role, .element = &ElementTraits<float4>::element()};
}

/// Operations that a compiler may combine, cancel or contract; without divisions, which need not be rounded correctly.
const program::Kernel& mapped() {
  static const std::array<program::Parameter, 4> parameters{
      parameter("x", Role::Input), parameter("p", Role::Output), parameter("q", Role::Output),
      parameter("r", Role::Output)};
  static const program::Kernel kernel{
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

/// What compilers make of literals that are 0, of signs, and of operands that are the same.
const program::Kernel& mappedZeros() {
  static const std::array<program::Parameter, 3> parameters{
      parameter("x", Role::Input), parameter("p", Role::Output), parameter("q", Role::Output)};
  static const program::Kernel kernel{
      .name = "zeros as they are written",
      .entry = "sk_own_zeros",
      .declarations = {},
      .body =
          "void sk_own_zeros(vec4 x, out vec4 p, out vec4 q) {\n"
          "  vec2 z = vec2(0.0, 1.0);\n"
          "  p = vec4(x.x + 0.0, x.x * 0.0, 0.0 - x.x, x.x - x.x);\n"
          "  q = vec4(-(x.x - x.y), (x.xy * z).x, (x.yx + z).x, x.x * -1.0 + x.x);\n"
          "}\n",
      .parameters = parameters,
      .sources = {}};
  return kernel;
}

/// What compilers know to undo each other, and a divisor that they know beside one that they do not. Roots and quotients need not be
/// rounded correctly, so that results are not known in advance.
const program::Kernel& mappedBack() {
  static const std::array<program::Parameter, 2> parameters{parameter("x", Role::Input),
                                                            parameter("p", Role::Output)};
  static const program::Kernel kernel{.name = "roots and quotients as they are written",
                                      .entry = "sk_own_back",
                                      .declarations = {},
                                      .body =
                                          "void sk_own_back(vec4 x, out vec4 p) {\n"
                                          "  float root = sqrt(x.x), inverse = 1.0 / x.y;\n"
                                          "  p = vec4(root * root, 1.0 / inverse, x.z / 3.0, x.z / x.w);\n"
                                          "}\n",
                                      .parameters = parameters,
                                      .sources = {}};
  return kernel;
}

/// The same in a loop of a known length, which compilers unroll: what it begins with is a literal.
const program::Kernel& foldedInLoop() {
  static const auto parameters = [] {
    std::array<program::Parameter, 3> list{parameter("x", Role::Gather), parameter("r", Role::Output),
                                           parameter("s", Role::Output)};
    list[0].rank = 2;
    list[0].usesAt = true;
    return list;
  }();
  static const program::Kernel kernel{
      .name = "folds as they are written",
      .entry = "sk_own_folds",
      .declarations = {},
      .body =
          "void sk_own_folds(out vec4 r, out vec4 s) {\n"
          "  ivec2 at = sk_index().xy;\n"
          "  r = s = vec4(0.0);\n"
          "  for (int i = 0; i < 8; ++i) {\n"
          "    vec4 x = sk_at_x(ivec2((at.x + i) & 31, at.y));\n"
          "    r = vec4(r.x + x.x * x.y, r.y * 0.3 * 0.7 + x.y, r.z + x.z + 1e6 - 1e6, r.w + x.w * 0.0);\n"
          "    s = vec4(s.x + x.w, s.y + x.x - s.y, s.z + float(i) * x.w, (s.w + x.z) * 0.1 * 10.0);\n"
          "  }\n"
          "}\n",
      .parameters = parameters,
      .sources = {},
      .usesIndex = true,
      .usesLoops = true};
  return kernel;
}

// The same operations on the host. Each result is stored, so that no compiler contracts it.
float times(float a, float b) {
  volatile float product = a * b;
  return product;
}
float plus(float a, float b) {
  volatile float sum = a + b;
  return sum;
}

std::array<float4, 3> mappedAsWritten(const float4& x) {
  const float sum = plus(plus(times(x.x, x.y), times(x.y, x.z)), times(x.z, x.w));
  const float all = plus(plus(plus(times(x.x, x.w), times(x.y, x.z)), times(x.z, x.y)), times(x.w, x.x));
  return {{{times(times(x.x, 0.1F), 10), times(times(x.x, 0.3F), 0.7F), plus(plus(x.x, 1e6F), 3.3F),
            plus(plus(x.x, 1e6F), -1e6F)},
           {plus(plus(x.x, x.y), -x.x), plus(times(x.x, x.y), times(x.x, x.z)), plus(times(x.x, x.y), -x.z),
            plus(plus(x.x, -x.y), x.y)},
           {sum, all, plus(x.z, -plus(x.z, -x.x)), plus(times(x.x, x.x), -times(x.y, x.y))}}};
}

std::array<float4, 2> zerosAsWritten(const float4& x) {
  return {{{plus(x.x, 0), times(x.x, 0), plus(0, -x.x), plus(x.x, -x.x)},
           {-plus(x.x, -x.y), times(x.x, 0), plus(x.y, 0), plus(times(x.x, -1), x.x)}}};
}

std::array<float4, 2> foldedAsWritten(const Values& given, std::size_t element) {
  float4 r{}, s{};
  const std::size_t row = element / side * side;
  for (std::size_t i = 0; i < folded; ++i) {
    const float4& x = given[row + (element + i) % side];
    r = {plus(r.x, times(x.x, x.y)), plus(times(times(r.y, 0.3F), 0.7F), x.y),
         plus(plus(plus(r.z, x.z), 1e6F), -1e6F), plus(r.w, times(x.w, 0))};
    s = {plus(s.x, x.w), plus(plus(s.y, x.x), -s.y), plus(s.z, times(static_cast<float>(i), x.w)),
         times(times(plus(s.w, x.z), 0.1F), 10)};
  }
  return {r, s};
}

/// The same bits, or NaN of any kind in both.
bool isSame(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}
bool isSame(const float4& a, const float4& b) {
  return isSame(a.x, b.x) && isSame(a.y, b.y) && isSame(a.z, b.z) && isSame(a.w, b.w);
}

/// Numbers of [1, 100).
Values ordinary() {
  std::mt19937 random(2026);
  const auto number = [&] { return 1 + 99 * static_cast<float>(random() >> 8) * 0x1p-24F; };
  Values values;
  while (values.size() < elementCount) values.push_back({number(), number(), number(), number()});
  return values;
}

/// The same with either sign, among them zeros and, in x and y, infinities.
Values withZeros() {
  Values values = ordinary();
  for (std::size_t i = 0; i < values.size(); ++i) {
    float4& x = values[i];
    if (i % 2 == 1) x.x = -x.x;
    if (i % 3 == 1) x.y = -x.y;
    if (i % 5 == 2) x.x = i % 2 == 0 ? 0.0F : -0.0F;
    if (i % 7 == 3) x.y = i % 2 == 0 ? 0.0F : -0.0F;
    if (i % 11 == 4) x.x = i % 2 == 0 ? infinity : -infinity;
  }
  return values;
}

/// The same for a loop: rows of negative numbers and of negative zeros in w.
Values forLoops() {
  Values values = ordinary();
  for (std::size_t i = 0; i < values.size(); ++i) {
    float& w = values[i].w;
    const std::size_t row = i / side;
    if (row % 4 == 1) w = -w;
    if (row % 4 == 2) w = -0.0F;
    if (row % 4 == 3) w = i % 2 == 0 ? 0.0F : -0.0F;
  }
  return values;
}

/// Runs the kernel, whose first parameter has the values, without a barrier; one list for each other parameter.
std::vector<Values> results(GlDevice& device, const program::Kernel& kernel, Target target,
                            const Values& given) {
  std::vector<std::unique_ptr<StreamState>> streams;
  std::vector<Argument> arguments;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    streams.push_back(
        device.createStream(ElementTraits<float4>::element(), Shape{side, side}, Storage::Single));
    arguments.push_back({.region = detail::wholeRegion(streams.back().get())});
  }
  detail::write(arguments[0].region, given.data(), given.size());
  device.runUnchecked(kernel, arguments, {.target = target, .contraction = Contraction::Fast});
  std::vector<Values> lists;
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    lists.emplace_back(given.size());
    detail::read(arguments[i].region, lists.back().data(), given.size());
  }
  return lists;
}

template <class Expected>
bool hasResults(GlDevice& device, const program::Kernel& kernel, Target target, const Values& given,
                Expected&& expected) {
  const std::vector<Values> found = results(device, kernel, target, given);
  for (std::size_t element = 0; element < given.size(); ++element) {
    const auto wanted = expected(element);
    for (std::size_t output = 0; output < found.size(); ++output)
      if (!isSame(found[output][element], wanted[output])) return false;
  }
  return true;
}

/// True unless a compiler took the square of each root and the inverse of each inverse for the number itself, which they are for
/// some numbers only, or divided otherwise by a number that it knew.
bool keepsRootsAndQuotients(GlDevice& device, Target target) {
  Values given = ordinary();
  for (float4& x : given) x.w = 3;
  const Values found = results(device, mappedBack(), target, given).front();
  bool areRootsUndone = true, areInversesUndone = true;
  for (std::size_t i = 0; i < given.size(); ++i) {
    areRootsUndone = areRootsUndone && isSame(found[i].x, given[i].x);
    areInversesUndone = areInversesUndone && isSame(found[i].y, given[i].y);
    if (!isSame(found[i].z, found[i].w)) return false;
  }
  return !areRootsUndone && !areInversesUndone;
}

bool passes(GlDevice& device, Target target) {
  const Values numbers = ordinary(), zeros = withZeros(), runs = forLoops();
  return hasResults(device, mapped(), target, numbers,
                    [&](std::size_t i) { return mappedAsWritten(numbers[i]); }) &&
         hasResults(device, mappedZeros(), target, zeros,
                    [&](std::size_t i) { return zerosAsWritten(zeros[i]); }) &&
         hasResults(device, foldedInLoop(), target, runs,
                    [&](std::size_t i) { return foldedAsWritten(runs, i); }) &&
         keepsRootsAndQuotients(device, target);
}

}  // namespace
}  // namespace own_operations

bool computesAsWritten(GlDevice& device, std::string_view key) {
  constexpr std::string_view kind = "own-operations-2";  // the second set of them
  if (const std::optional<std::string> text = device.cache.read(kind, key)) return *text == "kept\n";
  const bool isKept = own_operations::passes(device, Target::Fragment) &&
                      (!device.capabilities.hasCompute || own_operations::passes(device, Target::Compute));
  device.cache.write(kind, key, isKept ? "kept\n" : "changed\n");
  return isKept;
}

}  // namespace sk
