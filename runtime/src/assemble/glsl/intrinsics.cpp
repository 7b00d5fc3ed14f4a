// SPDX-License-Identifier: MIT
//
// The table of intrinsics, and the definitions of those that a kernel uses: their parts, then functions of one float, then
// functions of vectors. Coefficients of sin, cos, tan, exp, log, sinh, tanh, acosh and atanh are from Cephes (Moshier,
// 1992); the others are our own minimax polynomials. Range reductions, and the logarithm of a power, must subtract exactly
// as written (own_arithmetic.hpp); everything else may be contracted or slightly reordered.

#include "assemble/glsl/intrinsics.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "glsl_text/intrinsic_parts.hpp"
#include "glsl_text/intrinsics.hpp"

namespace sk::assemble {
namespace {

struct PartRow {
  Parts needs;
  std::string_view text;
};

// clang-format off
constexpr std::array<PartRow, partCount> partRows = {{
    {{}, library::toggleSign},
    {{}, library::scale},
    {{}, library::mantissa},
    {{}, library::logLimit},
    {{}, library::logTail},
    {parts(Part::Mantissa, Part::LogLimit, Part::LogTail), library::log},
    {parts(Part::Scale), library::expScaled},
    {{}, library::exp2Part},
    {{}, library::cut},
    {parts(Part::Mantissa, Part::Scale, Part::Exp2Part, Part::Cut), library::power},
    {{}, library::productHigh},
    {parts(Part::ProductHigh), library::reduceLarge},
    {parts(Part::ReduceLarge), library::reduce},
    {parts(Part::Reduce), library::wave},
    {{}, library::asinPart},
    {{}, library::atanPart},
    {{}, library::order},
    {parts(Part::Order), library::min},
    {parts(Part::Order), library::max},
    {{}, library::saturate},
    {parts(Part::Scale, Part::WithSign), library::fmod},
    {{}, library::lengthScale},
    {parts(Part::Scale, Part::Cut), library::errorPart},
}};
// clang-format on

bool keeps(std::string_view text) { return text.find("sk_keep") != std::string_view::npos; }

}  // namespace

Parts withNeeded(Parts set) {
  for (unsigned i = partCount; i-- > 0;) {
    if (set >> i & 1u) set |= partRows[i].needs;
  }
  return set;
}

bool useExactFloats(Parts set) {
  for (unsigned i = 0; i < partCount; ++i) {
    if ((set >> i & 1u) && keeps(partRows[i].text)) return true;
  }
  return false;
}

std::string_view text(Part part) { return partRows[static_cast<std::size_t>(part)].text; }

namespace {

using program::Intrinsic;
using program::IntrinsicUse;

/// `fast` is the device's own function of x, y and z, of type $T; empty if it has none. `text` is ours, of one float; empty if it
/// is a part.
struct Row {
  std::string_view name;
  int arguments;
  std::string_view fast;
  Parts parts;
  std::string_view text;
};

// clang-format off: in the order of program::Intrinsic
constexpr std::array rows = {
    Row{"sk_sin", 1, "sin(x)", parts(Part::WithSign, Part::Wave), library::sin},
    Row{"sk_cos", 1, "cos(x)", parts(Part::Wave), library::cos},
    Row{"sk_tan", 1, "tan(x)", parts(Part::WithSign, Part::Reduce), library::tan},
    Row{"sk_asin", 1, "asin(x)", parts(Part::WithSign, Part::AsinPart), library::asin},
    Row{"sk_acos", 1, "acos(x)", parts(Part::AsinPart), library::acos},
    Row{"sk_atan", 1, "atan(x)", parts(Part::WithSign, Part::AtanPart), library::atan},
    Row{"sk_atan2", 2, "atan(x, y)", parts(Part::WithSign, Part::AtanPart), library::atan2},
    Row{"sk_sinh", 1, "sinh(x)", parts(Part::WithSign, Part::ExpScaled), library::sinh},
    Row{"sk_cosh", 1, "cosh(x)", parts(Part::ExpScaled), library::cosh},
    Row{"sk_tanh", 1, "tanh(x)", parts(Part::WithSign, Part::ExpScaled), library::tanh},
    Row{"sk_asinh", 1, "asinh(x)", parts(Part::WithSign, Part::Log), library::asinh},
    Row{"sk_acosh", 1, "acosh(x)", parts(Part::Log), library::acosh},
    Row{"sk_atanh", 1, "atanh(x)", parts(Part::WithSign, Part::Log), library::atanh},
    Row{"sk_exp", 1, "exp(x)", parts(Part::ExpScaled), library::exp},
    Row{"sk_exp2", 1, "exp2(x)", parts(Part::Scale, Part::Exp2Part), library::exp2},
    Row{"sk_log", 1, "log(x)", parts(Part::Log), ""},
    Row{"sk_log2", 1, "log2(x)", parts(Part::Mantissa, Part::LogLimit, Part::LogTail), library::log2},
    Row{"sk_log10", 1, "log2(x) * 0.30103", parts(Part::Mantissa, Part::LogLimit, Part::LogTail), library::log10},
    Row{"sk_hypot", 2, "sqrt(x * x + y * y)", parts(Part::LengthScale), library::hypot},
    Row{"sk_log1p", 1, "log(1.0 + x)", parts(Part::Mantissa, Part::LogLimit, Part::LogTail), library::log1p},
    Row{"sk_expm1", 1, "exp(x) - 1.0", parts(Part::ExpScaled), library::expm1},
    Row{"sk_cbrt", 1, "sign(x) * pow(abs(x), $T(1.0 / 3.0))", parts(Part::WithSign), library::cbrt},
    Row{"sk_erf", 1, "", parts(Part::WithSign, Part::ErrorPart), library::erf},
    Row{"sk_erfc", 1, "", parts(Part::ErrorPart), library::erfc},
    Row{"sk_pow", 2, "pow(x, y)", parts(Part::Power), library::pow},
    Row{"sk_min", 2, "min(x, y)", parts(Part::Min), ""},
    Row{"sk_max", 2, "max(x, y)", parts(Part::Max), ""},
    Row{"sk_clamp", 3, "clamp(x, y, z)", parts(Part::Min, Part::Max), library::clamp},
    Row{"sk_saturate", 1, "clamp(x, 0.0, 1.0)", parts(Part::Saturate), ""},
    Row{"sk_fract", 1, "fract(x)", {}, library::fract},
    Row{"sk_mod", 2, "mod(x, y)", parts(Part::Fmod), library::mod},
    Row{"sk_fmod", 2, "mix(mix(x - y * trunc(x / y), x, isinf(y)), $T(uintBitsToFloat(0x7fc00000u)), isinf(x))", parts(Part::Fmod), ""},
    Row{"sk_mix", 3, "mix(x, y, z)", {}, library::mix},
    Row{"sk_step", 2, "step(x, y)", {}, library::step},
    Row{"sk_smoothstep", 3, "smoothstep(x, y, z)", parts(Part::Saturate), library::smoothstep},
    Row{"sk_sign", 1, "sign(x)", {}, library::sign},
    Row{"sk_isnan", 1, "isnan(x)", {}, library::isnan},
    Row{"sk_isinf", 1, "isinf(x)", {}, library::isinf},
    Row{"sk_length", 1, "length(x)", parts(Part::LengthScale), ""},
    Row{"sk_distance", 2, "distance(x, y)", parts(Part::LengthScale), ""},
    Row{"sk_normalize", 1, "normalize(x)", parts(Part::LengthScale), ""},
};
// clang-format on
static_assert(rows.size() == static_cast<std::size_t>(Intrinsic::Normalize) + 1);

const Row& rowOf(Intrinsic intrinsic) { return rows[static_cast<std::size_t>(intrinsic)]; }

bool isTest(Intrinsic intrinsic) { return intrinsic == Intrinsic::Isnan || intrinsic == Intrinsic::Isinf; }

/// Whether it combines all components, and so has no function of one float.
bool isOfVectors(Intrinsic intrinsic) {
  return intrinsic == Intrinsic::Length || intrinsic == Intrinsic::Distance ||
         intrinsic == Intrinsic::Normalize;
}

std::string vectorType(std::string_view letter, int width) { return fmt::format("{}vec{}", letter, width); }
std::string floatType(int width) { return width == 1 ? "float" : vectorType("", width); }

std::string resultType(Intrinsic intrinsic, int width) {
  if (isTest(intrinsic)) return width == 1 ? "bool" : vectorType("b", width);
  return intrinsic == Intrinsic::Length || intrinsic == Intrinsic::Distance ? "float" : floatType(width);
}

/// For example "vec2 sk_pow(vec2 x, vec2 y) { return ".
std::string head(Intrinsic intrinsic, int width) {
  std::vector<std::string> parameters;
  for (int i = 0; i < rowOf(intrinsic).arguments; ++i) {
    parameters.push_back(fmt::format("{} {}", floatType(width), "xyz"[i]));
  }
  return fmt::format("{} {}({}) {{", resultType(intrinsic, width), rowOf(intrinsic).name,
                     fmt::join(parameters, ", "));
}

std::string withType(std::string_view pattern, int width) {
  std::string text(pattern);
  for (std::size_t at; (at = text.find("$T")) != std::string::npos;) text.replace(at, 2, floatType(width));
  return text;
}

std::string fastDefinitions(const IntrinsicUse& use) {
  std::string text;
  for (int width = 1; width <= 4; ++width) {
    if (use.widths >> (width - 1) & 1)
      text += fmt::format("{} return {}; }}\n", head(use.intrinsic, width),
                          withType(rowOf(use.intrinsic).fast, width));
  }
  return text;
}

/// Calls the function of one float for each component.
std::string byComponent(Intrinsic intrinsic, int width) {
  std::vector<std::string> components;
  for (int c = 0; c < width; ++c) {
    std::vector<std::string> arguments;
    for (int i = 0; i < rowOf(intrinsic).arguments; ++i) {
      arguments.push_back(fmt::format("{}.{}", "xyz"[i], "xyzw"[c]));
    }
    components.push_back(fmt::format("{}({})", rowOf(intrinsic).name, fmt::join(arguments, ", ")));
  }
  return fmt::format("{}\n  return {}({});\n}}\n", head(intrinsic, width), resultType(intrinsic, width),
                     fmt::join(components, ", "));
}

/// The length of `v`, or v / length, where `v` is scaled by a power of 2.
std::string ofVector(Intrinsic intrinsic, int width) {
  if (width == 1) {
    if (intrinsic == Intrinsic::Length) return "float sk_length(float x) { return abs(x); }\n";
    if (intrinsic == Intrinsic::Distance)
      return "float sk_distance(float x, float y) { return abs(x - y); }\n";
    return "float sk_normalize(float x) { return x == 0.0 ? x : x / abs(x); }\n";
  }
  std::string most = "bits.x";
  for (int c = 1; c < width; ++c) most = fmt::format("max({}, bits.{})", most, "xyzw"[c]);
  std::string text = fmt::format(
      "{0}\n"
      "  {1} bits = floatBitsToUint({2}) & 0x7fffffffu;\n"
      "  float scale = sk_length_scale({3});\n"
      "  {4} v = {2} * scale;\n",
      head(intrinsic, width), vectorType("u", width), intrinsic == Intrinsic::Distance ? "d" : "x", most,
      floatType(width));
  if (intrinsic == Intrinsic::Distance) {
    text.insert(text.find('\n') + 1, fmt::format("  {} d = x - y;\n", floatType(width)));
  }
  if (intrinsic == Intrinsic::Normalize) {
    return text +
           "  float square = dot(v, v);\n"
           "  return square == 0.0 ? x : v / sqrt(square);\n"
           "}\n";
  }
  return text + fmt::format(
                    "  if (any(equal(bits, {}(0x7f800000u)))) return uintBitsToFloat(0x7f800000u);\n"
                    "  return sqrt(dot(v, v)) * uintBitsToFloat(0x7f000000u - floatBitsToUint(scale));\n"
                    "}}\n",
                    vectorType("u", width));
}

std::string accurateDefinition(const IntrinsicUse& use) {
  std::string text(rowOf(use.intrinsic).text);
  for (int width = 1; width <= 4; ++width) {
    if (!(use.widths >> (width - 1) & 1)) continue;
    if (isOfVectors(use.intrinsic)) {
      text += ofVector(use.intrinsic, width);
    } else if (width > 1) {
      text += byComponent(use.intrinsic, width);
    }
  }
  return text;
}

}  // namespace

std::string_view name(Intrinsic intrinsic) { return rowOf(intrinsic).name; }

IntrinsicTexts intrinsicTexts(std::span<const IntrinsicUse> uses, bool accurate) {
  if (std::ranges::none_of(uses, &IntrinsicUse::widths)) return {};  // or only of doubles
  const auto isOurs = [&](const IntrinsicUse& use) {
    return use.widths != 0 && (accurate || rowOf(use.intrinsic).fast.empty());
  };
  Parts used = 0;
  IntrinsicTexts texts{accurate ? "" : "\n"};
  for (const IntrinsicUse& use : uses) {
    if (!isOurs(use)) continue;
    used |= rowOf(use.intrinsic).parts;
    texts.useExactFloats = texts.useExactFloats || keeps(rowOf(use.intrinsic).text);
  }
  used = withNeeded(used);
  texts.useExactFloats = texts.useExactFloats || useExactFloats(used);
  for (unsigned i = 0; i < partCount; ++i) {
    if (used >> i & 1u) texts.definitions += text(static_cast<Part>(i));
  }
  for (const IntrinsicUse& use : uses)
    texts.definitions += isOurs(use) ? accurateDefinition(use) : fastDefinitions(use);
  return texts;
}

}  // namespace sk::assemble
