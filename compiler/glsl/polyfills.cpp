// SPDX-License-Identifier: MIT
#include "glsl/polyfills.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "glsl/float_intrinsics.hpp"
#include "glsl/type_names.hpp"
#include "ir/print.hpp"
#include "ir/scalar_operations.hpp"
#include "sk/arithmetic_marks.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;
namespace mark = sk::program::mark;

/// "a.x && b.x, a.y && b.y" from a pattern with `@` for the component.
std::string byComponent(std::string_view pattern, int width) {
  std::vector<std::string> items;
  for (int i = 0; i < width; ++i) {
    std::string item(pattern);
    std::replace(item.begin(), item.end(), '@', "xyzw"[i]);
    items.push_back(std::move(item));
  }
  return join(items, ", ");
}

/// The function that rounds a value of the arithmetic type to a narrow scalar, as quantize.hpp specifies.
std::string quantizing(Scalar narrow) {
  switch (narrow) {
    case Scalar::Char: return "int sk_char(int x) { return (x << 24) >> 24; }\n";
    case Scalar::Uchar: return "int sk_uchar(int x) { return x & 255; }\n";
    case Scalar::Short: return "int sk_short(int x) { return (x << 16) >> 16; }\n";
    case Scalar::Ushort: return "int sk_ushort(int x) { return x & 65535; }\n";
    case Scalar::Half:
      return "float sk_half(float x) {\n"
             "  uint bits = floatBitsToUint(x), m = bits & 0x7fffffffu;\n"
             "  if (m > 0x7f800000u) return x;\n"
             "  uint r = (m + 0xfffu + ((m >> 13) & 1u)) & 0xffffe000u;\n"
             "  if (r > 0x477fe000u) r = 0x7f800000u;\n"
             "  if (m < 0x38800000u) {\n"
             "    r = floatBitsToUint(roundEven(uintBitsToFloat(m) * 16777216.0) * 5.9604645e-8);\n"
             "  }\n"
             "  return uintBitsToFloat((bits & 0x80000000u) | r);\n"
             "}\n";
    case Scalar::Unorm8:
    case Scalar::Unorm16:
      return fmt::format(
          "float sk_{0}(float x) {{\n"
          "  return x > 0.0 ? roundEven(min(x, 1.0) * {1:.1f}) / {2}{1:.1f}{3} : 0.0;\n}}\n",
          spelling(narrow), normalizedScale(narrow), mark::divisor, mark::divisorEnd);
    case Scalar::Snorm8:
    case Scalar::Snorm16:
      return fmt::format(
          "float sk_{0}(float x) {{\n"
          "  float y = x > -1.0 ? min(x, 1.0) : x <= -1.0 ? -1.0 : 0.0;\n"
          "  return roundEven(y * {1:.1f}) / {2}{1:.1f}{3};\n}}\n",
          spelling(narrow), normalizedScale(narrow), mark::divisor, mark::divisorEnd);
    case Scalar::Bool:
    case Scalar::Int:
    case Scalar::Uint:
    case Scalar::Float:
    case Scalar::Double: break;
  }
  return {};
}

}  // namespace

std::string withTypes(std::string_view pattern, Type argument) {
  std::string text;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char letter = pattern[i] == '$' && i + 1 < pattern.size() ? pattern[i + 1] : '\0';
    switch (letter) {
      case 'T': text += glslSpelling(argument.scalar, argument.width); break;
      case 'I': text += glslSpelling(Scalar::Int, argument.width); break;
      case 'U': text += glslSpelling(Scalar::Uint, argument.width); break;
      case 'B': text += glslSpelling(Scalar::Bool, argument.width); break;
      default: text += pattern[i]; continue;   // any other character, `$0` among them
    }
    ++i;
  }
  return text;
}

void Polyfills::add(std::string function) {
  if (std::find(functions_.begin(), functions_.end(), function) == functions_.end()) {
    functions_.push_back(std::move(function));
  }
}

void Polyfills::intrinsic(Intrinsic intrinsic, Type argument) {
  const std::string_view polyfill = row(intrinsic).polyfill;
  if (!polyfill.empty()) add(withTypes(polyfill, argument) + "\n");
}

std::string Polyfills::logical(BinaryOp op, int width) {
  const bool isAnd = op == BinaryOp::LogicalAnd;
  const std::string name = isAnd ? "sk_and" : "sk_or";
  add(fmt::format("bvec{0} {1}(bvec{0} a, bvec{0} b) {{ return bvec{0}({2}); }}\n", width, name,
                  byComponent(isAnd ? "a.@ && b.@" : "a.@ || b.@", width)));
  return name;
}

std::string Polyfills::quotient(BinaryOp op, Type lhs, Type rhs) {
  const bool isRemainder = op == BinaryOp::Rem;
  const std::string name = isRemainder ? "sk_rem" : "sk_div";
  if (lhs.scalar == Scalar::Int) {
    add(
        fmt::format("int {}(int a, int b) {{\n"
                    "  int d = b == 0 || (b == -1 && a == -2147483647 - 1) ? 1 : b;\n"
                    "  return {};\n}}\n",
                    name, isRemainder ? "a - a / d * d" : "a / d"));
  } else {
    add(fmt::format("uint {}(uint a, uint b) {{ return a {} (b == 0u ? 1u : b); }}\n", name,
                    isRemainder ? "%" : "/"));
  }
  const int width = std::max(lhs.width, rhs.width);
  if (width == 1) return name;
  add(fmt::format(
      "{0} {1}({2} a, {3} b) {{ return {0}({4}); }}\n", glslSpelling(lhs.scalar, width), name,
      glslSpelling(lhs.scalar, lhs.width), glslSpelling(rhs.scalar, rhs.width),
      byComponent(fmt::format("{}({}, {})", name, lhs.isVector() ? "a.@" : "a", rhs.isVector() ? "b.@" : "b"),
                  width)));
  return name;
}

std::string Polyfills::magnitude(Type type) {
  add(fmt::format("{0} sk_abs({0} x) {{ return max(x, -x); }}\n", glslSpelling(type.scalar, type.width)));
  return "sk_abs";
}

std::string Polyfills::nonzero() {
  add("bool sk_nonzero(float x) { return (floatBitsToUint(x) & 0x7fffffffu) != 0u; }\n");
  return "sk_nonzero";
}

std::string Polyfills::truncated(Type to) {
  const bool isInt = arithmeticScalar(to.scalar) == Scalar::Int;
  const std::string name = isInt ? "sk_int" : "sk_uint";
  add(isInt ? "int sk_int(float x) {\n"
              "  if (x >= 2147483648.0) return 2147483647;\n"
              "  return x > -2147483648.0 ? int(x) : x <= -2147483648.0 ? -2147483647 - 1 : 0;\n"
              "}\n"
            : "uint sk_uint(float x) { return x >= 4294967296.0 ? 0xffffffffu : x > 0.0 ? uint(x) : 0u; }\n");
  if (to.isVector()) {
    add(fmt::format("{0} {1}({2} x) {{ return {0}({3}); }}\n",
                    glslSpelling(arithmeticScalar(to.scalar), to.width), name,
                    glslSpelling(Scalar::Float, to.width), byComponent(name + "(x.@)", to.width)));
  }
  return name;
}

sk::program::IntrinsicUse& Polyfills::use(sk::program::Intrinsic intrinsic) {
  const auto found = std::ranges::find(intrinsics_, intrinsic, &sk::program::IntrinsicUse::intrinsic);
  return found != intrinsics_.end() ? *found : intrinsics_.emplace_back(intrinsic, std::uint8_t{0});
}

std::string Polyfills::defined(sk::program::Intrinsic intrinsic, int width) {
  std::uint8_t& widths = use(intrinsic).widths;
  widths = static_cast<std::uint8_t>(widths | 1U << (width - 1));
  return functionName(intrinsic);
}

std::string Polyfills::definedOfDouble(sk::program::Intrinsic intrinsic) {
  use(intrinsic).ofDouble = true;
  return functionName(intrinsic);
}

std::string Polyfills::quantize(Type type) {
  const std::string name = "sk_" + spelling(type.scalar);
  add(quantizing(type.scalar));
  if (type.isVector()) {
    add(fmt::format("{0} {1}({0} x) {{ return {0}({2}); }}\n", glslSpelling(type.scalar, type.width), name,
                    byComponent(name + "(x.@)", type.width)));
  }
  return name;
}

std::string Polyfills::select(Type type) {
  add(fmt::format(
      "{0} sk_select(bvec{1} c, {0} yes, {0} no) {{\n  return {0}({2});\n}}\n",
      glslSpelling(type.scalar, type.width), type.width,
      byComponent(type.isDouble() ? "sk_choose(c.@, yes.@, no.@)" : "c.@ ? yes.@ : no.@", type.width)));
  return "sk_select";
}

std::string Polyfills::component(Type vector, Type index) {
  const bool isUint = index.scalar == ir::Scalar::Uint;
  std::string choice;
  for (int i = 0; i + 1 < vector.width; ++i) {
    const std::string next = isUint ? fmt::format("{}u", i + 1) : std::to_string(i + 1);
    choice += fmt::format("i < {} ? v.{} : ", next, "xyzw"[i]);
  }
  add(fmt::format("{} sk_component({} v, {} i) {{\n  return {}v.{};\n}}\n", glslSpelling(vector.scalar, 1),
                  glslSpelling(vector.scalar, vector.width), isUint ? "uint" : "int", choice,
                  "xyzw"[vector.width - 1]));
  return "sk_component";
}

}  // namespace skc::emit
