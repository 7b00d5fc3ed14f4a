// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "transforms/check_limits.hpp"
#include "transforms/float_sums.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {
namespace {

using namespace ir;

ExprPtr everywhere(Type type, float value) {
  return type.isScalar() ? literal(value) : construct(type, exprs(literal(value)));
}

/// place_lost += sumError(place, value) + productError(value, factor); place = roundedSum(place, value * factor)
void addTerm(Block& body, Function& function, const Expr& place, VarId errorTotal, Term term) {
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
  body.push_back(assign(sameComponents(function, place, errorTotal), BinaryOp::Add, std::move(sumError)));
  body.push_back(
      assign(clone(place), intrinsic(Intrinsic::RoundedSum, exprs(clone(place), std::move(value)))));
}

/// Replaces a sum's components of a synthesized identity, which constructs structs member by member, by -0.
void startFromNegativeZero(ExprPtr& identity, const FloatSum& sum) {
  ExprPtr* slot = &identity;
  for (const std::uint32_t field : sum.members) slot = &std::get<Construct>((*slot)->node).args[field];
  if (sum.isWhole()) {
    *slot = everywhere(sum.type, -0.0F);
    return;
  }
  for (unsigned i = 0; i < sum.type.width; ++i) {
    if ((sum.components >> i & 1U) != 0) std::get<Construct>((*slot)->node).args[i] = literal(-0.0F);
  }
}

/// Holds a sum in its own accumulator and one for the rounding errors.
class CompensatedVariant : SumRepresentation {
 public:
  CompensatedVariant(Module& module, KernelId id, std::vector<FloatSum> sums)
      : module_(module), id_(id), sums_(std::move(sums)), totals_(sums_.size()), parts_(sums_.size()) {}

  void make() {
    const KernelId fold = makeSumVariant(module_, id_, sums_, "_compensated", *this);
    const KernelId finish = makeFinish();
    Compensated compensated{fold, finish, sums_};
    if (kernel().reduction->commutative && !foldsBesideOutputs(kernel())) {
      compensated.term = onlyTerm(module_, kernel());
      compensated.addsDoubles = addsDoubles(module_, kernel());
    }
    module_.kernels[id_].reduction->compensated = std::move(compensated);
  }

 private:
  const Kernel& kernel() const { return module_.kernels[id_]; }

  /// "m_sum_lost" of m.sum.
  std::string errorName(const FloatSum& sum) const {
    const KernelParam& param = kernel().params[sum.accumulator];
    std::string name = param.name;
    Type type = param.type;
    for (const std::uint32_t field : sum.members) {
      const StructField& member = module_.structs[type.index].fields[field];
      name += "_" + member.name;
      type = member.type;
    }
    return name + "_lost";
  }

  void hold(FoldCopy& copy, const FloatSum& sum, std::size_t k, bool ofParts) override {
    const std::string name = errorName(sums_[k]);
    if (ofParts) parts_[k] = copy.add(name + "_part", ParamRole::Input, sum.type);
    // if the plain variant starts with its first element, this one starts with -0 + element
    if (!ofParts && kernel().reduction->seeded)
      startFromNegativeZero(copy.param(sum.accumulator).identity, sum);
    totals_[k] = copy.add(name, ParamRole::Accumulator, sum.type, everywhere(sum.type, 0.0F));
  }

  void add(Function& entry, const Stmt& fold, std::size_t k, bool ofParts, Block& to) override {
    const auto& n = std::get<Assign>(fold.node);
    if (ofParts) {
      to.push_back(assign(sameComponents(entry, *n.place, totals_[k]), BinaryOp::Add,
                          sameComponents(entry, *n.place, parts_[k])));
    }
    for (Term& term : termsOf(n)) addTerm(to, entry, *n.place, totals_[k], std::move(term));
  }

  KernelId makeFinish() {
    SynthesizedKernel synthesized(kernel(), "_finish");
    Function& entry = synthesized.entry;
    std::vector<VarId> accumulators;  // each once
    for (const FloatSum& sum : sums_) {
      if (accumulators.empty() || accumulators.back() != sum.accumulator)
        accumulators.push_back(sum.accumulator);
    }
    const std::vector<VarId> inputs = synthesized.addEach(kernel(), accumulators, ParamRole::Input, "", "");
    std::vector<VarId> errors;
    for (const FloatSum& sum : sums_)
      errors.push_back(synthesized.add(makeParam(errorName(sum), ParamRole::Input, sum.type, kernel().loc)));
    const std::vector<VarId> results =
        synthesized.addEach(kernel(), accumulators, ParamRole::Output, "r_", "");
    for (std::size_t i = 0; i < accumulators.size(); ++i) {
      if (kernel().params[accumulators[i]].type.kind == Type::Kind::Struct)
        entry.body.push_back(assign(varRef(entry, results[i]), varRef(entry, inputs[i])));
    }
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const auto sumIn = [&](const std::vector<VarId>& variables) {
        const auto i = std::ranges::find(accumulators, sums_[k].accumulator) - accumulators.begin();
        return member(module_, varRef(entry, variables[i]), sums_[k].members);
      };
      entry.body.push_back(assign(sumIn(results), finished(sumIn(inputs), entry, errors[k])));
    }
    return synthesized.finish(module_);
  }

  /// Adds a sum's error. Keeps the sum if it is not finite, as its error is NaN; keeps -0 if the error is 0.
  static ExprPtr finished(ExprPtr total, const Function& entry, VarId errorVariable) {
    const auto error = [&] { return varRef(entry, errorVariable); };
    ExprPtr isExact = binary(BinaryOp::Equal, error(), everywhere(total->type, 0.0F));
    ExprPtr sum = binary(BinaryOp::Add, clone(total), error());
    sum = select(std::move(isExact), clone(total), std::move(sum));
    return select(intrinsic(Intrinsic::Isfinite, exprs(error())), std::move(sum), std::move(total));
  }

  Module& module_;
  KernelId id_;
  std::vector<FloatSum> sums_;
  std::vector<VarId> totals_, parts_;  ///< of the rounding errors of each sum, in the copy being built
};

/// True if the kernels of the variant can be described: each sum adds an accumulator to the fold, and two parameters to
/// the kernel that combines results.
bool variantFits(const Module& module, KernelId id, const std::vector<FloatSum>& sums) {
  const Kernel& kernel = module.kernels[id];
  const auto withErrors = [&](const Kernel& plain, std::size_t each) {
    KernelSize size = sizeOf(module, plain);
    size.parameters += each * sums.size();
    size.reads += (each - 1) * sums.size();
    size.planes += each * sums.size();
    return size;
  };
  return fits(withErrors(kernel, 1)) && fits(withErrors(module.kernels[*kernel.reduction->combine], 2));
}

}  // namespace

void compensateSums(Module& module, Diagnostics& diagnostics) {
  forEachDeclaredKernel(module, [&](KernelId id) {
    const Kernel& kernel = module.kernels[id];
    // Runs of this variant start from identities, because a first element has no error to start with.
    if (!kernel.reduction || kernel.isSynthesized || !hasIdentities(kernel)) return;
    std::vector<FloatSum> sums = floatSums(module, id);
    if (sums.empty()) return;
    if (!variantFits(module, id, sums)) {
      diagnostics.report(Diag::SumsNotCompensated, kernel.loc, {kernel.name, std::to_string(sums.size())});
      return;
    }
    CompensatedVariant(module, id, std::move(sums)).make();
  });
}

}  // namespace skc
