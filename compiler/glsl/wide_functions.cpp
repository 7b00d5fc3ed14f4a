// SPDX-License-Identifier: MIT
#include "glsl/wide_functions.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "glsl/float_intrinsics.hpp"
#include "glsl/type_names.hpp"
#include "ir/intrinsics.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

constexpr Type doubleType = Type::of(Scalar::Double);

/// "sk_double3 sk_cross(sk_double3 a, sk_double3 b)".
std::string head(Type result, std::string_view function, const std::vector<Type>& types) {
  return fmt::format("{} {}({})", glslSpelling(result), function, parameterList(types));
}

struct Row {
  Intrinsic intrinsic;
  std::string_view function, body;
};

constexpr Row doubleRows[] = {
#define SKC_WIDE_FUNCTION(Name, function, body) {Intrinsic::Name, function, body},
#include "glsl/double_functions.def"
#undef SKC_WIDE_FUNCTION
};

constexpr Row longRows[] = {
#define SKC_WIDE_FUNCTION(Name, function, body) {Intrinsic::Name, function, body},
#include "glsl/long_functions.def"
#undef SKC_WIDE_FUNCTION
};

/// The function of a row, or of the assembler, that works by component.
FunctionId byComponent(Polyfills& polyfills, std::span<const Row> rows, Intrinsic intrinsic,
                       const std::vector<Type>& types) {
  const auto found = std::ranges::find(rows, intrinsic, &Row::intrinsic);
  assert(found != rows.end() && "every intrinsic that takes wide values has a row or a case");
  // comparisons of scalars are no overload of the intrinsics; their result is bool
  const Type result = resultType(intrinsic, types).value_or(Type::of(Scalar::Bool));
  std::vector<Type> components;
  for (const Type type : types) components.push_back(type.component());
  std::string text;
  if (!found->body.empty())
    text = wrapLine(fmt::format("{} {{ {} }}", head(result.component(), found->function, components),
                                found->body)) +
           "\n";
  return polyfills.addByComponent(found->function, result, types, {std::move(text)});
}

/// Adds the functions of doubles.
class DoubleFunctions {
 public:
  /// `type`: of the first argument.
  DoubleFunctions(Polyfills& polyfills, Type type) : polyfills_(polyfills), type_(type) {}

  FunctionId intrinsic(Intrinsic intrinsic, const std::vector<Type>& types) {
    switch (intrinsic) {
      case Intrinsic::Dot: return dot();
      case Intrinsic::Length: return length();
      case Intrinsic::Distance: return distance();
      case Intrinsic::Normalize: return normalize();
      case Intrinsic::Cross: return cross();
      case Intrinsic::Faceforward: return faceforward();
      case Intrinsic::Reflect: return reflect();
      case Intrinsic::Refract: return refract();
      default: break;
    }
    if (const auto assembled = definedOfDoubles(intrinsic))
      return polyfills_.addByComponent(functionName(*assembled), type_, types,
                                       {.text = {}, .ofDouble = assembled});
    return byComponent(polyfills_, doubleRows, intrinsic, types);
  }

 private:
  FunctionId add(std::string_view function, Type result, const std::vector<Type>& types,
                 std::string_view body, std::vector<FunctionId> callees) {
    const bool isLine = body.front() == ' ';
    const std::string text = fmt::format("{} {{{}}}", head(result, function, types), body);
    return polyfills_.add(function, result, types,
                          {.text = (isLine ? wrapLine(text) : text) + "\n", .callees = std::move(callees)});
  }

  FunctionId dot() {
    std::string sum = type_.isScalar() ? "sk_mul(a, b)" : "sk_mul(a.x, b.x)";
    for (std::size_t c = 1; c < type_.width; ++c)
      sum = fmt::format("sk_add({0}, sk_mul(a.{1}, b.{1}))", sum, "xyzw"[c]);
    return add("sk_dot", doubleType, {type_, type_}, fmt::format(" return {}; ", sum), {});
  }

  FunctionId scaled() { return polyfills_.addByComponent("sk_ldexp", type_, {type_, Type::of(Scalar::Int)}); }
  FunctionId difference() { return polyfills_.addByComponent("sk_sub", type_, {type_, type_}); }
  FunctionId product() { return polyfills_.addByComponent("sk_mul", type_, {type_, doubleType}); }
  FunctionId quotient() { return polyfills_.addByComponent("sk_div", type_, {type_, doubleType}); }
  FunctionId negated() { return polyfills_.addByComponent("sk_neg", type_, {type_}); }

  /// The magnitude of the largest component, the largest of finite numbers and infinity.
  FunctionId largest() {
    std::string body = "\n  sk_double m = sk_abs(a.x), n;\n";
    for (std::size_t c = 1; c < type_.width; ++c) {
      body += fmt::format("  n = sk_abs(a.{});\n  m = sk_choose(sk_less(m, n) || sk_isnan(m), n, m);\n",
                          "xyzw"[c]);
    }
    return add("sk_largest", doubleType, {type_}, body + "  return m;\n", {});
  }

  FunctionId length() {
    if (type_.isScalar()) return add("sk_length", doubleType, {type_}, " return sk_abs(a); ", {});
    return add("sk_length", doubleType, {type_},
               fmt::format("\n  sk_double m = sk_largest(a);\n"
                           "  if (sk_isinf(m)) return m;\n"
                           "  int e = sk_square_exponent(m);\n"
                           "  {} b = sk_ldexp(a, -e);\n"
                           "  return sk_ldexp(sk_sqrt(sk_dot(b, b)), e);\n",
                           glslSpelling(type_)),
               {dot(), scaled(), largest()});
  }

  FunctionId distance() {
    return add("sk_distance", doubleType, {type_, type_}, " return sk_length(sk_sub(a, b)); ",
               {difference(), length()});
  }

  /// A zero vector keeps its zeros.
  FunctionId normalize() {
    if (type_.isScalar()) {
      return add("sk_normalize", type_, {type_},
                 "\n  return sk_choose(sk_equal(a, sk_to_double(0.0)), a, sk_div(a, sk_abs(a)));\n", {});
    }
    return add("sk_normalize", type_, {type_},
               fmt::format("\n  {} b = sk_ldexp(a, -sk_square_exponent(sk_largest(a)));\n"
                           "  sk_double square = sk_dot(b, b);\n"
                           "  if (sk_equal(square, sk_to_double(0.0))) return a;\n"
                           "  return sk_div(b, sk_sqrt(square));\n",
                           glslSpelling(type_)),
               {dot(), scaled(), largest(), quotient()});
  }

  FunctionId cross() {
    const auto minor = [](char i, char j) {
      return fmt::format("sk_sub(sk_mul(a.{0}, b.{1}), sk_mul(a.{1}, b.{0}))", i, j);
    };
    return add("sk_cross", type_, {type_, type_},
               fmt::format("\n  return sk_double3({},\n    {},\n    {});\n", minor('y', 'z'), minor('z', 'x'),
                           minor('x', 'y')),
               {});
  }

  FunctionId faceforward() {
    return add("sk_faceforward", type_, {type_, type_, type_},
               "\n  if (sk_less(sk_dot(c, b), sk_to_double(0.0))) return a;\n  return sk_neg(a);\n",
               {dot(), negated()});
  }

  FunctionId reflect() {
    return add("sk_reflect", type_, {type_, type_},
               "\n  sk_double d = sk_dot(b, a);\n  return sk_sub(a, sk_mul(b, sk_add(d, d)));\n",
               {dot(), difference(), product()});
  }

  FunctionId refract() {
    const std::string zero = "sk_to_double(0.0)";
    return add("sk_refract", type_, {type_, type_, doubleType},
               fmt::format("\n  sk_double d = sk_dot(b, a), one = sk_to_double(1.0);\n"
                           "  sk_double k = sk_sub(one, sk_mul(sk_mul(c, c), sk_sub(one, sk_mul(d, d))));\n"
                           "  if (sk_less(k, sk_to_double(0.0))) return {};\n"
                           "  return sk_sub(sk_mul(a, c), sk_mul(b, sk_add(sk_mul(c, d), sk_sqrt(k))));\n",
                           type_.isScalar() ? zero
                                            : fmt::format("{}({})", glslSpelling(type_),
                                                          join(std::vector(type_.width, zero), ", "))),
               {dot(), difference(), product()});
  }

  Polyfills& polyfills_;
  Type type_;
};

}  // namespace

FunctionId wideFunction(Polyfills& polyfills, Intrinsic intrinsic, const std::vector<Type>& types) {
  if (types[0].isLong()) return byComponent(polyfills, longRows, intrinsic, types);
  return DoubleFunctions(polyfills, types[0]).intrinsic(intrinsic, types);
}

}  // namespace skc::emit
