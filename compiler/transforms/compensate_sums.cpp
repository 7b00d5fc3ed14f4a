// SPDX-License-Identifier: MIT
#include "transforms/compensate_sums.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "transforms/combine_part.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"
#include "transforms/made_kernel.hpp"
#include "transforms/sum_terms.hpp"

namespace skc {
namespace {

using namespace ir;

bool isAccumulator(const KernelParam& param) { return param.role == ParamRole::Accumulator; }

/// Whether everything that a fold does to an accumulator is to add to the whole of it.
bool isSum(const FoldPattern& pattern, VarId accumulator) {
  return std::ranges::all_of(pattern.parts, [&](const FoldPart& part) {
    return part.accumulator != accumulator || (part.isWhole() && part.op == FoldOp(BinaryOp::Add));
  });
}

/// The accumulators that are sums of floats; none where the reduce has no second form.
std::vector<VarId> sumsOf(const Module& module, KernelId id, const FoldPattern& pattern) {
  const Kernel& kernel = module.kernels[id];
  const KernelId combine = *kernel.reduction->combine;
  if (combine != id && !module.kernels[combine].isMade) return {};   // the author's
  if (foldsInLoopHead(kernel, module.functions[kernel.entry])) return {};
  std::vector<VarId> sums;
  for (VarId i = 0; i < kernel.params.size(); ++i) {
    const KernelParam& param = kernel.params[i];
    if (!isAccumulator(param)) continue;
    if (!param.identity) return {};   // runs start from it, since their first element is no pair of sums
    if (param.type.isFloat() && isSum(pattern, i)) sums.push_back(i);
  }
  return sums;
}

ExprPtr everywhere(Type type, float value) {
  return type.isScalar() ? literal(value) : construct(type, exprs(literal(value)));
}

/// total_lost += sumError(total, term); total = roundedSum(total, term)
void addTo(Block& body, const Function& function, VarId total, VarId lost, VarId term) {
  const auto both = [&] { return exprs(varRef(function, total), varRef(function, term)); };
  body.push_back(assign(varRef(function, lost), BinaryOp::Add, intrinsic(Intrinsic::SumError, both())));
  body.push_back(assign(varRef(function, total), intrinsic(Intrinsic::RoundedSum, both())));
}

/// The same place of another variable.
ExprPtr inVariable(const Expr& place, VarId var) {
  ExprPtr copy = clone(place);
  walkExprs(*copy, [&](Expr& expr) {
    if (auto* n = std::get_if<VarRef>(&expr.node)) n->var = var;
  });
  return copy;
}

/// A scalar that is added to a vector is so to each component.
ExprPtr ofType(Type type, ExprPtr value) {
  return value->type == type ? std::move(value) : construct(type, exprs(std::move(value)));
}

/// place_lost += sumError(place, value) + productError(value, factor); place = roundedSum(place, value * factor)
void addTerm(Block& body, Function& function, const Expr& place, VarId lost, Term term) {
  const Type type = place.type;
  ExprPtr value = ofType(type, std::move(term.value));
  ExprPtr error;
  if (term.factor) {
    ExprPtr factor = ofType(type, std::move(term.factor));
    error = intrinsic(Intrinsic::ProductError, exprs(clone(value), clone(factor)));
    value = intrinsic(Intrinsic::RoundedProduct, exprs(std::move(value), std::move(factor)));
  }
  if (!std::holds_alternative<VarRef>(value->node)) {
    const std::string name = "term_" + std::to_string(function.variables.size());
    const VarId local = addVariable(function, name, type);
    body.push_back(declare(local, std::move(value)));
    value = varRef(function, local);
  }
  ExprPtr sumError = intrinsic(Intrinsic::SumError, exprs(clone(place), clone(value)));
  if (error) sumError = binary(BinaryOp::Add, std::move(sumError), std::move(error));
  body.push_back(assign(inVariable(place, lost), BinaryOp::Add, std::move(sumError)));
  body.push_back(
      assign(clone(place), intrinsic(Intrinsic::RoundedSum, exprs(clone(place), std::move(value)))));
}

KernelParam like(const KernelParam& param, std::string name, ParamRole role) {
  return makeParam(std::move(name), role, param.type, param.loc);
}

class Maker {
 public:
  Maker(Module& module, KernelId id, const FoldPattern& pattern, std::vector<VarId> sums)
      : module_(module), id_(id), pattern_(pattern), sums_(std::move(sums)) {}

  void make() {
    const KernelId fold = makeFold(makeCombination());
    const KernelId finish = makeFinish();
    module_.kernels[id_].reduction->compensated = Compensated{fold, finish, sums_};
  }

 private:
  const Kernel& kernel() const { return module_.kernels[id_]; }
  bool isSum(VarId param) const { return std::ranges::find(sums_, param) != sums_.end(); }

  KernelId makeFold(KernelId combine) {
    FoldCopy copy(module_, id_, "_compensated");
    std::vector<VarId> lost;
    for (const VarId i : sums_) {
      KernelParam& param = copy.param(i);
      // where the plain form starts with its first element, so does -0 + element
      if (kernel().reduction->seeded) param.identity = everywhere(param.type, -0.0F);
      lost.push_back(copy.addAccumulator(param.name + "_lost", param.type, everywhere(param.type, 0.0F)));
    }
    rewrite(copy.entry(), copy.entry().body, lost);
    return copy.finish(combine);
  }

  /// Sums what is lost beside what is added.
  void rewrite(Function& entry, Block& block, const std::vector<VarId>& lost) const {
    Block made;
    for (Stmt& stmt : block) {
      forEachBlock(stmt, [&](Block& inner) { rewrite(entry, inner, lost); });
      const std::optional<FoldPart> part = foldedBy(kernel(), stmt);
      if (!part || !isSum(part->accumulator)) {
        made.push_back(std::move(stmt));
        continue;
      }
      const auto& fold = std::get<Assign>(stmt.node);
      const auto k = static_cast<std::size_t>(std::ranges::find(sums_, part->accumulator) - sums_.begin());
      for (Term& term : termsOf(fold)) addTerm(made, entry, *fold.place, lost[k], std::move(term));
    }
    block = std::move(made);
  }

  /// Inputs and accumulators of the fold's types and order.
  KernelId makeCombination() {
    MadeKernel made(kernel(), "_combine");
    std::vector<VarId> parts;
    std::vector<VarId> totals;
    for (const ParamRole role : {ParamRole::Input, ParamRole::Accumulator}) {
      const std::string suffix = role == ParamRole::Input ? "_part" : "";
      std::vector<VarId>& list = role == ParamRole::Input ? parts : totals;
      for (const KernelParam& param : kernel().params) {
        if (isAccumulator(param)) list.push_back(made.add(like(param, param.name + suffix, role)));
      }
      for (const VarId i : sums_) {
        const KernelParam& param = kernel().params[i];
        list.push_back(made.add(like(param, param.name + "_lost" + suffix, role)));
      }
    }
    std::vector<VarId> accumulators;  // of the plain form, which come first in each list
    for (VarId i = 0; i < kernel().params.size(); ++i) {
      if (isAccumulator(kernel().params[i])) accumulators.push_back(i);
    }
    const auto placeOf = [&](VarId accumulator) {
      return static_cast<std::size_t>(std::ranges::find(accumulators, accumulator) - accumulators.begin());
    };
    for (const FoldPart& part : pattern_.parts) {
      if (isSum(part.accumulator)) continue;
      const std::size_t k = placeOf(part.accumulator);
      made.entry.body.push_back(combinePart(module_, made.entry, part, parts[k], totals[k]));
    }
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const std::size_t sum = placeOf(sums_[k]);
      const std::size_t lost = accumulators.size() + k;
      made.entry.body.push_back(
          assign(varRef(made.entry, totals[lost]), BinaryOp::Add, varRef(made.entry, parts[lost])));
      addTo(made.entry.body, made.entry, totals[sum], totals[lost], parts[sum]);
    }
    return made.finishCombination(module_);
  }

  KernelId makeFinish() {
    MadeKernel made(kernel(), "_finish");
    std::vector<VarId> inputs;
    for (const VarId i : sums_) {
      const KernelParam& param = kernel().params[i];
      inputs.push_back(made.add(like(param, param.name, ParamRole::Input)));
      inputs.push_back(made.add(like(param, param.name + "_lost", ParamRole::Input)));
    }
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const KernelParam& param = kernel().params[sums_[k]];
      const VarId result = made.add(like(param, "r_" + param.name, ParamRole::Output));
      const auto total = [&] { return varRef(made.entry, inputs[2 * k]); };
      const auto lost = [&] { return varRef(made.entry, inputs[2 * k + 1]); };
      // a sum that is not finite has lost NaN; and where nothing is lost, -0 stays
      ExprPtr isNothing = binary(BinaryOp::Equal, lost(), everywhere(param.type, 0.0F));
      ExprPtr sum = select(std::move(isNothing), total(), binary(BinaryOp::Add, total(), lost()));
      made.entry.body.push_back(
          assign(varRef(made.entry, result),
                 select(intrinsic(Intrinsic::Isfinite, exprs(lost())), std::move(sum), total())));
    }
    return made.finish(module_);
  }

  Module& module_;
  KernelId id_;
  const FoldPattern& pattern_;
  std::vector<VarId> sums_;
};

}  // namespace

void compensateSums(Module& module, Diagnostics&) {
  const std::size_t declared = module.kernels.size();  // before those that this adds
  for (KernelId id = 0; id < declared; ++id) {
    const Kernel& kernel = module.kernels[id];
    if (!kernel.reduction || kernel.isMade) continue;
    const std::optional<FoldPattern> pattern = recogniseFold(kernel, module.functions[kernel.entry]);
    if (!pattern) continue;
    std::vector<VarId> sums = sumsOf(module, id, *pattern);
    if (!sums.empty()) Maker(module, id, *pattern, std::move(sums)).make();
  }
}

}  // namespace skc
