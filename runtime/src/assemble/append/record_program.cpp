// SPDX-License-Identifier: MIT
#include "assemble/append/record_program.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

#include "assemble/append/append_groups.hpp"
#include "glsl_text/combine_records.hpp"

namespace sk::assemble {

namespace {

using program::Field;
using program::Scalar;
using program::ScatterOp;

/// `sk_combine`, of the value so far and one that follows.
std::string combination(const program::Parameter& scatter, std::string_view type) {
  const Field& field = scatter.element->fields.front();
  if (scatter.scatter == ScatterOp::Add)
    return fmt::format("{0} sk_combine({0} a, {0} b) {{ return a + b; }}\n", type);
  const bool isMin = scatter.scatter == ScatterOp::Min;
  if (field.scalar != Scalar::Float)
    return fmt::format("{0} sk_combine({0} a, {0} b) {{ return {1}(a, b); }}\n", type, isMin ? "min" : "max");
  std::string text(orderOfFloats());
  text += fmt::format(
      "float sk_extreme(float a, float b) {{ return {}(floatBitsToUint(b), floatBitsToUint(a)) ? b : a; }}\n",
      isMin ? "sk_below" : "sk_above");
  std::string parts;
  for (int c = 0; c < field.width; ++c)
    parts += fmt::format("{0}sk_extreme(a.{1}, b.{1})", c == 0 ? "" : ", ", "xyzw"[c]);
  return text + fmt::format("{0} sk_combine({0} a, {0} b) {{ return {0}({1}); }}\n", type, parts);
}

}  // namespace

std::string recordProgram(const Profile& profile, const program::Parameter& scatter, bool isCounted) {
  static constexpr std::array<std::string_view, 5> swizzles = {"", ".x", ".xy", ".xyz", ""};
  static constexpr std::array<std::string_view, 5> rests = {"", ", 0, 0, 0", ", 0, 0", ", 0", ""};
  static constexpr std::array<std::string_view, 5> channels = {"", "r", "rg", "rgba", "rgba"};
  const Field& field = scatter.element->fields.front();
  const bool isFloat = field.scalar == Scalar::Float;
  const std::string_view kind = isFloat ? "" : field.scalar == Scalar::Int ? "i" : "u";
  const std::string_view type = scatter.element->glsl;
  const auto width = static_cast<std::size_t>(field.width);
  std::string text = fmt::format("{}\n{}{}", profile.version, isPair(scatter) ? "#define SK_PAIRS\n" : "",
                                 isCounted ? "#define SK_COUNTED\n" : "");
  text += fmt::format(
      "#define SK_VALUE {}\n#define SK_SWIZZLE {}\n#define SK_SAMPLER {}sampler2D\n#define SK_IMAGE "
      "{}image2D\n"
      "#define SK_FORMAT {}32{}\n#define SK_TEXEL(v) {}vec4(v{})\n",
      type, swizzles[width], kind, kind, channels[width],
      isFloat       ? "f"
      : kind == "u" ? "ui"
                    : "i",
      kind, rests[width]);
  text += combination(scatter, type);
  return text + std::string(library::combineRecords);
}

}  // namespace sk::assemble
