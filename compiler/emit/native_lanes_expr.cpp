// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "emit/native_lanes.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

/// Those that sk/native/lanes_intrinsics.hpp has; others are computed lane by lane.
bool hasVectors(Intrinsic intrinsic) {
  using enum Intrinsic;
  static constexpr Intrinsic all[] = {Radians,
                                      Degrees,
                                      Sqrt,
                                      InverseSqrt,
                                      Rsqrt,
                                      Abs,
                                      Fabs,
                                      Sign,
                                      Floor,
                                      Trunc,
                                      Round,
                                      RoundEven,
                                      Ceil,
                                      Fract,
                                      Frac,
                                      Min,
                                      Max,
                                      Fmin,
                                      Fmax,
                                      Clamp,
                                      Saturate,
                                      Mix,
                                      MixBool,
                                      Lerp,
                                      Step,
                                      Smoothstep,
                                      Fma,
                                      Isnan,
                                      Isinf,
                                      Isfinite,
                                      FloatBitsToInt,
                                      FloatBitsToUint,
                                      IntBitsToFloat,
                                      UintBitsToFloat,
                                      AsInt,
                                      AsUint,
                                      AsFloatInt,
                                      AsFloatUint,
                                      Dot,
                                      Length,
                                      Distance,
                                      Normalize,
                                      Cross,
                                      Reflect};
  return std::ranges::find(all, intrinsic) != std::end(all);
}

bool callsAnything(const Expr& expr) {
  bool calls = false;
  walkExprs(expr, [&](const Expr& inner) { calls = calls || std::holds_alternative<Call>(inner.node); });
  return calls;
}

class LanesExpr {
 public:
  LanesExpr(const NativeContext& context, FunctionId function, std::string on)
      : context_(context), function_(function), on_(std::move(on)) {}

  /// In brackets where it is an operation and they are asked for.
  std::string text(const Expr& expr, bool asOperand = false) const {
    if (!differs(expr)) return uniform(expr, asOperand ? Precedence::Unary : Precedence::Lowest);
    const std::string whole = match(expr.node, [&](const auto& node) { return print(expr.type, node); });
    const bool isOperation =
        std::holds_alternative<Binary>(expr.node) || std::holds_alternative<Unary>(expr.node);
    return asOperand && isOperation ? "(" + whole + ")" : whole;
  }
  std::string spread(const Expr& expr) const {
    return differs(expr) ? text(expr) : fmt::format("native::spread({})", text(expr));
  }

 private:
  bool differs(const Expr& expr) const { return context_.divergence->differs(function_, expr); }
  std::string uniform(const Expr& expr, Precedence around = Precedence::Lowest) const {
    return nativeExpr(context_, function_, expr, around);
  }
  std::string mask() const { return on_.empty() ? "native::Mask(true)" : on_; }

  /// Those that never differ.
  static std::string print(Type, const Literal&) { return {}; }
  static std::string print(Type, const ConstantRef&) { return {}; }
  static std::string print(Type, const ExtentOf&) { return {}; }

  std::string print(Type, const VarRef& n) const { return context_.names.variable(function_, n.var); }
  std::string print(Type type, const Unary& n) const {
    const std::string operand = text(*n.operand, true);
    return (type.isBool() && n.op == UnaryOp::BitNot ? "!" : std::string(spelling(n.op))) + operand;
  }
  std::string print(Type, const Binary& n) const {
    if (n.op == BinaryOp::LogicalAnd || n.op == BinaryOp::LogicalOr) return logical(n);
    return fmt::format("{} {} {}", text(*n.lhs, true), spelling(n.op), text(*n.rhs, true));
  }
  /// What the left side decides is not computed by calls, which might take long.
  std::string logical(const Binary& n) const {
    const bool isAnd = n.op == BinaryOp::LogicalAnd;
    const char* decided = isAnd ? "false" : "true";
    if (!differs(*n.lhs)) {
      const std::string rest = spread(*n.rhs);
      return isAnd ? fmt::format("({} ? {} : native::Mask(false))", uniform(*n.lhs, Precedence::LogicalOr),
                                 rest)
                   : fmt::format("({} ? native::Mask(true) : {})", uniform(*n.lhs, Precedence::LogicalOr),
                                 rest);
    }
    if (!callsAnything(*n.rhs)) {
      return fmt::format("{} {} {}", text(*n.lhs, true), isAnd ? "&" : "|", text(*n.rhs, true));
    }
    const std::string rest = lambda(*n.rhs);
    const std::string known = fmt::format("[](const native::Mask&) {{ return native::Mask({}); }}", decided);
    return fmt::format("native::choose({}, {}, {}, {})", mask(), text(*n.lhs), isAnd ? rest : known,
                       isAnd ? known : rest);
  }
  std::string print(Type, const Select& n) const {
    if (!differs(*n.cond)) {
      return fmt::format("({} ? {} : {})", uniform(*n.cond, Precedence::LogicalOr), spread(*n.yes),
                         spread(*n.no));
    }
    if (n.cond->type.isScalar() && (callsAnything(*n.yes) || callsAnything(*n.no))) {
      return fmt::format("native::choose({}, {}, {}, {})", mask(), text(*n.cond), lambda(*n.yes),
                         lambda(*n.no));
    }
    return fmt::format("native::select({}, {}, {})", text(*n.cond), spread(*n.yes), spread(*n.no));
  }
  /// An expression as a function of the lanes that want it.
  std::string lambda(const Expr& expr) const {
    const std::string inner = on_.empty() ? "sk_on0" : on_ + "x";
    return fmt::format("[&]([[maybe_unused]] const native::Mask& {}) {{ return {}; }}", inner,
                       LanesExpr(context_, function_, inner).spread(expr));
  }

  std::string print(Type type, const Convert& n) const {
    return fmt::format("native::convertLanes<{}>({})", scalar(type), text(*n.operand));
  }
  std::string print(Type type, const Construct& n) const {
    return fmt::format("{}({})", lanesType(context_, type), join(texts(n.args), ", "));
  }
  std::string print(Type, const Swizzle& n) const {
    const Components whole = flattened(n);
    if (whole.components.size() == 1) {
      return fmt::format("{}[{}]", text(*whole.base, true), whole.components[0]);
    }
    return fmt::format("native::swizzle<{}>({})", numbers(whole.components), text(*whole.base));
  }
  static std::string print(Type, const Member&) { return {}; }   // of structs, which never differ
  std::string print(Type, const Index& n) const {
    if (!differs(*n.index)) {
      const auto* literal = std::get_if<Literal>(&n.index->node);
      return fmt::format(
          "{}[{}]", text(*n.base, true),
          literal != nullptr ? std::to_string(static_cast<std::int32_t>(literal->bits)) : text(*n.index));
    }
    if (!differs(*n.base)) {
      return fmt::format("native::laneByLane([&](const auto& sk_at) {{ return {}[sk_at]; }}, {})",
                         uniform(*n.base, Precedence::Primary), text(*n.index));
    }
    return fmt::format(
        "native::laneByLane([](const auto& sk_v, const auto& sk_at) {{ return sk_v[sk_at]; }}, {}, {})",
        text(*n.base), text(*n.index));
  }
  std::string print(Type, const Call& n) const {
    const Function& callee = context_.module.functions[n.callee];
    if (callee.table) {
      return fmt::format("native::laneByLane([&](sk_real sk_x) {{ return sk_table_{}(sk_x); }}, {})",
                         context_.functions.at(n.callee), text(*n.args[0]));
    }
    const FunctionDivergence& divergence = context_.divergence->of(n.callee);
    std::vector<std::string> args;
    if (divergence.isCalledApart) args.push_back(mask());
    for (std::size_t i = 0; i < n.args.size(); ++i) {
      args.push_back(divergence.variables[i] ? spread(*n.args[i]) : text(*n.args[i]));
    }
    const std::string call = fmt::format("{}({})", lanesFunction(context_, n.callee), join(args, ", "));
    return divergence.result ? call : fmt::format("native::spread({})", call);
  }
  std::string print(Type, const IntrinsicCall& n) const {
    if (hasVectors(n.intrinsic)) {
      std::vector<std::string> args;
      for (const ExprPtr& arg : n.args) args.push_back(spread(*arg));
      return fmt::format("{}({})", nativeIntrinsic(n.intrinsic), join(args, ", "));
    }
    return fmt::format("native::laneByLane([](const auto&... sk_x) {{ return {}(sk_x...); }}, {})",
                       nativeIntrinsic(n.intrinsic), join(texts(n.args), ", "));
  }
  std::string print(Type, const GatherRead& n) const {
    const auto* construct = std::get_if<Construct>(&n.index->node);
    const bool isApart = construct != nullptr && construct->args.size() == n.index->type.width;
    const Expr& x = isApart ? *construct->args[0] : *n.index;
    const bool isRow = !isApart || std::none_of(construct->args.begin() + 1, construct->args.end(),
                                                [&](const ExprPtr& arg) { return differs(*arg); });
    if (isRow && context_.divergence->isRamp(function_, x)) {
      std::vector<std::string> first = {uniform(x)};
      for (std::size_t d = 1; isApart && d < construct->args.size(); ++d)
        first.push_back(uniform(*construct->args[d]));
      return fmt::format("{}.lanesFrom({})", stream(n.stream), join(first, ", "));
    }
    return fmt::format("{}.lanesAt({})", stream(n.stream),
                       isApart ? join(texts(construct->args), ", ") : text(*n.index));
  }
  std::string print(Type, const NeighborRead& n) const {
    return fmt::format("{}.lanesNear(sk_i, {})", stream(n.stream), uniform(*n.offset));
  }
  std::string print(Type type, const Sample& n) const {
    return fmt::format(
        "native::laneByLane([&](const auto& sk_x) {{ return {}.template sample<{}>(sk_x); }}, {})",
        stream(n.stream), nativeType(context_.module, context_.types, type), text(*n.position));
  }
  std::string print(Type, const IndexOf& n) const {
    const bool isInput = n.stream.space == StreamRef::Space::KernelParameter &&
                         context_.kernel.params[n.stream.id].role == ParamRole::Input;
    return isInput ? stream(n.stream) + ".lanesIndex(sk_index)" : "native::lanesIndex(sk_index)";
  }

  std::string stream(StreamRef stream) const { return nativeParameter(context_, stream.id); }
  std::string scalar(Type type) const {
    return nativeType(context_.module, context_.types, Type::of(type.scalar));
  }
  std::vector<std::string> texts(const std::vector<ExprPtr>& items) const {
    std::vector<std::string> result;
    for (const ExprPtr& item : items) result.push_back(text(*item));
    return result;
  }

  const NativeContext& context_;
  FunctionId function_;
  std::string on_;
};

}  // namespace

std::string lanesFunction(const NativeContext& context, FunctionId id) {
  return "sk_lanes_" + context.functions.at(id);
}

std::string lanesType(const NativeContext& context, Type type) {
  if (type.isVoid()) return "void";
  const std::string scalar = nativeType(context.module, context.types, Type::of(type.scalar));
  const std::string lanes = fmt::format("native::Lanes<{}>", scalar);
  return type.isVector() ? fmt::format("native::Vec<{}, {}>", lanes, type.width) : lanes;
}

std::string lanesExpr(const NativeContext& context, FunctionId function, const Expr& expr,
                      const std::string& on) {
  return LanesExpr(context, function, on).text(expr);
}

std::string spreadExpr(const NativeContext& context, FunctionId function, const Expr& expr,
                       const std::string& on) {
  return LanesExpr(context, function, on).spread(expr);
}

}  // namespace skc::emit
