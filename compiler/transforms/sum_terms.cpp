// SPDX-License-Identifier: MIT
#include "transforms/sum_terms.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {
namespace {

using namespace ir;

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

const IntrinsicCall* dotProduct(const Expr& value) {
  const auto* n = std::get_if<IntrinsicCall>(&value.node);
  return n != nullptr && n->intrinsic == Intrinsic::Dot && n->args[0]->type.isFloat() ? n : nullptr;
}

const IntrinsicCall* fusedProduct(const Expr& value) {
  const auto* n = std::get_if<IntrinsicCall>(&value.node);
  return n != nullptr && n->intrinsic == Intrinsic::Fma && n->args[0]->type.isFloat() ? n : nullptr;
}

bool hasProduct(const Expr& value) {
  if (const Binary* n = sumOrDifference(value)) return hasProduct(*n->lhs) || hasProduct(*n->rhs);
  if (const Unary* n = negation(value)) return hasProduct(*n->operand);
  return product(value) || dotProduct(value) != nullptr || fusedProduct(value) != nullptr;
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
  } else if (const IntrinsicCall* fused = fusedProduct(value)) {
    add(clone(fused->args[0]), clone(fused->args[1]));
    addTerms(*fused->args[2], isNegative, terms);
  } else if (const IntrinsicCall* dot = dotProduct(value)) {
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
  const std::optional<FoldPart> part = body.size() == 1 ? foldedBy(reduce, body[0]) : std::nullopt;
  if (!part || part->op != FoldOp(BinaryOp::Add) ||
      reduce.params[part->accumulator].type != Type::of(Scalar::Float) ||
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

ExprPtr componentOf(const Expr& value, unsigned component) {
  if (const auto* n = std::get_if<Construct>(&value.node); n != nullptr && n->args[0]->type.isScalar()) {
    if (n->args.size() == 1) return clone(n->args[0]);
    if (n->args.size() == value.type.width) return clone(n->args[component]);
  }
  ExprPtr whole = clone(value);
  if (!value.type.isVector()) return whole;
  return swizzle(std::move(whole), std::string_view("xyzw").substr(component, 1), value.loc);
}

}  // namespace skc
