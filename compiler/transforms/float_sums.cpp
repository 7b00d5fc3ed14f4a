// SPDX-License-Identifier: MIT
#include "transforms/float_sums.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "ir/build.hpp"
#include "ir/lvalue.hpp"
#include "ir/walk.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

using namespace ir;

namespace {

/// True if a sum and an lvalue share components, such as a struct and its member.
bool overlap(const FloatSum& sum, const StaticLValue& lvalue) {
  if (sum.accumulator != lvalue.root) return false;
  const std::size_t common = std::min(sum.members.size(), lvalue.members.size());
  if (!std::equal(sum.members.begin(), sum.members.begin() + common, lvalue.members.begin())) return false;
  return lvalue.members.size() < sum.members.size() || (sum.components & lvalue.mask()) != 0;
}

/// Collects what one reduce adds to, and which accumulators it reads or writes otherwise.
class Uses {
 public:
  /// `ofParts`: it is a combining reduce, where only unchanged parts that are added count as sums.
  Uses(const Kernel& kernel, const Function& entry, bool ofParts) : kernel_(kernel), ofParts_(ofParts) {
    take(entry.body, false);
  }

  std::vector<FloatSum> sums() const {
    std::vector<FloatSum> result;
    for (const FloatSum& sum : added_) {
      if (std::ranges::none_of(taken_, [&](const StaticLValue& lvalue) { return overlap(sum, lvalue); })) {
        result.push_back(sum);
      }
    }
    return result;
  }

 private:
  void take(const Block& block, bool isHead) {
    for (const Stmt& stmt : block) {
      const std::optional<FoldTarget> target = isHead ? std::nullopt : foldedBy(kernel_, stmt);
      if (target && target->op == FoldOp(BinaryOp::Add) && target->type.isFloat() &&
          (!ofParts_ || foldsItsElement(kernel_, stmt))) {
        add(*target);
      } else {
        forEachOperand(stmt, [&](const ExprPtr& operand) { take(*operand); });
      }
      const auto* loop = std::get_if<Loop>(&stmt.node);
      forEachBlock(stmt, [&](const Block& inner) {
        take(inner, loop != nullptr && (&inner == &loop->init || &inner == &loop->step));
      });
    }
  }

  void take(const Expr& expr) {
    if (const std::optional<StaticLValue> lvalue = staticLValue(expr)) {
      if (isAccumulator(kernel_, lvalue->root)) taken_.push_back(*lvalue);
    } else {
      forEachOperand(expr, [&](const ExprPtr& operand) { take(*operand); });
    }
  }

  void add(const FoldTarget& target) {
    for (FloatSum& sum : added_) {
      if (!sum.isOfMember(target)) continue;
      sum.components |= target.components;
      return;
    }
    added_.push_back(target);
  }

  const Kernel& kernel_;
  const bool ofParts_;
  std::vector<FloatSum> added_;
  std::vector<StaticLValue> taken_;
};

}  // namespace

std::vector<FloatSum> floatSums(const Module& module, KernelId id) {
  const Kernel& kernel = module.kernels[id];
  const Kernel& combine = module.kernels[*kernel.reduction->combine];
  std::vector<FloatSum> sums = Uses(kernel, module.functions[kernel.entry], false).sums();
  const std::vector<FloatSum> combined = Uses(combine, module.functions[combine.entry], true).sums();
  std::erase_if(sums, [&](const FloatSum& sum) {
    const VarId accumulator = counterpartOf(kernel, sum.accumulator, combine, ParamRole::Accumulator);
    return std::ranges::none_of(combined, [&](const FloatSum& other) {
      return other.accumulator == accumulator && other.members == sum.members &&
             (other.components & sum.components) == sum.components;
    });
  });
  std::ranges::sort(sums, {}, [](const FloatSum& sum) { return std::tie(sum.accumulator, sum.members); });
  return sums;
}

namespace {

const Binary* sumOrDifference(const Expr& value) {
  const auto* n = std::get_if<Binary>(&value.node);
  return n != nullptr && (n->op == BinaryOp::Add || n->op == BinaryOp::Sub) ? n : nullptr;
}

const Unary* negation(const Expr& value) {
  const auto* n = std::get_if<Unary>(&value.node);
  return n != nullptr && n->op == UnaryOp::Negate ? n : nullptr;
}

std::optional<Term> product(const Expr& value);

/// One product whose factors `make` combines from those of the values; a value without factors is multiplied
/// by 1. Returns nullopt if no value is a product.
template <class Make>
std::optional<Term> productOf(const std::vector<const Expr*>& values, Make&& make) {
  std::vector<ExprPtr> firsts;
  std::vector<ExprPtr> seconds;
  bool isProduct = false;
  for (const Expr* value : values) {
    std::optional<Term> found = product(*value);
    isProduct = isProduct || found;
    firsts.push_back(found ? std::move(found->value) : clone(*value));
    seconds.push_back(found ? std::move(found->factor) : ofType(value->type, literal(1.0F)));
  }
  if (!isProduct) return std::nullopt;
  return Term{make(std::move(firsts)), make(std::move(seconds))};
}

/// A product of floats or vectors (products of matrices are sums), or a vector or a selection of products.
std::optional<Term> product(const Expr& value) {
  const auto isFactor = [](const ExprPtr& factor) { return factor->type.isFloat(); };
  if (const auto* n = std::get_if<Binary>(&value.node)) {
    if (n->op != BinaryOp::Mul || !isFactor(n->lhs) || !isFactor(n->rhs)) return std::nullopt;
    return Term{ofType(value.type, clone(n->lhs)), ofType(value.type, clone(n->rhs))};
  }
  if (const Unary* n = negation(value)) {
    std::optional<Term> negated = product(*n->operand);
    if (negated) negated->value = unary(UnaryOp::Negate, std::move(negated->value), value.loc);
    return negated;
  }
  if (const auto* n = std::get_if<Construct>(&value.node); n != nullptr && value.type.isFloat()) {
    std::vector<const Expr*> components;
    for (const ExprPtr& arg : n->args) components.push_back(arg.get());
    if (components.size() != value.type.width) return std::nullopt;
    return productOf(components,
                     [&](std::vector<ExprPtr> parts) { return construct(value.type, std::move(parts)); });
  }
  if (const auto* n = std::get_if<Select>(&value.node); n != nullptr && value.type.isFloat()) {
    return productOf({n->yes.get(), n->no.get()}, [&](std::vector<ExprPtr> parts) {
      return select(clone(n->cond), std::move(parts[0]), std::move(parts[1]));
    });
  }
  return std::nullopt;
}

/// A call of the intrinsic on floats, or null.
const IntrinsicCall* callOf(Intrinsic intrinsic, const Expr& value) {
  const auto* n = std::get_if<IntrinsicCall>(&value.node);
  return n != nullptr && n->intrinsic == intrinsic && n->args[0]->type.isFloat() ? n : nullptr;
}

bool hasProduct(const Expr& value) {
  if (const Binary* n = sumOrDifference(value)) return hasProduct(*n->lhs) || hasProduct(*n->rhs);
  if (const Unary* n = negation(value)) return hasProduct(*n->operand);
  return product(value) || callOf(Intrinsic::Dot, value) != nullptr ||
         callOf(Intrinsic::Fma, value) != nullptr;
}

void addTerms(const Expr& value, bool isNegative, std::vector<Term>& terms) {
  const auto add = [&](ExprPtr term, ExprPtr factor) {
    if (isNegative) term = unary(UnaryOp::Negate, std::move(term), value.loc);
    terms.push_back({std::move(term), std::move(factor)});
  };
  if (const Binary* n = sumOrDifference(value)) {
    addTerms(*n->lhs, isNegative, terms);
    addTerms(*n->rhs, isNegative != (n->op == BinaryOp::Sub), terms);
  } else if (const Unary* negated = negation(value)) {
    addTerms(*negated->operand, !isNegative, terms);
  } else if (std::optional<Term> factors = product(value)) {
    add(std::move(factors->value), std::move(factors->factor));
  } else if (const IntrinsicCall* fused = callOf(Intrinsic::Fma, value)) {
    add(clone(fused->args[0]), clone(fused->args[1]));
    addTerms(*fused->args[2], isNegative, terms);
  } else if (const IntrinsicCall* dot = callOf(Intrinsic::Dot, value)) {
    for (unsigned i = 0; i < dot->args[0]->type.width; ++i) {
      add(componentOf(*dot->args[0], i), componentOf(*dot->args[1], i));
    }
  } else {
    add(clone(value), nullptr);
  }
}

}  // namespace

std::vector<Term> termsOf(const Assign& fold) {
  std::vector<Term> terms;
  for (const auto& [value, isNegative] : summandsOf(fold)) {
    if (hasProduct(*value)) {
      addTerms(*value, isNegative, terms);
    } else {
      terms.push_back({isNegative ? unary(UnaryOp::Negate, clone(*value)) : clone(*value), nullptr});
    }
  }
  return terms;
}

std::vector<VarId> inputsOf(const Kernel& reduce, const Term& term) {
  std::vector<VarId> inputs;
  for (const ExprPtr* factor : {&term.value, &term.factor}) {
    if (*factor == nullptr) continue;
    const auto* n = std::get_if<VarRef>(&(*factor)->node);
    if (n == nullptr || n->var >= reduce.params.size()) return {};
    const KernelParam& param = reduce.params[n->var];
    if (param.role != ParamRole::Input || param.held || param.type != Type::of(Scalar::Float)) return {};
    inputs.push_back(n->var);
  }
  return inputs;
}

namespace {

/// The term, if each element only adds one, to one float.
std::optional<Term> termOf(const Module& module, const Kernel& reduce) {
  const Block& body = module.functions[reduce.entry].body;
  const std::optional<FoldTarget> target = body.size() == 1 ? foldedBy(reduce, body[0]) : std::nullopt;
  if (!target || target->op != FoldOp(BinaryOp::Add) ||
      reduce.params[target->accumulator].type != Type::of(Scalar::Float) ||
      std::ranges::count(reduce.params, ParamRole::Accumulator, &KernelParam::role) != 1) {
    return std::nullopt;
  }
  std::vector<Term> terms = termsOf(std::get<Assign>(body[0].node));
  if (terms.size() != 1) return std::nullopt;
  return std::move(terms[0]);
}

/// Whether a factor of a term is a float that a stream holds, at an index of integers.
bool isHeldFloat(const Kernel& reduce, const Expr& factor) {
  if (factor.type != Type::of(Scalar::Float)) return false;
  if (const auto* n = std::get_if<VarRef>(&factor.node)) {
    return n->var < reduce.params.size() && reduce.params[n->var].role == ParamRole::Input &&
           !reduce.params[n->var].held;
  }
  const auto* n = std::get_if<GatherRead>(&factor.node);
  if (n == nullptr || n->stream.space != StreamRef::Space::KernelParameter ||
      reduce.params[n->stream.id].boundary == Boundary::Border || reduce.params[n->stream.id].held) {
    return false;
  }
  bool ofIntegers = true;
  walkExprs(*n->index, [&](const Expr& part) {
    ofIntegers = ofIntegers && !part.type.isFloat() && !std::holds_alternative<Call>(part.node);
  });
  return ofIntegers;
}

}  // namespace

std::vector<VarId> onlyTerm(const Module& module, const Kernel& reduce) {
  const std::optional<Term> term = termOf(module, reduce);
  return term ? inputsOf(reduce, *term) : std::vector<VarId>();
}

bool addsDoubles(const Module& module, const Kernel& reduce) {
  const std::optional<Term> term = termOf(module, reduce);
  return term && isHeldFloat(reduce, *term->value) &&
         (term->factor == nullptr || isHeldFloat(reduce, *term->factor));
}

ExprPtr ofType(Type type, ExprPtr value) {
  return value->type == type ? std::move(value) : construct(type, exprs(std::move(value)));
}

ExprPtr sameComponents(const Function& function, const Expr& place, VarId var, Loc loc) {
  const auto* n = std::get_if<Swizzle>(&place.node);
  return n == nullptr ? varRef(function, var, loc) : swizzle(varRef(function, var, loc), n->components, loc);
}

ExprPtr componentOf(const Expr& value, unsigned component) {
  if (const auto* n = std::get_if<Construct>(&value.node); n != nullptr && n->args[0]->type.isScalar()) {
    if (n->args.size() == 1) return clone(n->args[0]);
    if (n->args.size() == value.type.width) return clone(n->args[component]);
  }
  ExprPtr whole = clone(value);
  if (!value.type.isVector()) return whole;
  return swizzle(std::move(whole), std::string_view("xyzw").substr(component, 1), value.loc);
}

namespace {

/// The component of the added values that goes to the sum; nullopt if none does.
std::optional<unsigned> componentIn(const Kernel& reduce, const Stmt& stmt, const ScalarSum& sum) {
  const std::optional<FoldTarget> target = foldedBy(reduce, stmt);
  const bool isOfSum =
      target && sum.whole.overlaps(*target) && (target->components >> sum.component & 1U) != 0;
  if (!isOfSum) return std::nullopt;
  const auto* swizzled = std::get_if<Swizzle>(&std::get<Assign>(stmt.node).place->node);
  if (swizzled == nullptr) return sum.component;
  unsigned place = 0;
  while (swizzled->components[place] != sum.component) ++place;
  return place;
}

}  // namespace

std::vector<Term> termsOf(const Kernel& reduce, const Stmt& stmt, const ScalarSum& sum) {
  const std::optional<unsigned> component = componentIn(reduce, stmt, sum);
  if (!component) return {};
  std::vector<Term> terms = termsOf(std::get<Assign>(stmt.node));
  for (Term& term : terms) {
    term.value = componentOf(*term.value, *component);
    if (term.factor) term.factor = componentOf(*term.factor, *component);
  }
  return terms;
}

}  // namespace skc
