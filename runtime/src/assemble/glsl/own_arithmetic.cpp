// SPDX-License-Identifier: MIT
//
// Replaces marks, and selects the definitions for a barrier (exact_sums.glsl).

#include "assemble/glsl/own_arithmetic.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <vector>

#include <fmt/format.h>

#include "glsl_text/exact_sums.hpp"

namespace sk::assemble {
namespace {

constexpr char first = '$';

/// The suffix of the variable for a value, by the digit of its mark, and its type.
struct Kept {
  std::string_view name, type;
};
constexpr std::array<Kept, 7> kept{{{"sk_exact1", "float"},
                                    {"sk_exact2", "vec2"},
                                    {"sk_exact3", "vec3"},
                                    {"sk_exact4", "vec4"},
                                    {"sk_exact2x2", "mat2"},
                                    {"sk_exact3x3", "mat3"},
                                    {"sk_exact4x4", "mat4"}}};

class Resolver {
 public:
  explicit Resolver(Barrier barrier) : barrier_(barrier) {}

  std::string text(std::string_view body) {
    for (std::size_t at = 0; at < body.size();) {
      const std::size_t next = std::min(body.find(first, at), body.size());
      result_ += body.substr(at, next - at);
      if (next == body.size()) break;
      at = replace(body, next + 1);
    }
    return std::move(result_);
  }

 private:
  /// Replaces the mark whose second character is at `at`; returns where the text goes on.
  std::size_t replace(std::string_view body, std::size_t at) {
    const bool isXor = barrier_ == Barrier::Xor, isPrecise = barrier_ == Barrier::Precise;
    switch (body[at]) {
      case 'p': result_ += isPrecise ? "precise " : ""; break;
      case '(': result_ += isXor ? "sk_keep(" : ""; break;
      case ')': result_ += isXor ? ")" : ""; break;
      case '[':
        brackets_.push_back(!isBracketed_);
        result_ += isXor ? "sk_keep(" : isBracketed_ ? "" : "(";
        break;
      case ']':
        result_ += isXor || brackets_.back() ? ")" : "";
        brackets_.pop_back();
        break;
      case 'v': {
        const Kept& variable = kept[static_cast<std::size_t>(body[++at] - '1')];
        if (isPrecise) result_ += fmt::format("({} = ", variable.name);
        isBracketed_ = isPrecise;   // another pair of brackets around the whole value would say nothing
        return at + 1;
      }
      case ';': result_ += isPrecise ? ")" : ""; break;
      case '=': places_.push_back({result_.size()}); break;
      case ',': compoundPart(); break;
      case '.':
        if (isXor) result_ += ")";
        places_.pop_back();
        break;
      case '/': result_ += isXor ? "sk_known(" : ""; break;
      case '|': result_ += isXor ? ")" : ""; break;
      case '<': result_ += isXor || isPrecise ? "sk_known(" : ""; break;
      case '>': result_ += isXor || isPrecise ? ")" : ""; break;
      case '0': result_ += isXor || isPrecise ? "sk_known(0.0)" : "0.0"; break;
      case 'f': result_ += isXor || isPrecise ? "sk_exact_" : ""; break;
      case '!': result_ += isXor ? "sk_not" : "!"; break;
      case '~': result_ += isXor ? "sk_not" : "not"; break;
      case 'q': result_ += isXor || isPrecise ? "sk_exact_fraction(" : ""; break;
      case 'Q': return fraction(body, at + 1);
      case 'm': result_ += isXor || isPrecise ? "sk_exact_product(" : ""; break;
      case '*': result_ += isXor || isPrecise ? ", " : " * "; break;
      case '#': result_ += isXor || isPrecise ? ")" : ""; break;
      default: assert(false && "no such mark");
    }
    isBracketed_ = false;
    return at + 1;
  }

  /// The end of a fraction, and its bits.
  std::size_t fraction(std::string_view body, std::size_t at) {
    const std::size_t end = body.find(first, at);
    int bits = 0;
    std::from_chars(body.data() + at, body.data() + end, bits);
    const int scale = (1 << bits) - 1;
    result_ += barrier_ == Barrier::None ? fmt::format(" / {}.0", scale)
                                         : fmt::format(", {}, {})", 1.0F / static_cast<float>(scale + 1),
                                                       1.0F / static_cast<float>(scale));
    return end + 1;
  }

  /// "x += y", or "x = sk_keep(x + y)".
  void compoundPart() {
    Place& place = places_.back();
    if (place.text.empty()) {
      place.text = result_.substr(place.start);
      result_ += barrier_ == Barrier::Xor ? fmt::format(" = sk_keep({} ", place.text) : std::string(" ");
    } else {
      result_ += barrier_ == Barrier::Xor ? " " : "= ";
    }
  }

  struct Place {
    std::size_t start;
    std::string text = {};
  };

  Barrier barrier_;
  std::string result_;
  bool isBracketed_ = false;
  std::vector<bool> brackets_;
  std::vector<Place> places_;
};

constexpr std::array<std::string_view, 4> vectorTypes = {"float", "vec2", "vec3", "vec4"};

/// No compiler can know that the negated comparison is what is computed.
constexpr std::string_view negations =
    "bool sk_not(bool c) { return c == (sk_zero != 0u); }\n"
    "bvec2 sk_not(bvec2 c) { return equal(c, bvec2(sk_zero != 0u)); }\n"
    "bvec3 sk_not(bvec3 c) { return equal(c, bvec3(sk_zero != 0u)); }\n"
    "bvec4 sk_not(bvec4 c) { return equal(c, bvec4(sk_zero != 0u)); }\n";

/// The sum of the components of `p`, from the first on.
std::string sumOf(int width) {
  std::string text = "p.x";
  for (int c = 1; c < width; ++c) text = fmt::format("sk_keep({} + p.{})", text, "xyzw"[c]);
  return text;
}

/// What GLSL's functions of vectors compute, in the order in which native code does (compiler/native/intrinsic_functions.cpp). `$T` is
/// the type, `$S` the sum of the products.
struct Geometry {
  std::string_view name, text;
};
constexpr std::array<Geometry, 4> geometry = {{
    {"dot",
     "float sk_exact_dot($T a, $T b) {\n"
     "  sk_precise $T p = sk_keep(a * b);\n"
     "  sk_precise float s = $S;\n"
     "  return s;\n"
     "}\n"},
    {"reflect",
     "$T sk_exact_reflect($T i, $T n) {\n"
     "  sk_precise $T p = sk_keep(n * (2.0 * sk_exact_dot(n, i)));\n"
     "  sk_precise $T r = sk_keep(i - p);\n"
     "  return r;\n"
     "}\n"},
    {"refract",
     "$T sk_exact_refract($T i, $T n, float eta) {\n"
     "  float d = sk_exact_dot(n, i);\n"
     "  sk_precise float s = sk_keep(1.0 - sk_keep(d * d));\n"
     "  sk_precise float t = sk_keep(sk_keep(eta * eta) * s);\n"
     "  sk_precise float k = sk_keep(1.0 - t);\n"
     "  sk_precise float u = sk_keep(sk_keep(eta * d) + sqrt(k));\n"
     "  sk_precise $T r = sk_keep(sk_keep(i * eta) - sk_keep(n * u));\n"
     "  return k < 0.0 ? $T(0.0) : r;\n"
     "}\n"},
    {"faceforward",
     "$T sk_exact_faceforward($T n, $T i, $T reference) {\n"
     "  return sk_exact_dot(reference, i) < 0.0 ? n : -n;\n"
     "}\n"},
}};

constexpr std::string_view exactCross =
    "vec3 sk_exact_cross(vec3 a, vec3 b) {\n"
    "  sk_precise vec3 r = sk_keep(sk_keep(a.yzx * b.zxy) - sk_keep(b.yzx * a.zxy));\n"
    "  return r;\n"
    "}\n";

/// Products of matrices of one width. Rows are GLSL's columns, so that factors change order: the second one is on the left.
std::string productDefinitions(int width) {
  const std::string vector(vectorTypes[static_cast<std::size_t>(width - 1)]),
      matrix = fmt::format("mat{}", width);
  std::string rows, ofRows;
  for (int row = 0; row < width; ++row) {
    std::string sum = fmt::format("sk_keep(b[0] * a[{}].x)", row);
    for (int c = 1; c < width; ++c)
      sum = fmt::format("sk_keep({} + sk_keep(b[{}] * a[{}].{}))", sum, c, row, "xyzw"[c]);
    rows += fmt::format("  sk_precise {} r{} = {};\n", vector, row, sum);
    ofRows += fmt::format("{}r{}", row == 0 ? "" : ", ", row);
  }
  const std::string product =
      fmt::format("{0} sk_exact_product({0} b, {0} a) {{\n{1}  return {0}({2});\n}}\n", matrix, rows, ofRows);
  std::string sums;
  for (int row = 0; row < width; ++row)
    sums += fmt::format("{}sk_exact_dot(a[{}], v)", row == 0 ? "" : ", ", row);
  return product +
         fmt::format("{0} sk_exact_product({0} v, {1} a) {{ return {0}({2}); }}\n", vector, matrix, sums);
}

/// The functions that the text calls, for all widths.
std::string geometryDefinitions(std::string_view text) {
  const auto calls = [&](std::string_view name) {
    return text.find(fmt::format("sk_exact_{}(", name)) != std::string_view::npos;
  };
  std::string definitions;
  bool isNeeded = calls("product");  // by functions below
  for (const Geometry& one : geometry) isNeeded = isNeeded || calls(one.name);
  for (const Geometry& one : geometry) {
    if (!calls(one.name) && !(isNeeded && one.name == "dot")) continue;
    for (int width = 1; width <= 4; ++width) {
      std::string definition(one.text);
      const auto replace = [&](std::string_view what, const std::string& by) {
        for (std::size_t at; (at = definition.find(what)) != std::string::npos;)
          definition.replace(at, 2, by);
      };
      replace("$T", std::string(vectorTypes[static_cast<std::size_t>(width - 1)]));
      replace("$S", width == 1 ? "p" : sumOf(width));
      definitions += definition;
    }
  }
  for (int width = 2; width <= 4 && calls("product"); ++width) definitions += productDefinitions(width);
  return definitions + std::string(calls("cross") ? exactCross : "");
}

}  // namespace

Barrier barrierOfBodies(const Profile& profile) {
  return profile.asWritten ? profile.barrier : Barrier::None;
}

std::string bodyText(const Profile& profile, std::string_view body) {
  return Resolver(barrierOfBodies(profile)).text(body);
}

std::string unmarked(std::string_view body) { return Resolver(Barrier::None).text(body); }

bool guardsOperations(const Profile& profile, std::string_view text) {
  const auto has = [&](std::string_view what) { return text.find(what) != std::string_view::npos; };
  if (barrierOfBodies(profile) == Barrier::None) return false;
  return has("sk_exact") || has("sk_known(") || has("sk_not(") ||
         has(barrierOfBodies(profile) == Barrier::Xor ? "sk_keep(" : "precise ");
}

// n / (2^b - 1) is t + t / (2^b - 1), where t is n / 2^b. Of every integer of 7, 8, 15 and 16 bits, the rounded sum of t and its product
// with the rounded reciprocal is the quotient rounded to nearest, with and without contraction.
std::string fractionDefinitions(std::string_view text) {
  std::string definitions;
  if (text.find("sk_exact_fraction(") == std::string_view::npos) return definitions;
  for (const std::string_view type : vectorTypes) {
    definitions += fmt::format(
        "{0} sk_exact_fraction({0} n, float unit, float inverse) {{\n"
        "  sk_precise {0} t = n * unit;\n"
        "  sk_precise {0} q = sk_keep(t + sk_keep(t * inverse));\n"
        "  return q;\n"
        "}}\n",
        type);
  }
  return definitions;
}

std::string bodyDefinitions(const Profile& profile, std::string_view text) {
  std::string definitions;
  if (barrierOfBodies(profile) == Barrier::Precise) {
    if (text.find("sk_known(") != std::string_view::npos) definitions += library::knownValues;
    for (const Kept& variable : kept) {
      if (text.find(fmt::format("({} =", variable.name)) != std::string_view::npos)
        definitions += fmt::format("precise {} {};\n", variable.type, variable.name);
    }
  }
  if (text.find("sk_not(") != std::string_view::npos) definitions += negations;
  if (text.find("sk_exact_") != std::string_view::npos) definitions += geometryDefinitions(text);
  return definitions;
}

std::string_view exactExtensions(const Profile& profile) {
  if (profile.barrier != Barrier::Precise) return "";
  if (profile.es) {
    return "#ifdef GL_EXT_gpu_shader5\n#extension GL_EXT_gpu_shader5 : require\n#else\n"
           "#extension GL_OES_gpu_shader5 : require\n#endif\n";
  }
  const bool hasPrecise = profile.stage == Stage::Compute;  // GLSL 4.30
  return hasPrecise ? "" : "#extension GL_ARB_gpu_shader5 : require\n";
}

std::string_view exactDefinitions(Barrier barrier) {
  switch (barrier) {
    case Barrier::None: return library::withoutBarrier;
    case Barrier::Xor: return library::xorBarrier;
    case Barrier::Precise: return library::preciseBarrier;
  }
  return {};
}

}  // namespace sk::assemble
