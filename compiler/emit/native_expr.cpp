// SPDX-License-Identifier: MIT
#include "emit/native_expr.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "ir/print.hpp"
#include "support/overloaded.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

struct Parts {
  std::string text;
  Precedence precedence = Precedence::Primary;
};

/// The names of the rows of intrinsics.def, with a small first letter.
std::string functionName(Intrinsic intrinsic) {
  static constexpr std::string_view names[] = {
#define SKC_INTRINSIC(name, ...) #name,
#include "ir/intrinsics.def"
#undef SKC_INTRINSIC
  };
  std::string name(names[static_cast<std::size_t>(intrinsic)]);
  name.front() = static_cast<char>(name.front() - 'A' + 'a');
  return name;
}

/// Those that make a real number of bits: their argument does not tell which real type.
bool makesReal(Intrinsic intrinsic) {
  return intrinsic == Intrinsic::IntBitsToFloat || intrinsic == Intrinsic::UintBitsToFloat ||
         intrinsic == Intrinsic::AsFloatInt || intrinsic == Intrinsic::AsFloatUint;
}

std::string scalarType(Scalar scalar) {
  static constexpr std::array<std::string_view, 14> names = {"bool",
                                                             "native::Int",
                                                             "native::Uint",
                                                             "sk_real",
                                                             "native::Wide<sk_real>",
                                                             "native::Half<sk_real>",
                                                             "native::Char",
                                                             "native::Uchar",
                                                             "native::Short",
                                                             "native::Ushort",
                                                             "native::Unorm8<sk_real>",
                                                             "native::Snorm8<sk_real>",
                                                             "native::Unorm16<sk_real>",
                                                             "native::Snorm16<sk_real>"};
  return std::string(names[static_cast<std::size_t>(scalar)]);
}

std::string realText(double value, bool isFloat) {
  const std::string type = scalarType(isFloat ? Scalar::Float : Scalar::Double);
  const std::string_view limits = isFloat ? "float" : "double";
  if (std::isnan(value)) return fmt::format("{}(std::numeric_limits<{}>::quiet_NaN())", type, limits);
  if (std::isinf(value)) {
    return fmt::format("{}({}std::numeric_limits<{}>::infinity())", type, value < 0 ? "-" : "", limits);
  }
  return isFloat ? fmt::format("{}({}F)", type, shortestFloat(static_cast<float>(value)))
                 : fmt::format("{}({})", type, fmt::format("{:#}", value));
}

std::string literalText(Type type, const Literal& n) {
  if (type.isDouble()) return realText(std::bit_cast<double>(std::uint64_t{n.high} << 32 | n.bits), false);
  switch (carrierOf(type.scalar)) {
    case Scalar::Bool: return n.bits != 0 ? "true" : "false";
    case Scalar::Int: {
      const auto value = static_cast<std::int32_t>(n.bits);
      const std::string text = value < 0 ? fmt::format("native::Int({})", value) : fmt::format("{}_i", value);
      return type.isNarrow() ? fmt::format("{}({})", scalarType(type.scalar), text) : text;
    }
    case Scalar::Uint: return fmt::format("{}_u", n.bits);
    case Scalar::Float: {
      const std::string text = realText(std::bit_cast<float>(n.bits), true);
      return type.isNarrow() ? fmt::format("{}({})", scalarType(type.scalar), text) : text;
    }
    case Scalar::Double:
    case Scalar::Half:
    case Scalar::Char:
    case Scalar::Uchar:
    case Scalar::Short:
    case Scalar::Ushort:
    case Scalar::Unorm8:
    case Scalar::Snorm8:
    case Scalar::Unorm16:
    case Scalar::Snorm16: break;   // no carriers
  }
  return {};
}

bool isBitwise(BinaryOp op) {
  return op == BinaryOp::BitAnd || op == BinaryOp::BitOr || op == BinaryOp::BitXor;
}

class NativeExpr {
 public:
  NativeExpr(const NativeContext& context, std::optional<FunctionId> function)
      : context_(context), function_(function) {}

  std::string text(const Expr& expr, Precedence around = Precedence::Lowest) const {
    const Parts whole = match(expr.node, [&](const auto& node) { return print(expr.type, node); });
    return whole.precedence < around ? "(" + whole.text + ")" : whole.text;
  }

  std::string assigned(const Expr& place, const std::string& value) const {
    if (!isSeveralComponents(place)) return text(place) + " = " + value;
    const Components whole = flattened(std::get<Swizzle>(place.node));
    return fmt::format("native::assign<{}>({}, {})", numbers(whole.components), text(*whole.base), value);
  }

  std::string combined(BinaryOp op, const Expr& place, const Expr& value) const {
    return binary(place.type, op, place, value).text;
  }

 private:
  static Parts print(Type type, const Literal& n) { return {literalText(type, n)}; }
  Parts print(Type, const VarRef& n) const {
    const std::string& name = context_.names.variable(*function_, n.var);
    const bool isOfLanes = context_.divergence != nullptr && context_.divergence->differs(*function_, n.var);
    return {isOfLanes ? firstLane(name) : name};
  }
  Parts print(Type, const ConstantRef& n) const { return {nativeConstant(context_, n.constant) + "()"}; }
  Parts print(Type, const Unary& n) const {
    return {std::string(spelling(n.op)) + text(*n.operand, Precedence::Primary), Precedence::Unary};
  }
  Parts print(Type type, const Binary& n) const { return binary(type, n.op, *n.lhs, *n.rhs); }
  Parts print(Type, const Select& n) const {
    if (n.cond->type.isVector()) return {"native::select" + list({n.cond.get(), n.yes.get(), n.no.get()})};
    return {fmt::format("{} ? {} : {}", text(*n.cond, Precedence::LogicalOr),
                        text(*n.yes, Precedence::LogicalOr), text(*n.no, Precedence::Conditional)),
            Precedence::Conditional};
  }
  Parts print(Type type, const Convert& n) const {
    // to half and back in one go: loops have vectors for what never is a half
    const auto* inner = std::get_if<Convert>(&n.operand->node);
    if (inner != nullptr && n.operand->type.scalar == Scalar::Half && type.isFloat() &&
        inner->operand->type == type) {
      return {fmt::format("native::roundedToHalf({})", text(*inner->operand))};
    }
    return {fmt::format("native::convert<{}>({})", typeText(type), text(*n.operand))};
  }
  Parts print(Type type, const Construct& n) const {
    const bool isStruct = type.kind == Type::Kind::Struct;
    return {typeText(type) + (isStruct ? "{" : "(") + join(texts(n.args), ", ") + (isStruct ? "}" : ")")};
  }
  Parts print(Type, const Swizzle& n) const {
    const Components whole = flattened(n);
    if (whole.components.size() == 1) {
      return {fmt::format("{}[{}]", text(*whole.base, Precedence::Primary), whole.components[0])};
    }
    return {fmt::format("native::swizzle<{}>({})", numbers(whole.components), text(*whole.base))};
  }
  Parts print(Type, const Member& n) const {
    return {text(*n.base, Precedence::Primary) + "." + context_.types.fieldName(n.base->type.index, n.field)};
  }
  Parts print(Type, const Index& n) const {
    const auto* literal = std::get_if<Literal>(&n.index->node);
    const std::string index =
        literal != nullptr ? std::to_string(static_cast<std::int32_t>(literal->bits)) : text(*n.index);
    if (isSeveralComponents(*n.base)) {
      const Components whole = flattened(std::get<Swizzle>(n.base->node));
      return {
          fmt::format("native::component<{}>({}, {})", numbers(whole.components), text(*whole.base), index)};
    }
    return {fmt::format("{}[{}]", text(*n.base, Precedence::Primary), index)};
  }
  Parts print(Type, const Call& n) const {
    const std::string_view prefix = context_.module.functions[n.callee].table ? "sk_table_" : "";
    return {fmt::format("{}{}({})", prefix, context_.functions.at(n.callee), join(texts(n.args), ", "))};
  }
  Parts print(Type, const IntrinsicCall& n) const {
    return {fmt::format("{}({})", nativeIntrinsic(n.intrinsic), join(texts(n.args), ", "))};
  }
  Parts print(Type, const GatherRead& n) const {
    return {fmt::format("{}.at({})", stream(n.stream), text(*n.index))};
  }
  Parts print(Type, const NeighborRead& n) const {
    return {fmt::format("{}.near(sk_i, {})", stream(n.stream), text(*n.offset))};
  }
  Parts print(Type type, const Sample& n) const {
    return {fmt::format("{}.template sample<{}>({})", stream(n.stream), typeText(type), text(*n.position))};
  }
  Parts print(Type, const IndexOf& n) const {
    const bool isInput = n.stream.space == StreamRef::Space::KernelParameter &&
                         context_.kernel.params[n.stream.id].role == ParamRole::Input;
    return {isInput ? stream(n.stream) + ".index(sk_index)" : "sk_index"};
  }
  Parts print(Type, const ExtentOf& n) const {
    const bool isDomain = n.stream.space == StreamRef::Space::Domain;
    return {isDomain ? "sk_extent" : stream(n.stream) + ".extent()"};
  }

  Parts binary(Type type, BinaryOp op, const Expr& lhs, const Expr& rhs) const {
    const Precedence precedence = precedenceOf(op);
    const auto tighter = static_cast<Precedence>(static_cast<int>(precedence) + 1);
    const std::string text =
        fmt::format("{} {} {}", operand(op, lhs, precedence), spelling(op), operand(op, rhs, tighter));
    if (isBitwise(op) && type.isBool() && type.isScalar()) return {"bool(" + text + ")"};
    return {text, precedence};
  }

  std::string operand(BinaryOp outer, const Expr& expr, Precedence around) const {
    const auto* inner = std::get_if<Binary>(&expr.node);
    return text(expr, inner != nullptr && bracketsForClarity(outer, inner->op) ? Precedence::Unary : around);
  }

  std::string typeText(Type type) const { return nativeType(context_.module, context_.types, type); }
  std::string stream(StreamRef stream) const { return nativeParameter(context_, stream.id); }

  std::vector<std::string> texts(const std::vector<ExprPtr>& items) const {
    std::vector<std::string> result;
    for (const ExprPtr& item : items) result.push_back(text(*item));
    return result;
  }
  std::string list(std::initializer_list<const Expr*> items) const {
    std::vector<std::string> result;
    for (const Expr* item : items) result.push_back(text(*item));
    return "(" + join(result, ", ") + ")";
  }

  const NativeContext& context_;
  std::optional<FunctionId> function_;
};

}  // namespace

std::string numbers(const std::vector<std::uint8_t>& components) {
  std::vector<std::string> list;
  for (const std::uint8_t component : components) list.push_back(std::to_string(component));
  return join(list, ", ");
}

Components flattened(const Swizzle& n) {
  const auto* inner = std::get_if<Swizzle>(&n.base->node);
  if (inner == nullptr) return {n.base.get(), n.components};
  Components whole = flattened(*inner);
  std::vector<std::uint8_t> picked;
  for (const std::uint8_t component : n.components) picked.push_back(whole.components[component]);
  return {whole.base, std::move(picked)};
}

std::string nativeIntrinsic(Intrinsic intrinsic) {
  return fmt::format("native::{}{}", functionName(intrinsic), makesReal(intrinsic) ? "<sk_real>" : "");
}

std::string nativeType(const Module& module, const TypeNames& types, Type type) {
  switch (type.kind) {
    case Type::Kind::Void: return "void";
    case Type::Kind::Scalar: return scalarType(type.scalar);
    case Type::Kind::Vector: return fmt::format("native::Vec<{}, {}>", scalarType(type.scalar), type.width);
    case Type::Kind::Matrix: return fmt::format("native::Mat<sk_real, {}>", type.width);
    case Type::Kind::Struct: return types.structName(type.index) + "<sk_real>";
    case Type::Kind::Array: break;
  }
  const Array& array = module.arrays[type.index];
  return fmt::format("native::Array<{}, {}>", nativeType(module, types, array.element), array.length);
}

std::string nativeParameter(const NativeContext& context, std::uint32_t param) {
  return "sk_arg_" + context.names.symbol(param);
}

std::string nativeConstant(const NativeContext& context, ConstantId id) {
  std::string name = context.names.constant(id);
  if (name.back() == ')') name.resize(name.size() - 2);   // in GLSL, only some are functions
  return name;
}

std::string nativeExpr(const NativeContext& context, std::optional<FunctionId> function, const Expr& expr,
                       Precedence around) {
  return NativeExpr(context, function).text(expr, around);
}

std::string nativeAssignment(const NativeContext& context, FunctionId function, const Expr& place,
                             std::optional<BinaryOp> op, const Expr& value) {
  const NativeExpr printer(context, function);
  return printer.assigned(place, op ? printer.combined(*op, place, value) : printer.text(value));
}

std::string nativeAssignment(const NativeContext& context, FunctionId function, const Expr& place,
                             const std::string& value) {
  return NativeExpr(context, function).assigned(place, value);
}

bool isSeveralComponents(const Expr& place) {
  const auto* n = std::get_if<Swizzle>(&place.node);
  return n != nullptr && n->components.size() > 1;
}

}  // namespace skc::emit
