// SPDX-License-Identifier: MIT
#include "glsl/legalize.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "glsl/float_intrinsics.hpp"
#include "glsl/known_values.hpp"
#include "glsl/wide_values.hpp"
#include "ir/build.hpp"
#include "ir/evaluate.hpp"
#include "ir/operators.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc::emit {
namespace {

using namespace ir;

bool isKnown(const Index& n) { return std::holds_alternative<Literal>(n.index->node); }

bool isOfWide(const Index& n) { return n.base->type.isVector() && n.base->type.is64Bit(); }

/// True if GLSL can assign to this lvalue. Vectors of wide values are structs: one known component is an lvalue, several or a
/// computed one are not.
bool isAssignable(const Expr& lvalue) {
  if (const auto* n = std::get_if<Swizzle>(&lvalue.node))
    return (!lvalue.type.is64Bit() || lvalue.type.isScalar()) && isAssignable(*n->base);
  if (const auto* n = std::get_if<Index>(&lvalue.node))
    return (!isOfWide(*n) || isKnown(*n)) && isAssignable(*n->base);
  if (const auto* n = std::get_if<Member>(&lvalue.node)) return isAssignable(*n->base);
  return true;
}

/// True if GLSL's clamp of ints is defined: the lower bound is not the greater one.
bool hasOrderedBounds(const std::vector<ExprPtr>& args) {
  const auto* low = std::get_if<Literal>(&args[1]->node);
  const auto* high = std::get_if<Literal>(&args[2]->node);
  return args[1]->type.scalar == Scalar::Int && low != nullptr && high != nullptr &&
         static_cast<std::int32_t>(low->bits) <= static_cast<std::int32_t>(high->bits);
}

class Legalizer {
 public:
  Legalizer(const Module& module, const Capabilities& target, Polyfills& polyfills)
      : module_(module), target_(target), polyfills_(polyfills) {}

  void block(Block& statements) {
    walkStmts(statements, [&](Stmt& stmt) {
      if (auto* n = std::get_if<CallStmt>(&stmt.node)) {
        if (!n->result || target_.hasWideTypes || isAssignable(*n->result)) return call(*n);
        stmt.node = Assign{std::move(n->result), {}, ir::call(module_, n->callee, std::move(n->args))};
      }
      if (auto* n = std::get_if<Assign>(&stmt.node)) return assign(*n);
      forEachOperand(stmt, [&](ExprPtr& operand) { value(operand); });
    });
  }

  /// Rewrites outer expressions first: what is known of an operand shows in what the program has there.
  void value(ExprPtr& slot) {
    rewrite(slot);
    forEachOperand(*slot, [&](ExprPtr& operand) { value(operand); });
  }

 private:
  // ---- statements -------------------------------------------------------------------------------

  void call(CallStmt& n) {
    for (VarId i = 0; i < n.args.size(); ++i) {
      const bool isWritten = module_.functions[n.callee].variables[i].role == VarRole::InOut;
      isWritten ? lvalue(n.args[i]) : value(n.args[i]);
    }
    if (n.result) lvalue(n.result);
  }

  /// `x <<= n` becomes `x = x << n`, if the operation has to be rewritten.
  void assign(Assign& n) {
    if (n.op && isIllegal(*n.op, *n.place, *n.value)) {
      n.value = ir::binary(*n.op, clone(*n.place), std::move(n.value), n.place->loc);
      n.op.reset();
    }
    value(n.value);
    while (!target_.hasWideTypes && !isAssignable(*n.place)) widen(n.place, n.value);
    lvalue(n.place);
  }

  /// Makes a copy with a part replaced, and what contains the part, of a value and the part: `v.xy = d` becomes
  /// `v = sk_with_xy(v, d)`.
  void widen(ExprPtr& place, ExprPtr& part) {
    const ExprPtr inner = std::move(place);
    auto* n = std::get_if<Swizzle>(&inner->node);
    auto* element = std::get_if<Index>(&inner->node);
    place = std::move(n != nullptr ? n->base : element->base);
    ExprPtr whole = clone(*place);
    value(whole);
    if (n != nullptr) {
      part = wideWith(polyfills_, n->components, std::move(whole), std::move(part));
    } else {
      clamp(place->type, element->index);
      value(element->index);
      part = wideWithComponent(polyfills_, std::move(whole), convert(Scalar::Int, std::move(element->index)),
                               std::move(part));
    }
  }

  void lvalue(ExprPtr& slot) {
    if (auto* n = std::get_if<Index>(&slot->node)) {
      clamp(n->base->type, n->index);
      value(n->index);
      lvalue(n->base);
      nameComponent(*slot);
    } else if (auto* whole = std::get_if<Member>(&slot->node)) {
      lvalue(whole->base);
    } else if (auto* vector = std::get_if<Swizzle>(&slot->node)) {
      lvalue(vector->base);
    }
  }

  // ---- expressions ------------------------------------------------------------------------------

  void rewrite(ExprPtr& slot) {
    const Type type = slot->type;
    if (const auto bits = formulaOfLiterals(*slot)) slot->node = Literal{*bits};
    match(
        slot->node, [](Literal&) {}, [](VarRef&) {}, [](ConstantRef&) {}, [](Member&) {}, [](Call&) {},
        [](GatherRead&) {}, [](NeighborRead&) {}, [](Sample&) {}, [](IndexOf&) {}, [](ExtentOf&) {},
        [&](Unary& n) {
          if (lacks(type)) slot = wideUnary(polyfills_, n.op, std::move(n.operand));
        },
        [&](Binary& n) { binary(slot, n); },
        [&](Select& n) {
          const bool isFloat = type.arithmeticType().isFloat();
          if (!target_.choosesByComponent && n.cond->type.isVector() && !isFloat)
            slot = polyfills_.call(polyfills_.select(type),
                                   exprs(std::move(n.cond), std::move(n.yes), std::move(n.no)));
        },
        [&](Convert& n) { conversion(slot, n); },
        [&](Construct& n) {
          if (!lacks(type)) return;
          const bool isOperand = n.args.size() == 1 && n.args[0]->type == type;
          slot = wideVector(polyfills_, type, std::move(n.args));
          if (isOperand) rewrite(slot);
        },
        [&](Swizzle& n) {
          if (lacks(type) && type.isVector()) slot = wideSwizzle(polyfills_, n.components, std::move(n.base));
        },
        [&](Index& n) { index(slot, n); }, [&](IntrinsicCall& n) { intrinsic(slot, n); });
    slot->type = type;  // a narrow type is no function's
  }

  /// The value of a formula of float literals. Devices might divide less precisely when they compile.
  std::optional<std::uint32_t> formulaOfLiterals(const Expr& expr) const {
    const bool isFormula =
        std::holds_alternative<Binary>(expr.node) || std::holds_alternative<Convert>(expr.node);
    if (!isFormula || !expr.type.isScalar() || !expr.type.isFloat()) return std::nullopt;
    return evaluateInFloat(module_, expr, Constants::Keep);
  }

  bool lacks(Type type) const { return !target_.hasWideTypes && type.is64Bit(); }

  /// True if a compound assignment has no operator for these operands.
  bool isIllegal(BinaryOp op, const Expr& lhs, const Expr& rhs) const {
    return lacks(lhs.type) || takesQuotient(op, lhs, rhs) || mayShift(op, rhs) ||
           isMatrixProduct(op, lhs, rhs);
  }

  bool mayShift(BinaryOp op, const Expr& count) const {
    return !target_.shiftsByAnyCount && mayShiftTooFar(module_, op, count);
  }

  bool takesQuotient(BinaryOp op, const Expr& lhs, const Expr& rhs) const {
    if (target_.dividesIntegers) return false;
    const bool isSigned = op == BinaryOp::Rem && lhs.type.scalar == Scalar::Int;
    return mayDivideBadly(module_, op, lhs, rhs) || (isSigned && !(isNonNegative(lhs) && isNonNegative(rhs)));
  }

  /// GLSL's matrices have our rows as columns: they are transposed, so factors change order.
  bool isMatrixProduct(BinaryOp op, const Expr& lhs, const Expr& rhs) const {
    return !target_.hasRowsFirst && op == BinaryOp::Mul && lhs.type.isMatrix() && !rhs.type.isScalar();
  }

  void binary(ExprPtr& slot, Binary& n) {
    const Type lhs = n.lhs->type;
    const bool isLogical = n.op == BinaryOp::LogicalAnd || n.op == BinaryOp::LogicalOr;
    if (lacks(lhs)) {
      slot = wideBinary(polyfills_, n.op, std::move(n.lhs), std::move(n.rhs));
    } else if (!target_.comparesWithZero && comparesRoundedWithZero(n.op, *n.lhs, *n.rhs)) {
      const bool isEqual = n.op == BinaryOp::Equal;
      slot = polyfills_.call(polyfills_.nonzero(), exprs(std::move(isLiteralZero(*n.lhs) ? n.rhs : n.lhs)));
      if (isEqual) slot = unary(UnaryOp::LogicalNot, std::move(slot));
    } else if (isLogical && lhs.isVector() && !target_.choosesByComponent) {
      slot = polyfills_.call(polyfills_.logical(n.op, lhs), exprs(std::move(n.lhs), std::move(n.rhs)));
    } else if (takesQuotient(n.op, *n.lhs, *n.rhs)) {
      const FunctionId function = polyfills_.quotient(n.op, lhs, n.rhs->type);
      slot = polyfills_.call(function, exprs(std::move(n.lhs), std::move(n.rhs)));
    } else if (mayShift(n.op, *n.rhs)) {
      mask(n.rhs);
    } else if (isMatrixProduct(n.op, *n.lhs, *n.rhs)) {
      std::swap(n.lhs, n.rhs);
    }
  }

  /// The count modulo 32.
  static void mask(ExprPtr& count) {
    const Loc loc = count->loc;
    const bool isUint = arithmeticScalar(count->type.scalar) == Scalar::Uint;
    count = ir::binary(BinaryOp::BitAnd, std::move(count),
                       isUint ? literal(31u, loc) : literal(std::int32_t{31}, loc), loc);
  }

  void conversion(ExprPtr& slot, Convert& n) {
    const Type to = slot->type, from = n.operand->type;
    if (lacks(to) || lacks(from)) {
      slot = wideConverted(polyfills_, to, std::move(n.operand));
    } else if (to.isNarrow() && !target_.hasNarrowTypes) {
      ExprPtr operand = convert(arithmeticScalar(to.scalar), std::move(n.operand), slot->loc);
      slot = polyfills_.call(polyfills_.quantize(to), exprs(std::move(operand)));
    } else if (to.isScalar() && to.isBool() && from.arithmeticType().isFloat() && !target_.comparesWithZero) {
      slot = polyfills_.call(polyfills_.nonzero(), exprs(std::move(n.operand)));
    } else if (!target_.convertsAnyFloat && mayNotHold(module_, to, *n.operand)) {
      slot = polyfills_.call(polyfills_.truncated(to), exprs(std::move(n.operand)));
    }
  }

  void index(ExprPtr& slot, Index& n) {
    const Type base = n.base->type;
    const bool isComputed = base.isVector() && !isKnown(n);
    if (!isComputed || base.is64Bit() || target_.choosesByComponent) clamp(base, n.index);
    if (isComputed && lacks(base)) {
      slot = wideComponent(polyfills_, std::move(n.base), convert(Scalar::Int, std::move(n.index)));
    } else if (isComputed && !target_.choosesByComponent) {
      const FunctionId function = polyfills_.component(base, n.index->type);
      slot = polyfills_.call(function, exprs(std::move(n.base), std::move(n.index)));
    } else {
      nameComponent(*slot);
    }
  }

  /// A known component of a vector of wide values is a member of a struct: `v[1]` becomes `v.y`.
  void nameComponent(Expr& expr) const {
    auto& n = std::get<Index>(expr.node);
    if (target_.hasWideTypes || !isOfWide(n) || !isKnown(n)) return;
    const auto component = static_cast<std::uint8_t>(std::get<Literal>(n.index->node).bits);
    expr.node = Swizzle{std::move(n.base), {component}};
  }

  void clamp(Type base, ExprPtr& index) const {
    if (target_.clampsIndices) return;
    const bool isArray = base.kind == Type::Kind::Array;
    const std::uint32_t last = (isArray ? module_.arrays[base.index].length : base.width) - 1;
    const bool isUint = index->type.scalar == Scalar::Uint;
    const Loc loc = index->loc;
    if (auto* known = std::get_if<Literal>(&index->node)) {  // one outside is an error in GLSL
      const bool isBelow = !isUint && static_cast<std::int32_t>(known->bits) < 0;
      known->bits = isBelow ? 0 : std::min(known->bits, last);
    } else if (isUint) {
      index = ir::intrinsic(Intrinsic::Min, exprs(std::move(index), literal(last, loc)), loc);
    } else {
      index = ir::intrinsic(Intrinsic::Clamp,
                            exprs(std::move(index), literal(std::int32_t{0}, loc),
                                  literal(static_cast<std::int32_t>(last), loc)),
                            loc);
    }
  }

  /// Whether the call is the third power of a variable, whose product is within the bound of pow().
  static bool isCube(const IntrinsicCall& n) {
    if (n.intrinsic != Intrinsic::Pow || !std::holds_alternative<VarRef>(n.args[0]->node)) return false;
    const auto* exponent = std::get_if<Literal>(&n.args[1]->node);
    return exponent != nullptr && n.args[1]->type.scalar == Scalar::Float && exponent->bits == 0x40400000U;
  }

  void intrinsic(ExprPtr& slot, IntrinsicCall& n) {
    const Type argument = n.args[0]->type;
    if (lacks(argument)) {
      slot = wideIntrinsic(polyfills_, n.intrinsic, std::move(n.args));
    } else if (n.intrinsic == Intrinsic::Abs && argument.scalar == Scalar::Int && !target_.comparesWithZero) {
      slot = polyfills_.call(polyfills_.magnitude(argument), std::move(n.args));
    } else if (isCube(n)) {
      ExprPtr& x = n.args[0];
      ExprPtr square = ir::binary(BinaryOp::Mul, clone(*x), clone(*x), slot->loc);
      slot = ir::binary(BinaryOp::Mul, std::move(square), std::move(x), slot->loc);
    } else if (!target_.hasIntrinsics) {
      compose(slot, n);
    }
  }

  /// Expresses an intrinsic by others, if GLSL lacks it for these arguments.
  void compose(ExprPtr& slot, IntrinsicCall& n) {
    std::vector<ExprPtr>& args = n.args;
    const Type argument = args[0]->type;
    if (definedIntrinsic(n)) return broadcast(args);
    switch (n.intrinsic) {
      case Intrinsic::Fma: {
        ExprPtr product = ir::binary(BinaryOp::Mul, std::move(args[0]), std::move(args[1]));
        slot = ir::binary(BinaryOp::Add, std::move(product), std::move(args[2]));
        return;
      }
      case Intrinsic::Clamp: {
        if (hasOrderedBounds(args)) return;
        ExprPtr above = ir::intrinsic(Intrinsic::Max, exprs(std::move(args[0]), std::move(args[1])));
        slot = ir::intrinsic(Intrinsic::Min, exprs(std::move(above), std::move(args[2])));
        return;
      }
      case Intrinsic::Isfinite: {
        ExprPtr exponent =
            ir::binary(BinaryOp::BitAnd, ir::intrinsic(Intrinsic::FloatBitsToUint, std::move(args)),
                       literal(0x7f800000u));
        ExprPtr infinity = literal(0x7f800000u);
        if (argument.isVector()) infinity = construct(exponent->type, exprs(std::move(infinity)));
        slot = ir::binary(argument.isVector() ? BinaryOp::Less : BinaryOp::NotEqual, std::move(exponent),
                          std::move(infinity));
        return;
      }
      case Intrinsic::Any:
      case Intrinsic::All:
        if (argument.isVector()) return;
        slot = std::move(args[0]);
        return rewrite(slot);
      default: return;
    }
  }

  /// The assembler's functions take floats of one width.
  static void broadcast(std::vector<ExprPtr>& args) {
    const ExprPtr& widest =
        *std::ranges::max_element(args, {}, [](const ExprPtr& arg) { return arg->type.width; });
    const Type type = widest->type;
    for (ExprPtr& arg : args) {
      if (arg->type.width < type.width) arg = construct(type, exprs(std::move(arg)));
    }
  }

  const Module& module_;
  const Capabilities& target_;
  Polyfills& polyfills_;
};

}  // namespace

namespace {

void removePrints(Block& block) {
  std::erase_if(block, [](const Stmt& stmt) { return std::holds_alternative<Print>(stmt.node); });
  for (Stmt& stmt : block) forEachBlock(stmt, [](Block& inner) { removePrints(inner); });
}

}  // namespace

Polyfills legalize(Module& module, const Capabilities& target) {
  Polyfills polyfills(module);
  Legalizer legalizer(module, target, polyfills);
  const std::size_t count = module.functions.size();
  for (FunctionId id = 0; id < count; ++id) {
    Block body = std::move(module.functions[id].body);  // polyfills move the functions
    if (!target.prints) removePrints(body);
    legalizer.block(body);
    module.functions[id].body = std::move(body);
  }
  for (Kernel& kernel : module.kernels) {
    for (KernelParam& param : kernel.params) {
      if (param.border) legalizer.value(param.border);
      if (param.identity) legalizer.value(param.identity);
    }
  }
  // A constant refers only to earlier ones: what these are is seen before they change.
  for (Constant& constant : module.constants | std::views::reverse) legalizer.value(constant.value);
  return polyfills;
}

void legalize(const Module& module, const Capabilities& target, Polyfills& polyfills, ExprPtr& expr) {
  Legalizer(module, target, polyfills).value(expr);
}

}  // namespace skc::emit
