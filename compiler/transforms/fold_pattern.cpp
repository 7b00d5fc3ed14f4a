// SPDX-License-Identifier: MIT
#include "transforms/fold_pattern.hpp"

#include <algorithm>
#include <limits>

#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/operators.hpp"
#include "ir/walk.hpp"

namespace skc {

using namespace ir;

namespace {

/// Removes conversions between a narrow type and its arithmetic type, which operators need.
const Expr& withoutArithmeticConversion(const Expr& expr) {
  const auto* n = std::get_if<Convert>(&expr.node);
  const bool isConversion = n != nullptr && (expr.type.isNarrow() || n->operand->type.isNarrow()) &&
                            arithmeticScalar(expr.type.scalar) == arithmeticScalar(n->operand->type.scalar);
  return isConversion ? *n->operand : expr;
}

bool isCommutative(BinaryOp op) {
  constexpr BinaryOp all[] = {BinaryOp::Add,    BinaryOp::Mul,        BinaryOp::BitAnd,   BinaryOp::BitOr,
                              BinaryOp::BitXor, BinaryOp::LogicalAnd, BinaryOp::LogicalOr};
  return std::find(std::begin(all), std::end(all), op) != std::end(all);
}

bool isSame(const Expr& expr, const StaticLValue& lvalue) {
  return staticLValue(withoutArithmeticConversion(expr)) == lvalue;
}

std::optional<FoldOp> minOrMax(Intrinsic intrinsic) {
  if (intrinsic == Intrinsic::Min || intrinsic == Intrinsic::Fmin) return Intrinsic::Min;
  if (intrinsic == Intrinsic::Max || intrinsic == Intrinsic::Fmax) return Intrinsic::Max;
  return std::nullopt;
}

/// The operator if `value` is `place op f`, or a chain `place op f op g`; + for a chain of sums and
/// differences.
std::optional<FoldOp> selfFold(const Expr& value, const StaticLValue& lvalue) {
  if (const auto* n = std::get_if<Binary>(&value.node)) {
    if (isComparison(n->op)) return std::nullopt;
    const bool hasMatrix = n->lhs->type.isMatrix() || n->rhs->type.isMatrix();
    if (hasMatrix && n->op != BinaryOp::Add) return std::nullopt;  // products of matrices do not commute
    const std::optional<FoldOp> left = selfFold(*n->lhs, lvalue);
    if (isSame(*n->lhs, lvalue) || left == FoldOp(n->op)) return n->op;
    if (isCommutative(n->op) && (isSame(*n->rhs, lvalue) || selfFold(*n->rhs, lvalue) == FoldOp(n->op)))
      return n->op;
    if (n->op == BinaryOp::Sub && left == FoldOp(BinaryOp::Add)) return BinaryOp::Add;
  }
  if (const auto* n = std::get_if<IntrinsicCall>(&value.node)) {
    const std::optional<FoldOp> op = minOrMax(n->intrinsic);
    if (op && (isSame(*n->args[0], lvalue) || isSame(*n->args[1], lvalue))) return op;
  }
  return std::nullopt;
}

/// Adds a target; false if one of its components is folded by another operator already.
bool add(std::vector<FoldTarget>& targets, FoldTarget target) {
  FoldTarget* same = nullptr;
  for (FoldTarget& other : targets) {
    if (!other.isOfMember(target)) continue;
    if (other.op == target.op) {
      same = &other;
    } else if ((other.components & target.components) != 0) {
      return false;
    }
  }
  if (same == nullptr) {
    targets.push_back(std::move(target));
  } else {
    same->components |= target.components;
  }
  return true;
}

class Recogniser {
 public:
  explicit Recogniser(const Kernel& kernel) : kernel_(kernel) {}

  /// The target that a statement folds into an accumulator.
  std::optional<FoldTarget> foldOf(const Stmt& stmt) const {
    const auto* n = std::get_if<Assign>(&stmt.node);
    if (n == nullptr) return std::nullopt;
    const std::optional<StaticLValue> lvalue = lvalueOf(*n->place);
    if (!lvalue) return std::nullopt;
    const std::optional<FoldOp> op =
        n->op ? FoldOp(*n->op) : selfFold(withoutArithmeticConversion(*n->value), *lvalue);
    if (!op) return std::nullopt;
    if (lvalue->type.isMatrix() && op != FoldOp(BinaryOp::Add)) return std::nullopt;
    if (reads(*n->value) != (n->op ? 0 : 1)) return std::nullopt;
    return FoldTarget{{lvalue->root, lvalue->members, lvalue->type, lvalue->mask()}, *op, stmt.loc};
  }

  std::optional<FoldPattern> run(const Block& body) const {
    FoldPattern pattern{{}, false};
    bool matches = true;
    walkStmts(body, [&](const Stmt& stmt) {
      std::optional<FoldTarget> target = foldOf(stmt);
      if (target) {
        matches = matches && add(pattern.targets, std::move(*target));
        return;
      }
      forEachOperand(stmt, [&](const ExprPtr& operand) { matches = matches && reads(*operand) == 0; });
    });
    if (!matches || pattern.targets.empty()) return std::nullopt;
    if (!arePlain(body)) return pattern;
    const Overlap overlap = overlapOf(body);
    if (overlap == Overlap::Repeated) return std::nullopt;
    pattern.isPlain = overlap == Overlap::None;
    return pattern;
  }

  bool arePlain(const Block& body) const {
    return foldsAccumulators(kernel_) &&
           std::ranges::all_of(body, [&](const Stmt& stmt) { return isPlain(stmt); });
  }

  bool isPlain(const Stmt& stmt) const {
    const auto* n = std::get_if<Assign>(&stmt.node);
    if (n == nullptr) return false;
    const std::optional<StaticLValue> lvalue = lvalueOf(*n->place);
    if (!lvalue) return false;
    StaticLValue element = *lvalue;
    element.root = counterpartOf(kernel_, lvalue->root, kernel_, ParamRole::Input);
    if (n->op) return isSame(*n->value, element);
    const auto areBoth = [&](const Expr& a, const Expr& b) {
      return (isSame(a, *lvalue) && isSame(b, element)) || (isSame(a, element) && isSame(b, *lvalue));
    };
    const Expr& value = withoutArithmeticConversion(*n->value);
    if (const auto* b = std::get_if<Binary>(&value.node)) return areBoth(*b->lhs, *b->rhs);
    const auto* c = std::get_if<IntrinsicCall>(&value.node);
    return c != nullptr && areBoth(*c->args[0], *c->args[1]);
  }

  enum class Overlap : std::uint8_t { None, InLoop, Repeated };

  /// Whether plain statements fold into the same component by the same operator. An unrolled loop repeats one statement of
  /// the source.
  Overlap overlapOf(const Block& body) const {
    std::vector<FoldTarget> targets;
    for (const Stmt& stmt : body) {
      if (std::optional<FoldTarget> target = foldOf(stmt)) targets.push_back(std::move(*target));
    }
    Overlap overlap = Overlap::None;
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const FoldTarget& a = targets[i];
      for (std::size_t j = 0; j < i; ++j) {
        const FoldTarget& b = targets[j];
        if (a.op != b.op || !a.overlaps(b)) continue;
        if (a.loc.token != b.loc.token || a.loc.line != b.loc.line) return Overlap::Repeated;
        overlap = Overlap::InLoop;
      }
    }
    return overlap;
  }

 private:
  /// The number of times that an expression uses an accumulator.
  int reads(const Expr& expr) const {
    int count = 0;
    walkExprs(expr, [&](const Expr& inner) {
      const auto* n = std::get_if<VarRef>(&inner.node);
      if (n != nullptr && isAccumulator(kernel_, n->var)) ++count;
    });
    return count;
  }

  /// The lvalue if it is part of an accumulator; nullopt for other expressions.
  std::optional<StaticLValue> lvalueOf(const Expr& expr) const {
    std::optional<StaticLValue> lvalue = staticLValue(expr);
    return lvalue && isAccumulator(kernel_, lvalue->root) ? lvalue : std::nullopt;
  }

  const Kernel& kernel_;
};

/// Adds the summands of `place + f - g` except the place itself.
void addSummands(const Expr& value, const StaticLValue& lvalue, bool isNegative, std::vector<Summand>& all) {
  if (isSame(value, lvalue)) return;
  if (!selfFold(value, lvalue)) return all.push_back({&value, isNegative});
  const auto& n = std::get<Binary>(value.node);
  addSummands(*n.lhs, lvalue, isNegative, all);
  addSummands(*n.rhs, lvalue, isNegative != (n.op == BinaryOp::Sub), all);
}

}  // namespace

std::optional<FoldTarget> foldedBy(const Kernel& kernel, const Stmt& stmt) {
  return Recogniser(kernel).foldOf(stmt);
}

bool foldsItsElement(const Kernel& kernel, const Stmt& stmt) { return Recogniser(kernel).isPlain(stmt); }

std::vector<Summand> summandsOf(const Assign& fold) {
  std::vector<Summand> all;
  if (fold.op) {
    all.push_back({fold.value.get(), false});
  } else {
    addSummands(*fold.value, *staticLValue(*fold.place), false, all);
  }
  return all;
}

bool isAccumulator(const Kernel& kernel, VarId var) {
  return var < kernel.params.size() && kernel.params[var].role == ParamRole::Accumulator;
}

VarId counterpartOf(const Kernel& of, VarId accumulator, const Kernel& in, ParamRole role) {
  auto before = std::ranges::count(of.params.begin(), of.params.begin() + accumulator, ParamRole::Accumulator,
                                   &KernelParam::role);
  VarId same = 0;
  while (in.params[same].role != role || before-- > 0) ++same;
  return same;
}

bool foldsAccumulators(const Kernel& kernel) {
  std::vector<Type> inputs, accumulators;
  for (const KernelParam& param : kernel.params) {
    if (param.role == ParamRole::Input) inputs.push_back(param.type);
    if (param.role == ParamRole::Accumulator) accumulators.push_back(param.type);
  }
  return inputs == accumulators;
}

bool foldsElementTwice(const Kernel& kernel, const Function& entry) {
  const Recogniser recogniser(kernel);
  return recogniser.arePlain(entry.body) && recogniser.overlapOf(entry.body) == Recogniser::Overlap::Repeated;
}

std::optional<FoldPattern> recogniseFold(const Kernel& kernel, const Function& entry) {
  return Recogniser(kernel).run(entry.body);
}

namespace {

/// Converts a literal of the arithmetic type to a narrow type.
ExprPtr narrowed(Scalar scalar, ExprPtr value) {
  value->type = Type::of(scalar);
  return value;
}

/// The smallest or largest value of a component type.
ExprPtr extreme(Scalar scalar, bool largest) {
  using Int = std::numeric_limits<std::int32_t>;
  const float infinity = std::numeric_limits<float>::infinity();
  const auto integer = [&](std::int32_t low, std::int32_t high) {
    return narrowed(scalar, literal(largest ? high : low));
  };
  const auto real = [&](float low, float high) { return narrowed(scalar, literal(largest ? high : low)); };
  switch (scalar) {
    case Scalar::Bool: return literal(largest);
    case Scalar::Int: return literal(largest ? Int::max() : Int::min());
    case Scalar::Uint: return literal(largest ? 0xffffffffU : 0U);
    case Scalar::Long:
      return literal(largest ? std::numeric_limits<std::int64_t>::max()
                             : std::numeric_limits<std::int64_t>::min());
    case Scalar::Ulong: return literal(largest ? ~std::uint64_t{0} : std::uint64_t{0});
    case Scalar::Char: return integer(-128, 127);
    case Scalar::Uchar: return integer(0, 255);
    case Scalar::Short: return integer(-32768, 32767);
    case Scalar::Ushort: return integer(0, 65535);
    case Scalar::Unorm8:
    case Scalar::Unorm16: return real(0, 1);
    case Scalar::Snorm8:
    case Scalar::Snorm16: return real(-1, 1);
    case Scalar::Double: return literal(largest ? double{infinity} : -double{infinity});
    case Scalar::Float:
    case Scalar::Half: break;
  }
  return real(-infinity, infinity);
}

/// An integer with all bits set.
ExprPtr allBits(Scalar scalar) {
  const bool isUnsigned = scalar == Scalar::Uchar || scalar == Scalar::Ushort;
  return isUnsigned ? extreme(scalar, true) : literalOf(Type::of(scalar), -1);
}

}  // namespace

ExprPtr neutralOf(FoldOp op, Scalar scalar) {
  if (const auto* intrinsic = std::get_if<Intrinsic>(&op))
    return extreme(scalar, *intrinsic == Intrinsic::Min);
  const Type type = Type::of(scalar);
  const BinaryOp binary = std::get<BinaryOp>(op);
  if (binary == BinaryOp::BitAnd) return allBits(scalar);
  if (binary == BinaryOp::Mul || binary == BinaryOp::LogicalAnd) return literalOf(type, 1);
  return literalOf(type, 0);
}

bool isIdempotent(FoldOp op) {
  if (std::holds_alternative<Intrinsic>(op)) return true;
  const BinaryOp binary = std::get<BinaryOp>(op);
  return binary == BinaryOp::BitAnd || binary == BinaryOp::BitOr || binary == BinaryOp::LogicalAnd ||
         binary == BinaryOp::LogicalOr;
}

bool hasIdentities(const Kernel& kernel) {
  return std::ranges::none_of(kernel.params, [](const KernelParam& param) {
    return param.role == ParamRole::Accumulator && param.identity == nullptr;
  });
}

}  // namespace skc
