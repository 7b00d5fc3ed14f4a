// SPDX-License-Identifier: MIT
#include "glsl/doubles.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "glsl/float_intrinsics.hpp"
#include "glsl/type_names.hpp"
#include "ir/build.hpp"
#include "ir/operators.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using Texts = std::vector<std::string>;
using Args = std::vector<ExprPtr>;

constexpr std::string_view letters = "xyzw";
constexpr Type doubleType = Type::of(Scalar::Double);

std::string nameOf(Type type) { return glslSpelling(type.scalar, type.width); }

std::vector<Type> typesOf(const Args& args) {
  std::vector<Type> types;
  for (const ExprPtr& arg : args) types.push_back(arg->type);
  return types;
}

std::string callText(std::string_view function, const Texts& arguments) {
  return fmt::format("{}({})", function, join(arguments, ", "));
}

/// "sk_double3 sk_cross(sk_double3 a, sk_double3 b)".
std::string head(Type result, std::string_view function, const std::vector<Type>& types) {
  return fmt::format("{} {}({})", nameOf(result), function, parameterList(types));
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

/// Adds the functions of vectors.
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
    const auto found = std::ranges::find(rows, intrinsic, &Row::intrinsic);
    assert(found != std::end(rows) && "every intrinsic that takes doubles has a row or a case");
    // comparisons of scalars are no overload of the intrinsics; their result is bool
    const Type result = resultType(intrinsic, types).value_or(Type::of(Scalar::Bool));
    std::vector<Type> components;
    for (const Type type : types) components.push_back(type.component());
    std::string text;
    if (!found->body.empty())
      text = wrapLine(fmt::format("{} {{ {} }}", head(result.component(), found->function, components),
                                  found->body)) +
             "\n";
    return polyfills_.addByComponent(found->function, result, types, {std::move(text)});
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
      sum = fmt::format("sk_add({0}, sk_mul(a.{1}, b.{1}))", sum, letters[c]);
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
                          letters[c]);
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
                           nameOf(type_)),
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
                           nameOf(type_)),
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
                           type_.isScalar() ? zero : callText(nameOf(type_), Texts(type_.width, zero))),
               {dot(), difference(), product()});
  }

  Polyfills& polyfills_;
  Type type_;
};

std::string namesOf(const std::vector<std::uint8_t>& components) {
  std::string names;
  for (const std::uint8_t component : components) names += letters[component];
  return names;
}

Type doubles(std::size_t width) { return Type::of(Scalar::Double, static_cast<int>(width)); }

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

ExprPtr doubleNegated(Polyfills& polyfills, ExprPtr operand) {
  const FunctionId function = polyfills.addByComponent("sk_neg", operand->type, {operand->type});
  return polyfills.call(function, exprs(std::move(operand)));
}

ExprPtr doubleBinary(Polyfills& polyfills, BinaryOp op, ExprPtr a, ExprPtr b) {
  const OperatorRow& entry = row(op);
  if (entry.doubles.empty())
    return doubleIntrinsic(polyfills, entry.vectors.value(), exprs(std::move(a), std::move(b)));
  const Type lhs = a->type, rhs = b->type;
  const FunctionId function = polyfills.addByComponent(entry.doubles, lhs.isVector() ? lhs : rhs, {lhs, rhs});
  return polyfills.call(function, exprs(std::move(a), std::move(b)));
}

ExprPtr doubleConverted(Polyfills& polyfills, Type to, ExprPtr operand) {
  const Type from = operand->type;
  if (to.isBool())
    return doubleIntrinsic(polyfills, Intrinsic::NotEqualTo, exprs(std::move(operand), literalOf(from, 0)));
  if (from.isBool()) return doubleConverted(polyfills, to, convert(Scalar::Int, std::move(operand)));
  if (to.scalar == Scalar::Half) {
    const FunctionId toOdd = polyfills.addByComponent("sk_to_odd", to.arithmeticType(), {from});
    return polyfills.call(polyfills.quantize(to), exprs(polyfills.call(toOdd, exprs(std::move(operand)))));
  }
  const std::string function = "sk_to_" + glslSpelling(to.scalar, 1).substr(to.isDouble() ? 3 : 0);
  return polyfills.call(polyfills.addByComponent(function, to, {from}), exprs(std::move(operand)));
}

ExprPtr doubleVector(Polyfills& polyfills, Type type, Args parts) {
  if (parts.size() == 1 && parts[0]->type == type) return std::move(parts[0]);
  const bool areScalars =
      std::ranges::all_of(parts, [](const ExprPtr& part) { return part->type.isScalar(); });
  if (areScalars && parts.size() == type.width) return construct(type, std::move(parts));
  const std::string function = "sk_make_" + nameOf(type).substr(3);
  Texts parameters, components;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parameters.push_back(fmt::format("{} {}", nameOf(parts[i]->type), "abcd"[i]));
    for (std::size_t c = 0; c < parts[i]->type.width; ++c) {
      components.push_back(parts[i]->type.isScalar() ? std::string(1, "abcd"[i])
                                                     : fmt::format("{}.{}", "abcd"[i], letters[c]));
    }
  }
  components.resize(type.width, components.front());  // broadcast a scalar
  const FunctionId id =
      polyfills.add(function, type, typesOf(parts),
                    {fmt::format("{} {}({}) {{ return {}; }}\n", nameOf(type), function,
                                 join(parameters, ", "), callText(nameOf(type), components))});
  return polyfills.call(id, std::move(parts));
}

ExprPtr doubleIntrinsic(Polyfills& polyfills, Intrinsic intrinsic, Args args) {
  const std::vector<Type> types = typesOf(args);
  return polyfills.call(DoubleFunctions(polyfills, types[0]).intrinsic(intrinsic, types), std::move(args));
}

// ---- components -----------------------------------------------------------------------------------

ExprPtr doubleSwizzle(Polyfills& polyfills, const std::vector<std::uint8_t>& components, ExprPtr vector) {
  const std::string function = "sk_" + namesOf(components);
  const Type base = vector->type, result = doubles(components.size());
  Texts items;
  for (const std::uint8_t component : components) items.push_back(fmt::format("v.{}", letters[component]));
  const FunctionId id = polyfills.add(function, result, {base},
                                      {fmt::format("{} {}({} v) {{ return {}; }}\n", nameOf(result), function,
                                                   nameOf(base), callText(nameOf(result), items))});
  return polyfills.call(id, exprs(std::move(vector)));
}

ExprPtr doubleComponent(Polyfills& polyfills, ExprPtr vector, ExprPtr index) {
  const Type base = vector->type;
  std::string choice = fmt::format("v.{}", letters[base.width - 1U]);
  for (int c = base.width - 2; c >= 0; --c)
    choice = fmt::format("sk_choose(i == {}, v.{}, {})", c, letters[static_cast<std::size_t>(c)], choice);
  const FunctionId id = polyfills.add(
      "sk_component", doubleType, {base, Type::of(Scalar::Int)},
      {fmt::format("sk_double sk_component({} v, int i) {{ return {}; }}\n", nameOf(base), choice)});
  return polyfills.call(id, exprs(std::move(vector), std::move(index)));
}

ExprPtr doubleWith(Polyfills& polyfills, const std::vector<std::uint8_t>& components, ExprPtr vector,
                   ExprPtr value) {
  const std::string names = namesOf(components), function = "sk_with_" + names;
  const Type base = vector->type, part = doubles(names.size());
  std::string text = fmt::format("{0} {1}({0} v, {2} s) {{\n ", nameOf(base), function, nameOf(part));
  for (std::size_t i = 0; i < names.size(); ++i)
    text += names.size() == 1 ? fmt::format(" v.{} = s;", names[i])
                              : fmt::format(" v.{} = s.{};", names[i], letters[i]);
  const FunctionId id = polyfills.add(function, base, {base, part}, {text + "\n  return v;\n}\n"});
  return polyfills.call(id, exprs(std::move(vector), std::move(value)));
}

ExprPtr doubleWithComponent(Polyfills& polyfills, ExprPtr vector, ExprPtr index, ExprPtr value) {
  const Type base = vector->type;
  std::string text = fmt::format("{0} sk_with({0} v, int i, sk_double s) {{\n", nameOf(base));
  for (int c = 0; c < base.width; ++c)
    text += fmt::format("  if (i == {}) v.{} = s;\n", c, letters[static_cast<std::size_t>(c)]);
  const FunctionId id =
      polyfills.add("sk_with", base, {base, Type::of(Scalar::Int), doubleType}, {text + "  return v;\n}\n"});
  return polyfills.call(id, exprs(std::move(vector), std::move(index), std::move(value)));
}

}  // namespace skc::emit
