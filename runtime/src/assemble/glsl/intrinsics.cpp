// SPDX-License-Identifier: MIT
//
// The table of intrinsics, and the definitions of those that a kernel uses: their parts first, then the functions of
// one float, then those of vectors.
#include "assemble/glsl/intrinsics.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "assemble/glsl/intrinsic_parts.hpp"

namespace sk::assemble {
namespace {

using program::Intrinsic;
using program::IntrinsicUse;

/// `fast`: the device's own function of x, y and z, whose type is $T. `text`: ours, of one float; empty where it is a part.
struct Row {
  std::string_view name;
  int arguments;
  std::string_view fast;
  Parts parts;
  std::string_view text;
};

// clang-format off: in the order of program::Intrinsic
constexpr std::array rows = {
    Row{"sk_sin", 1, "sin(x)", parts(Part::WithSign, Part::Wave), R"(
float sk_sin(float x) { return sk_toggle_sign(sk_wave(abs(x), 0), x); }
)"},
    Row{"sk_cos", 1, "cos(x)", parts(Part::Wave), R"(
float sk_cos(float x) { return sk_wave(abs(x), 1); }
)"},
    Row{"sk_tan", 1, "tan(x)", parts(Part::WithSign, Part::Reduce), R"(
float sk_tan(float x) {
  float a = abs(x);
  if (!(a < uintBitsToFloat(0x7f800000u))) return uintBitsToFloat(0x7fc00000u);
  int q;
  float r = sk_reduce(a, q);
  float z = r * r;
  float p = 9.38540185543e-3;
  p = p * z + 3.11992232697e-3;
  p = p * z + 2.44301354525e-2;
  p = p * z + 5.34112807005e-2;
  p = p * z + 1.33387994085e-1;
  p = p * z + 3.33331568548e-1;
  float t = r + r * (z * p);
  return sk_toggle_sign((q & 1) == 0 ? t : -1.0 / t, x);
}
)"},
    Row{"sk_asin", 1, "asin(x)", parts(Part::WithSign, Part::AsinPart), R"(
float sk_asin(float x) {
  float a = abs(x);
  if (!(a <= 1.0)) return uintBitsToFloat(0x7fc00000u);
  bool outer = a > 0.5;
  float z = outer ? 0.5 - 0.5 * a : a * a;
  float b = outer ? sqrt(z) : a;
  // what a device's root lacks, by the part of it whose square is exact
  float h = uintBitsToFloat(floatBitsToUint(b) & 0xfffff000u);
  if (outer) b = h + (z - h * h) / (b + h + 1e-30);
  float part = sk_asin_part(b, z);
  float y = outer ? 1.57079637 - (2.0 * b + (2.0 * part + 4.371139e-8)) : b + part;
  return sk_toggle_sign(y, x);
}
)"},
    Row{"sk_acos", 1, "acos(x)", parts(Part::AsinPart), R"(
float sk_acos(float x) {
  float a = abs(x);
  if (!(a <= 1.0)) return uintBitsToFloat(0x7fc00000u);
  bool outer = a > 0.5;
  float z = outer ? 0.5 - 0.5 * a : a * a;
  float b = outer ? sqrt(z) : x;
  float part = sk_asin_part(b, z);
  if (!outer) return 1.57079637 - (b + (part + 4.371139e-8));
  float y = 2.0 * (b + part);
  return x < 0.0 ? 3.14159274 - (y + 8.742278e-8) : y;
}
)"},
    Row{"sk_atan", 1, "atan(x)", parts(Part::WithSign, Part::AtanPart), R"(
float sk_atan(float x) {
  float a = abs(x);
  float part = sk_atan_part(a > 1.0 ? 1.0 / a : a);
  return sk_toggle_sign(a > 1.0 ? 1.57079637 - (part + 4.371139e-8) : part, x);
}
)"},
    Row{"sk_atan2", 2, "atan(x, y)", parts(Part::WithSign, Part::AtanPart), R"(
float sk_atan2(float y, float x) {
  uint a = floatBitsToUint(x) & 0x7fffffffu;
  uint b = floatBitsToUint(y) & 0x7fffffffu;
  if (a > 0x7f800000u || b > 0x7f800000u) return uintBitsToFloat(0x7fc00000u);
  float larger = uintBitsToFloat(max(a, b));
  float scale = larger > 1e30 ? 9.094947e-13 : 1.0;   // 2^-40: some devices divide by way of the reciprocal
  float t = (uintBitsToFloat(min(a, b)) * scale) / (larger * scale);
  t = a == b ? (a == 0u ? 0.0 : 1.0) : t;
  float angle = sk_atan_part(t);
  angle = b > a ? 1.57079637 - (angle + 4.371139e-8) : angle;
  angle = floatBitsToInt(x) < 0 ? 3.14159274 - (angle + 8.742278e-8) : angle;
  return sk_toggle_sign(angle, y);
}
)"},
    Row{"sk_sinh", 1, "sinh(x)", parts(Part::WithSign, Part::ExpScaled), R"(
float sk_sinh(float x) {
  float a = abs(x);
  float z = a * a;
  float p = 2.03721912945e-4;
  p = p * z + 8.33028376239e-3;
  p = p * z + 1.66667160211e-1;
  float e = sk_exp_scaled(a, -1);
  float y = a > 100.0 ? uintBitsToFloat(0x7f800000u) : e - 0.25 / e;
  return sk_toggle_sign(a < 1.0 ? a + a * (z * p) : y, x);
}
)"},
    Row{"sk_cosh", 1, "cosh(x)", parts(Part::ExpScaled), R"(
float sk_cosh(float x) {
  float a = abs(x);
  float e = sk_exp_scaled(a, -1);
  return a > 100.0 ? uintBitsToFloat(0x7f800000u) : e + 0.25 / e;
}
)"},
    Row{"sk_tanh", 1, "tanh(x)", parts(Part::WithSign, Part::ExpScaled), R"(
float sk_tanh(float x) {
  float a = abs(x);
  float z = a * a;
  float p = -5.70498872745e-3;
  p = p * z + 2.06390887954e-2;
  p = p * z - 5.37397155531e-2;
  p = p * z + 1.33314422036e-1;
  p = p * z - 3.33332819422e-1;
  float e = sk_exp_scaled(2.0 * a, 0);
  float y = a > 10.0 ? 1.0 : 1.0 - 2.0 / (e + 1.0);
  return sk_toggle_sign(a < 0.625 ? a + a * (z * p) : y, x);
}
)"},
    Row{"sk_asinh", 1, "asinh(x)", parts(Part::WithSign, Part::Log), R"(
float sk_asinh(float x) {
  float a = abs(x);
  float z = a * a;
  float p = -1.182018459e-3;
  p = p * z + 6.19388835e-3;
  p = p * z - 1.568352482e-2;
  p = p * z + 2.787090207e-2;
  p = p * z - 4.410435271e-2;
  p = p * z + 7.494327847e-2;
  p = p * z - 1.666646068e-1;
  if (a <= 1.0) return sk_toggle_sign(a + a * (z * p), x);
  bool huge = a > 1e9;
  float y = sk_log(huge ? a : a + sqrt(z + 1.0)) + (huge ? 0.693147181 : 0.0);
  return sk_toggle_sign(y, x);
}
)"},
    Row{"sk_acosh", 1, "acosh(x)", parts(Part::Log), R"(
float sk_acosh(float x) {
  float t = x - 1.0;
  float p = 1.7596881071e-3;
  p = p * t - 7.5272886713e-3;
  p = p * t + 2.6454905019e-2;
  p = p * t - 1.1784741703e-1;
  p = p * t + 1.4142135263;
  if (x >= 1.0 && x < 1.5) return sqrt(t) * p;
  bool huge = x > 1e9;
  float y = sk_log(huge ? x : x + sqrt(t * (x + 1.0))) + (huge ? 0.693147181 : 0.0);
  return x < 1.0 ? uintBitsToFloat(0x7fc00000u) : y;
}
)"},
    Row{"sk_atanh", 1, "atanh(x)", parts(Part::WithSign, Part::Log), R"(
float sk_atanh(float x) {
  float a = abs(x);
  if (!(a <= 1.0)) return uintBitsToFloat(0x7fc00000u);   // quotients of numbers so large are not the same everywhere
  float z = a * a;
  float p = 1.81740078349e-1;
  p = p * z + 8.24370301058e-2;
  p = p * z + 1.46691431730e-1;
  p = p * z + 1.99782164500e-1;
  p = p * z + 3.33337300303e-1;
  if (a < 0.5) return sk_toggle_sign(a + a * (z * p), x);
  return sk_toggle_sign(0.5 * sk_log((1.0 + a) / (1.0 - a)), x);
}
)"},
    Row{"sk_exp", 1, "exp(x)", parts(Part::ExpScaled), R"(
float sk_exp(float x) {
  float y = sk_exp_scaled(x, 0);
  return x > 90.0 ? uintBitsToFloat(0x7f800000u) : x < -104.0 ? 0.0 : y;
}
)"},
    Row{"sk_exp2", 1, "exp2(x)", parts(Part::Scale, Part::Exp2Part), R"(
float sk_exp2(float x) {
  float n = roundEven(x);
  float y = sk_scale(sk_exp2_part(x - n), int(n));
  return x >= 128.0 ? uintBitsToFloat(0x7f800000u) : x < -150.0 ? 0.0 : y;
}
)"},
    Row{"sk_log", 1, "log(x)", parts(Part::Log), ""},
    Row{"sk_log2", 1, "log2(x)", parts(Part::Mantissa, Part::LogLimit, Part::LogTail), R"(
float sk_log2(float x) {
  uint bits = floatBitsToUint(x);
  int e;
  float f = sk_mantissa(bits, e) - 1.0;
  float tail = sk_log_tail(f) - 0.5 * (f * f);
  float y = tail * 0.44269504 + f * 0.44269504 + tail + f + float(e);
  return bits - 1u < 0x7f7fffffu ? y : sk_log_limit(x);
}
)"},
    Row{"sk_log10", 1, "log2(x) * 0.30103", parts(Part::Mantissa, Part::LogLimit, Part::LogTail), R"(
float sk_log10(float x) {
  uint bits = floatBitsToUint(x);
  int e;
  float f = sk_mantissa(bits, e) - 1.0;
  float n = float(e);
  float tail = sk_log_tail(f) - 0.5 * (f * f);
  float y = (f + tail) * 7.00731903e-4 + n * 2.48745664e-4 + tail * 0.43359375 + f * 0.43359375 + n * 0.30078125;
  return bits - 1u < 0x7f7fffffu ? y : sk_log_limit(x);
}
)"},
    Row{"sk_pow", 2, "pow(x, y)", parts(Part::Power), R"(
float sk_pow(float x, float y) {
  uint bits = floatBitsToUint(x);
  uint a = bits & 0x7fffffffu;
  uint b = floatBitsToUint(y) & 0x7fffffffu;
  if (b == 0u || bits == 0x3f800000u) return 1.0;
  if (a > 0x7f800000u || b > 0x7f800000u) return uintBitsToFloat(0x7fc00000u);
  bool whole = floor(y) == y;
  bool odd = whole && floor(0.5 * y) != 0.5 * y;
  bool below = floatBitsToInt(y) < 0;
  float p = sk_power(a, clamp(y, -1.0995116e12, 1.0995116e12));
  if (a == 0u) p = uintBitsToFloat(below ? 0x7f800000u : 0u);
  if (a == 0x7f800000u) p = uintBitsToFloat(below ? 0u : 0x7f800000u);
  if (a == 0x3f800000u) p = 1.0;
  bool negative = floatBitsToInt(x) < 0;
  if (negative && !whole && a != 0u && a != 0x7f800000u) return uintBitsToFloat(0x7fc00000u);
  return negative && odd ? -p : p;
}
)"},
    Row{"sk_min", 2, "min(x, y)", parts(Part::Min), ""},
    Row{"sk_max", 2, "max(x, y)", parts(Part::Max), ""},
    Row{"sk_clamp", 3, "clamp(x, y, z)", parts(Part::Min, Part::Max), R"(
float sk_clamp(float x, float low, float high) { return sk_min(sk_max(x, low), high); }
)"},
    Row{"sk_saturate", 1, "clamp(x, 0.0, 1.0)", parts(Part::Saturate), ""},
    Row{"sk_fract", 1, "fract(x)", {}, R"(
float sk_fract(float x) {
  float f = x - floor(x);
  return f >= 1.0 ? 0.99999994 : f;
}
)"},
    Row{"sk_mod", 2, "mod(x, y)", parts(Part::Fmod), R"(
float sk_mod(float x, float y) {
  float r = sk_fmod(x, y);
  return r != 0.0 && (r < 0.0) != (y < 0.0) ? r + y : r;
}
)"},
    Row{"sk_fmod", 2, "mix(mix(x - y * trunc(x / y), x, isinf(y)), $T(uintBitsToFloat(0x7fc00000u)), isinf(x))", parts(Part::Fmod), ""},
    Row{"sk_mix", 3, "mix(x, y, z)", {}, R"(
float sk_mix(float x, float y, float t) {
  sk_precise float a = sk_keep(x * (1.0 - t));
  sk_precise float b = sk_keep(y * t);
  return a + b;
}
)"},
    Row{"sk_step", 2, "step(x, y)", {}, R"(
float sk_step(float edge, float x) { return x < edge ? 0.0 : 1.0; }
)"},
    Row{"sk_smoothstep", 3, "smoothstep(x, y, z)", parts(Part::Saturate), R"(
float sk_smoothstep(float low, float high, float x) {
  float t = sk_saturate((x - low) / (high - low));
  return t * t * (3.0 - 2.0 * t);
}
)"},
    Row{"sk_sign", 1, "sign(x)", {}, R"(
float sk_sign(float x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }
)"},
    Row{"sk_isnan", 1, "isnan(x)", {}, R"(
bool sk_isnan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
)"},
    Row{"sk_isinf", 1, "isinf(x)", {}, R"(
bool sk_isinf(float x) { return (floatBitsToUint(x) & 0x7fffffffu) == 0x7f800000u; }
)"},
    Row{"sk_length", 1, "length(x)", parts(Part::LengthScale), ""},
    Row{"sk_distance", 2, "distance(x, y)", parts(Part::LengthScale), ""},
    Row{"sk_normalize", 1, "normalize(x)", parts(Part::LengthScale), ""},
};
// clang-format on
static_assert(rows.size() == static_cast<std::size_t>(Intrinsic::Normalize) + 1);

const Row& rowOf(Intrinsic intrinsic) { return rows[static_cast<std::size_t>(intrinsic)]; }

bool isTest(Intrinsic intrinsic) { return intrinsic == Intrinsic::Isnan || intrinsic == Intrinsic::Isinf; }

/// Of all components together, and so without a function of one float.
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

/// "vec2 sk_pow(vec2 x, vec2 y) { return ".
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

std::string fastDefinition(Intrinsic intrinsic, int width) {
  return fmt::format("{} return {}; }}\n", head(intrinsic, width), withType(rowOf(intrinsic).fast, width));
}

/// By the function of one float.
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

/// The length of `v`, or v / length, of a vector multiplied by a power of 2.
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

IntrinsicTexts fastTexts(std::span<const IntrinsicUse> uses) {
  IntrinsicTexts texts{"\n"};
  for (const IntrinsicUse& use : uses) {
    for (int width = 1; width <= 4; ++width) {
      if (use.widths >> (width - 1) & 1) texts.definitions += fastDefinition(use.intrinsic, width);
    }
  }
  return texts;
}

}  // namespace

std::string_view name(Intrinsic intrinsic) { return rowOf(intrinsic).name; }

IntrinsicTexts intrinsicTexts(std::span<const IntrinsicUse> uses, bool accurate) {
  if (std::ranges::none_of(uses, &IntrinsicUse::widths)) return {};  // or of doubles alone
  if (!accurate) return fastTexts(uses);
  Parts used = 0;
  IntrinsicTexts texts;
  for (const IntrinsicUse& use : uses) {
    if (use.widths == 0) continue;
    used |= rowOf(use.intrinsic).parts;
    texts.useExactFloats = texts.useExactFloats || use.intrinsic == Intrinsic::Mix;
  }
  used = withNeeded(used);
  texts.useExactFloats = texts.useExactFloats || useExactFloats(used);
  for (unsigned i = 0; i < partCount; ++i) {
    if (used >> i & 1u) texts.definitions += text(static_cast<Part>(i));
  }
  for (const IntrinsicUse& use : uses) {
    if (use.widths != 0) texts.definitions += accurateDefinition(use);
  }
  return texts;
}

}  // namespace sk::assemble
