// SPDX-License-Identifier: MIT
#include "assemble/glsl/tables.hpp"

#include <fmt/format.h>

namespace sk::assemble {
namespace {

/// Clamps arguments to the range; NaN gives NaN, whatever clamp() does with it.
std::string lookUpText(const program::TableUse& use) {
  const bool isLinear = use.table->interpolation == Interpolation::Linear;
  return fmt::format(
      R"(
uniform sampler2D {table};
uniform vec3 {range};   // low, intervals for each unit, intervals
float sk_table_{name}(float sk_x) {{
  float sk_p = clamp((sk_x - {range}.x) * {range}.y, 0.0, {range}.z);
  int sk_i = clamp(int(sk_p), 0, int({range}.z) - 1);
  {type} sk_c = texelFetch({table}, ivec2(sk_i & {mask}, sk_i >> {shift}), 0).{components};
  float sk_t = sk_p - float(sk_i);
  float sk_y = {polynomial};
  return (floatBitsToUint(sk_x) & 0x7fffffffu) > 0x7f800000u ? sk_x : sk_y;
}}
)",
      fmt::arg("table", tableName(use.name)), fmt::arg("range", rangeName(use.name)),
      fmt::arg("name", use.name), fmt::arg("type", isLinear ? "vec2" : "vec4"),
      fmt::arg("mask", tableWidth - 1), fmt::arg("shift", tableShift),
      fmt::arg("components", isLinear ? "xy" : "xyzw"),
      fmt::arg("polynomial", isLinear ? "sk_c.x + sk_t * sk_c.y"
                                      : "sk_c.x + sk_t * (sk_c.y + sk_t * (sk_c.z + sk_t * sk_c.w))"));
}

std::string callText(const program::TableUse& use) {
  return fmt::format("\nfloat {0}(float);\nfloat sk_table_{0}(float sk_x) {{ return {0}(sk_x); }}\n",
                     use.name);
}

}  // namespace

std::string tableName(std::string_view function) { return fmt::format("sk_values_{}", function); }
std::string rangeName(std::string_view function) { return fmt::format("sk_range_{}", function); }

std::string tableDefinitions(std::span<const program::TableUse> uses, bool lookUp) {
  std::string text;
  for (const program::TableUse& use : uses) text += lookUp ? lookUpText(use) : callText(use);
  return text;
}

}  // namespace sk::assemble
