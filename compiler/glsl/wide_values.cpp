// SPDX-License-Identifier: MIT
#include "glsl/wide_values.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "glsl/type_names.hpp"
#include "glsl/wide_functions.hpp"
#include "ir/build.hpp"
#include "ir/operators.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;
using Texts = std::vector<std::string>;
using Args = std::vector<ExprPtr>;

constexpr std::string_view letters = "xyzw";

std::vector<Type> typesOf(const Args& args) {
  std::vector<Type> types;
  for (const ExprPtr& arg : args) types.push_back(arg->type);
  return types;
}

std::string callText(std::string_view function, const Texts& arguments) {
  return fmt::format("{}({})", function, join(arguments, ", "));
}

std::string namesOf(const std::vector<std::uint8_t>& components) {
  std::string names;
  for (const std::uint8_t component : components) names += letters[component];
  return names;
}

/// A vector with the components of `base`, or one of them.
Type ofWidth(Type base, std::size_t width) { return Type::of(base.scalar, static_cast<int>(width)); }

std::string doubleText(const Literal& literal) {
  const auto value = std::bit_cast<double>(literal.wide());
  const auto nearest = static_cast<float>(value);
  if ((std::isnormal(nearest) || literal.high == 0) && double{nearest} == value) {
    return fmt::format("sk_to_double({})", shortestFloat(nearest));
  }
  return fmt::format("/* {} */ sk_unpack(uvec2(0x{:08x}u, 0x{:08x}u))", shortestDouble(value), literal.bits,
                     literal.high);
}

}  // namespace

std::string wideText(Scalar scalar, const Literal& literal) {
  if (scalar == Scalar::Double) return doubleText(literal);
  return fmt::format("{}(uvec2({}u, {}u))", glslSpelling(scalar, 1), literal.bits, literal.high);
}

ExprPtr wideUnary(Polyfills& polyfills, UnaryOp op, ExprPtr operand) {
  const std::string_view name = op == UnaryOp::Negate ? "sk_neg" : "sk_inverse";
  const FunctionId function = polyfills.addByComponent(name, operand->type, {operand->type});
  return polyfills.call(function, exprs(std::move(operand)));
}

namespace {

/// The divisor, if it is a literal that the assembler divides by without a loop, which takes drivers long to compile.
std::optional<std::uint32_t> smallDivisor(BinaryOp op, const Expr& b) {
  const auto* divisor = std::get_if<Literal>(&b.node);
  const bool divides = op == BinaryOp::Div || op == BinaryOp::Rem;
  if (!divides || divisor == nullptr || !b.type.isLong()) return std::nullopt;
  const std::uint64_t value = divisor->wide();
  return value > 0 && value < 1U << 24U ? std::optional(divisor->bits) : std::nullopt;
}

}  // namespace

ExprPtr wideBinary(Polyfills& polyfills, BinaryOp op, ExprPtr a, ExprPtr b) {
  if (const auto divisor = smallDivisor(op, *b)) {
    const std::string_view name = op == BinaryOp::Div ? "sk_div_by" : "sk_rem_by";
    const FunctionId function = polyfills.addByComponent(name, a->type, {a->type, Type::of(Scalar::Uint)});
    return polyfills.call(function, exprs(std::move(a), literal(*divisor)));
  }
  const OperatorRow& entry = row(op);
  if (entry.wide.empty())
    return wideIntrinsic(polyfills, entry.vectors.value(), exprs(std::move(a), std::move(b)));
  const Type lhs = a->type, rhs = b->type;
  const FunctionId function = polyfills.addByComponent(entry.wide, lhs.isVector() ? lhs : rhs, {lhs, rhs});
  return polyfills.call(function, exprs(std::move(a), std::move(b)));
}

ExprPtr wideConverted(Polyfills& polyfills, Type to, ExprPtr operand) {
  const Type from = operand->type;
  if (to.isBool())
    return wideIntrinsic(polyfills, Intrinsic::NotEqualTo, exprs(std::move(operand), literalOf(from, 0)));
  if (from.isBool()) return wideConverted(polyfills, to, convert(Scalar::Int, std::move(operand)));
  if (to.scalar == Scalar::Half && from.isDouble()) {
    const FunctionId toOdd = polyfills.addByComponent("sk_to_odd", to.arithmeticType(), {from});
    return polyfills.call(polyfills.quantize(to), exprs(polyfills.call(toOdd, exprs(std::move(operand)))));
  }
  const std::string function = "sk_to_" + glslSpelling(to.scalar, 1).substr(to.is64Bit() ? 3 : 0);
  return polyfills.call(polyfills.addByComponent(function, to, {from}), exprs(std::move(operand)));
}

ExprPtr wideVector(Polyfills& polyfills, Type type, Args parts) {
  if (parts.size() == 1 && parts[0]->type == type) return std::move(parts[0]);
  const bool areScalars =
      std::ranges::all_of(parts, [](const ExprPtr& part) { return part->type.isScalar(); });
  if (areScalars && parts.size() == type.width) return construct(type, std::move(parts));
  const std::string function = "sk_make_" + glslSpelling(type).substr(3);
  Texts parameters, components;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parameters.push_back(fmt::format("{} {}", glslSpelling(parts[i]->type), "abcd"[i]));
    for (std::size_t c = 0; c < parts[i]->type.width; ++c) {
      components.push_back(parts[i]->type.isScalar() ? std::string(1, "abcd"[i])
                                                     : fmt::format("{}.{}", "abcd"[i], letters[c]));
    }
  }
  components.resize(type.width, components.front());  // broadcast a scalar
  const FunctionId id =
      polyfills.add(function, type, typesOf(parts),
                    {fmt::format("{} {}({}) {{ return {}; }}\n", glslSpelling(type), function,
                                 join(parameters, ", "), callText(glslSpelling(type), components))});
  return polyfills.call(id, std::move(parts));
}

ExprPtr wideIntrinsic(Polyfills& polyfills, Intrinsic intrinsic, Args args) {
  const std::vector<Type> types = typesOf(args);
  return polyfills.call(wideFunction(polyfills, intrinsic, types), std::move(args));
}

// ---- components -----------------------------------------------------------------------------------

ExprPtr wideSwizzle(Polyfills& polyfills, const std::vector<std::uint8_t>& components, ExprPtr vector) {
  const std::string function = "sk_" + namesOf(components);
  const Type base = vector->type, result = ofWidth(base, components.size());
  Texts items;
  for (const std::uint8_t component : components) items.push_back(fmt::format("v.{}", letters[component]));
  const FunctionId id =
      polyfills.add(function, result, {base},
                    {fmt::format("{} {}({} v) {{ return {}; }}\n", glslSpelling(result), function,
                                 glslSpelling(base), callText(glslSpelling(result), items))});
  return polyfills.call(id, exprs(std::move(vector)));
}

ExprPtr wideComponent(Polyfills& polyfills, ExprPtr vector, ExprPtr index) {
  const Type base = vector->type;
  std::string choice = fmt::format("v.{}", letters[base.width - 1U]);
  for (int c = base.width - 2; c >= 0; --c)
    choice = fmt::format("sk_choose(i == {}, v.{}, {})", c, letters[static_cast<std::size_t>(c)], choice);
  const FunctionId id =
      polyfills.add("sk_component", base.component(), {base, Type::of(Scalar::Int)},
                    {fmt::format("{} sk_component({} v, int i) {{ return {}; }}\n",
                                 glslSpelling(base.component()), glslSpelling(base), choice)});
  return polyfills.call(id, exprs(std::move(vector), std::move(index)));
}

ExprPtr wideWith(Polyfills& polyfills, const std::vector<std::uint8_t>& components, ExprPtr vector,
                 ExprPtr value) {
  const std::string names = namesOf(components), function = "sk_with_" + names;
  const Type base = vector->type, part = ofWidth(base, names.size());
  std::string text =
      fmt::format("{0} {1}({0} v, {2} s) {{\n ", glslSpelling(base), function, glslSpelling(part));
  for (std::size_t i = 0; i < names.size(); ++i)
    text += names.size() == 1 ? fmt::format(" v.{} = s;", names[i])
                              : fmt::format(" v.{} = s.{};", names[i], letters[i]);
  const FunctionId id = polyfills.add(function, base, {base, part}, {text + "\n  return v;\n}\n"});
  return polyfills.call(id, exprs(std::move(vector), std::move(value)));
}

ExprPtr wideWithComponent(Polyfills& polyfills, ExprPtr vector, ExprPtr index, ExprPtr value) {
  const Type base = vector->type;
  std::string text = fmt::format("{0} sk_with({0} v, int i, {1} s) {{\n", glslSpelling(base),
                                 glslSpelling(base.component()));
  for (int c = 0; c < base.width; ++c)
    text += fmt::format("  if (i == {}) v.{} = s;\n", c, letters[static_cast<std::size_t>(c)]);
  const FunctionId id = polyfills.add("sk_with", base, {base, Type::of(Scalar::Int), base.component()},
                                      {text + "  return v;\n}\n"});
  return polyfills.call(id, exprs(std::move(vector), std::move(index), std::move(value)));
}

}  // namespace skc::emit
