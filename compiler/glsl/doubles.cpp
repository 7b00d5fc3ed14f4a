// SPDX-License-Identifier: MIT
#include "glsl/doubles.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "glsl/float_intrinsics.hpp"
#include "glsl/type_names.hpp"
#include "ir/operators.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using Texts = std::vector<std::string>;

constexpr std::string_view letters = "xyzw";

std::string nameOf(Type type) { return glslSpelling(type.scalar, type.width); }
std::string doubleName(std::size_t width) { return glslSpelling(Scalar::Double, static_cast<int>(width)); }

std::string call(std::string_view function, const Texts& arguments) {
  return fmt::format("{}({})", function, join(arguments, ", "));
}

/// "sk_double3 a, sk_double b".
std::string parameterList(const std::vector<Type>& types) {
  Texts list;
  for (std::size_t i = 0; i < types.size(); ++i)
    list.push_back(fmt::format("{} {}", nameOf(types[i]), "abc"[i]));
  return join(list, ", ");
}

/// Defines `function` for vectors by calls for each component.
void defineByComponent(Polyfills& polyfills, std::string_view function, Type result,
                       const std::vector<Type>& types) {
  const auto widest = std::ranges::max_element(types, {}, [](Type type) { return type.width; });
  if (widest->width == 1) return;
  Texts components;
  for (std::size_t c = 0; c < widest->width; ++c) {
    Texts arguments;
    for (std::size_t i = 0; i < types.size(); ++i) {
      arguments.push_back(types[i].isVector() ? fmt::format("{}.{}", "abc"[i], letters[c])
                                              : std::string(1, "abc"[i]));
    }
    components.push_back(call(function, arguments));
  }
  polyfills.add(wrapLine(fmt::format("{} {}({}) {{ return {}; }}", nameOf(result), function,
                                     parameterList(types), call(nameOf(result), components))) +
                "\n");
}

/// Defines a row's function for the component types of these arguments.
void defineScalar(Polyfills& polyfills, std::string_view function, std::string_view body, Type result,
                  const std::vector<Type>& types) {
  if (body.empty()) return;
  std::vector<Type> components;
  for (const Type type : types) components.push_back(type.component());
  polyfills.add(wrapLine(fmt::format("{} {}({}) {{ {} }}", nameOf(result.component()), function,
                                     parameterList(components), body)) +
                "\n");
}

struct Row {
  Intrinsic intrinsic;
  std::string_view function, body;
};

constexpr Row rows[] = {
#define SKC_DOUBLE_FUNCTION(Name, function, body) {Intrinsic::Name, function, body},
#include "glsl/double_functions.def"
#undef SKC_DOUBLE_FUNCTION
};

/// Calls an intrinsic of double_functions.def.
std::string byComponent(Polyfills& polyfills, Intrinsic intrinsic, const std::vector<Type>& types,
                        const Texts& texts) {
  const auto found = std::ranges::find(rows, intrinsic, &Row::intrinsic);
  assert(found != std::end(rows) && "every intrinsic that takes doubles has a row or a case");
  std::vector<Type> components;
  for (const Type type : types) components.push_back(type.component());
  const bool isVector = std::ranges::any_of(types, [](Type type) { return type.isVector(); });
  // comparisons of scalars are no overload of the intrinsics; their result is bool
  const Type result = resultType(intrinsic, types).value_or(Type::of(Scalar::Bool));
  defineScalar(polyfills, found->function, found->body, result, types);
  if (isVector) defineByComponent(polyfills, found->function, result, types);
  return call(found->function, texts);
}

/// The dot product.
std::string dot(Polyfills& polyfills, Type type) {
  std::string sum = "sk_mul(a.x, b.x)";
  for (std::size_t c = 1; c < type.width; ++c)
    sum = fmt::format("sk_add({0}, sk_mul(a.{1}, b.{1}))", sum, letters[c]);
  if (type.isScalar()) sum = "sk_mul(a, b)";
  polyfills.add(
      wrapLine(fmt::format("sk_double sk_dot({}) {{ return {}; }}", parameterList({type, type}), sum)) +
      "\n");
  return "sk_dot";
}

/// Defines what lengths and directions of vectors share: the magnitude of the largest component, the largest of finite
/// numbers and infinity; and division of a vector by a power of 2.
void defineForLengths(Polyfills& polyfills, Type type) {
  dot(polyfills, type);
  defineByComponent(polyfills, "sk_ldexp", type, {type, Type::of(Scalar::Int)});
  std::string text =
      fmt::format("sk_double sk_largest({} a) {{\n  sk_double m = sk_abs(a.x), n;\n", nameOf(type));
  for (std::size_t c = 1; c < type.width; ++c) {
    text += fmt::format("  n = sk_abs(a.{});\n  m = sk_choose(sk_less(m, n) || sk_isnan(m), n, m);\n",
                        letters[c]);
  }
  polyfills.add(text + "  return m;\n}\n");
}

std::string length(Polyfills& polyfills, Type type) {
  if (type.isScalar()) {
    polyfills.add("sk_double sk_length(sk_double a) { return sk_abs(a); }\n");
    return "sk_length";
  }
  defineForLengths(polyfills, type);
  polyfills.add(
      fmt::format("sk_double sk_length({0} a) {{\n"
                  "  sk_double m = sk_largest(a);\n"
                  "  if (sk_isinf(m)) return m;\n"
                  "  int e = sk_square_exponent(m);\n"
                  "  {0} b = sk_ldexp(a, -e);\n"
                  "  return sk_ldexp(sk_sqrt(sk_dot(b, b)), e);\n}}\n",
                  nameOf(type)));
  return "sk_length";
}

std::string distance(Polyfills& polyfills, Type type) {
  defineByComponent(polyfills, "sk_sub", type, {type, type});
  length(polyfills, type);
  polyfills.add(fmt::format("sk_double sk_distance({}) {{ return sk_length(sk_sub(a, b)); }}\n",
                            parameterList({type, type})));
  return "sk_distance";
}

/// A zero vector keeps its zeros.
std::string normalize(Polyfills& polyfills, Type type) {
  if (type.isScalar()) {
    polyfills.add(
        "sk_double sk_normalize(sk_double a) {\n"
        "  return sk_choose(sk_equal(a, sk_to_double(0.0)), a, sk_div(a, sk_abs(a)));\n}\n");
    return "sk_normalize";
  }
  defineForLengths(polyfills, type);
  defineByComponent(polyfills, "sk_div", type, {type, type.component()});
  polyfills.add(
      fmt::format("{0} sk_normalize({0} a) {{\n"
                  "  {0} b = sk_ldexp(a, -sk_square_exponent(sk_largest(a)));\n"
                  "  sk_double square = sk_dot(b, b);\n"
                  "  if (sk_equal(square, sk_to_double(0.0))) return a;\n"
                  "  return sk_div(b, sk_sqrt(square));\n}}\n",
                  nameOf(type)));
  return "sk_normalize";
}

std::string cross(Polyfills& polyfills) {
  const auto minor = [](char i, char j) {
    return fmt::format("sk_sub(sk_mul(a.{0}, b.{1}), sk_mul(a.{1}, b.{0}))", i, j);
  };
  polyfills.add(
      fmt::format("sk_double3 sk_cross(sk_double3 a, sk_double3 b) {{\n"
                  "  return sk_double3({},\n    {},\n    {});\n}}\n",
                  minor('y', 'z'), minor('z', 'x'), minor('x', 'y')));
  return "sk_cross";
}

std::string faceforward(Polyfills& polyfills, Type type) {
  dot(polyfills, type);
  defineByComponent(polyfills, "sk_neg", type, {type});
  polyfills.add(
      fmt::format("{} sk_faceforward({}) {{\n"
                  "  if (sk_less(sk_dot(c, b), sk_to_double(0.0))) return a;\n  return sk_neg(a);\n}}\n",
                  nameOf(type), parameterList({type, type, type})));
  return "sk_faceforward";
}

/// Defines the functions that reflect and refract share.
void defineForRays(Polyfills& polyfills, Type type) {
  dot(polyfills, type);
  defineByComponent(polyfills, "sk_sub", type, {type, type});
  defineByComponent(polyfills, "sk_mul", type, {type, type.component()});
}

std::string reflect(Polyfills& polyfills, Type type) {
  defineForRays(polyfills, type);
  polyfills.add(
      fmt::format("{} sk_reflect({}) {{\n"
                  "  sk_double d = sk_dot(b, a);\n"
                  "  return sk_sub(a, sk_mul(b, sk_add(d, d)));\n}}\n",
                  nameOf(type), parameterList({type, type})));
  return "sk_reflect";
}

std::string refract(Polyfills& polyfills, Type type) {
  defineForRays(polyfills, type);
  const std::string zero = doubleVector(polyfills, type, {type.component()}, {"sk_to_double(0.0)"});
  polyfills.add(
      fmt::format("{} sk_refract({}) {{\n"
                  "  sk_double d = sk_dot(b, a), one = sk_to_double(1.0);\n"
                  "  sk_double k = sk_sub(one, sk_mul(sk_mul(c, c), sk_sub(one, sk_mul(d, d))));\n"
                  "  if (sk_less(k, sk_to_double(0.0))) return {};\n"
                  "  return sk_sub(sk_mul(a, c), sk_mul(b, sk_add(sk_mul(c, d), sk_sqrt(k))));\n}}\n",
                  nameOf(type), parameterList({type, type, type.component()}), zero));
  return "sk_refract";
}

/// Calls a function that the assembler defines for one double.
std::string defined(Polyfills& polyfills, sk::program::Intrinsic intrinsic, const std::vector<Type>& types,
                    const Texts& texts) {
  const std::string function = polyfills.definedOfDouble(intrinsic);
  defineByComponent(polyfills, function, types[0], types);
  return call(function, texts);
}

std::string namesOf(const std::vector<std::uint8_t>& components) {
  std::string names;
  for (const std::uint8_t component : components) names += letters[component];
  return names;
}

}  // namespace

std::string doubleLiteral(const Literal& literal) {
  const double value = std::bit_cast<double>(std::uint64_t{literal.high} << 32 | literal.bits);
  const auto nearest = static_cast<float>(value);
  if ((std::isnormal(nearest) || literal.high == 0) && double{nearest} == value) {
    return fmt::format("sk_to_double({})", shortestFloat(nearest));
  }
  return fmt::format("/* {} */ sk_unpack(uvec2(0x{:08x}u, 0x{:08x}u))", shortestDouble(value), literal.bits,
                     literal.high);
}

std::string doubleNegated(Polyfills& polyfills, Type type, const std::string& operand) {
  defineByComponent(polyfills, "sk_neg", type, {type});
  return call("sk_neg", {operand});
}

std::string doubleBinary(Polyfills& polyfills, BinaryOp op, Type lhs, Type rhs, const std::string& a,
                         const std::string& b) {
  const std::string_view function = row(op).doubles;
  if (function.empty()) return byComponent(polyfills, row(op).vectors.value(), {lhs, rhs}, {a, b});
  defineByComponent(polyfills, function, lhs.isVector() ? lhs : rhs, {lhs, rhs});
  return call(function, {a, b});
}

std::string doubleConverted(Polyfills& polyfills, Type from, Type to, const std::string& operand) {
  if (to.isBool()) {
    const std::string zero = doubleVector(polyfills, from, {from.component()}, {"sk_to_double(0.0)"});
    return byComponent(polyfills, Intrinsic::NotEqualTo, {from, from}, {operand, zero});
  }
  if (from.isBool()) {
    return doubleConverted(polyfills, from.withScalar(Scalar::Int), to,
                           call(glslSpelling(Scalar::Int, from.width), {operand}));
  }
  if (to.scalar == Scalar::Half) {
    defineByComponent(polyfills, "sk_to_odd", to, {from});
    return call(polyfills.quantize(to), {call("sk_to_odd", {operand})});
  }
  const std::string function = "sk_to_" + glslSpelling(to.scalar, 1).substr(to.isDouble() ? 3 : 0);
  defineByComponent(polyfills, function, to, {from});
  return call(function, {operand});
}

std::string doubleVector(Polyfills& polyfills, Type type, const std::vector<Type>& parts,
                         const Texts& texts) {
  if (parts.size() == 1 && parts[0] == type) return texts[0];
  const bool areScalars = std::ranges::all_of(parts, [](Type part) { return part.isScalar(); });
  if (areScalars && parts.size() == type.width) return call(nameOf(type), texts);
  const std::string function = "sk_make_" + nameOf(type).substr(3);
  Texts parameters, components;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parameters.push_back(fmt::format("{} {}", nameOf(parts[i]), "abcd"[i]));
    for (std::size_t c = 0; c < parts[i].width; ++c) {
      components.push_back(parts[i].isScalar() ? std::string(1, "abcd"[i])
                                               : fmt::format("{}.{}", "abcd"[i], letters[c]));
    }
  }
  components.resize(type.width, components.front());  // broadcast a scalar
  polyfills.add(fmt::format("{} {}({}) {{ return {}; }}\n", nameOf(type), function, join(parameters, ", "),
                            call(nameOf(type), components)));
  return call(function, texts);
}

std::string doubleIntrinsic(Polyfills& polyfills, Intrinsic intrinsic, const std::vector<Type>& types,
                            const Texts& texts) {
  if (intrinsic == Intrinsic::Dot) return call(dot(polyfills, types[0]), texts);
  if (intrinsic == Intrinsic::Length) return call(length(polyfills, types[0]), texts);
  if (intrinsic == Intrinsic::Distance) return call(distance(polyfills, types[0]), texts);
  if (intrinsic == Intrinsic::Normalize) return call(normalize(polyfills, types[0]), texts);
  if (intrinsic == Intrinsic::Cross) return call(cross(polyfills), texts);
  if (intrinsic == Intrinsic::Faceforward) return call(faceforward(polyfills, types[0]), texts);
  if (intrinsic == Intrinsic::Reflect) return call(reflect(polyfills, types[0]), texts);
  if (intrinsic == Intrinsic::Refract) return call(refract(polyfills, types[0]), texts);
  if (const auto ours = definedOfDoubles(intrinsic)) return defined(polyfills, *ours, types, texts);
  return byComponent(polyfills, intrinsic, types, texts);
}

// ---- components -----------------------------------------------------------------------------------

std::string doubleSwizzle(Polyfills& polyfills, Type base, const std::vector<std::uint8_t>& components,
                          const std::string& vector) {
  const std::string names = namesOf(components), function = "sk_" + names;
  const std::string result = doubleName(components.size());
  Texts items;
  for (const char name : names) items.push_back(fmt::format("v.{}", name));
  polyfills.add(
      fmt::format("{} {}({} v) {{ return {}; }}\n", result, function, nameOf(base), call(result, items)));
  return call(function, {vector});
}

std::string doubleComponent(Polyfills& polyfills, Type base, const std::string& vector,
                            const std::string& index) {
  std::string choice = fmt::format("v.{}", letters[base.width - 1U]);
  for (int c = base.width - 2; c >= 0; --c)
    choice = fmt::format("sk_choose(i == {}, v.{}, {})", c, letters[static_cast<std::size_t>(c)], choice);
  polyfills.add(fmt::format("sk_double sk_component({} v, int i) {{ return {}; }}\n", nameOf(base), choice));
  return call("sk_component", {vector, index});
}

std::string doubleWith(Polyfills& polyfills, Type base, const std::vector<std::uint8_t>& components,
                       const std::string& vector, const std::string& value) {
  const std::string names = namesOf(components), function = "sk_with_" + names;
  std::string text =
      fmt::format("{0} {1}({0} v, {2} s) {{\n ", nameOf(base), function, doubleName(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += names.size() == 1 ? fmt::format(" v.{} = s;", names[i])
                              : fmt::format(" v.{} = s.{};", names[i], letters[i]);
  }
  polyfills.add(text + "\n  return v;\n}\n");
  return call(function, {vector, value});
}

std::string doubleWithComponent(Polyfills& polyfills, Type base, const std::string& vector,
                                const std::string& index, const std::string& value) {
  std::string text = fmt::format("{0} sk_with({0} v, int i, sk_double s) {{\n", nameOf(base));
  for (int c = 0; c < base.width; ++c)
    text += fmt::format("  if (i == {}) v.{} = s;\n", c, letters[static_cast<std::size_t>(c)]);
  polyfills.add(text + "  return v;\n}\n");
  return call("sk_with", {vector, index, value});
}

}  // namespace skc::emit
