// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "ir/walk_module.hpp"
#include "transforms/check_limits.hpp"
#include "transforms/float_sums.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"
#include "transforms/synthesized_kernel.hpp"

namespace skc {
namespace {

using namespace ir;

ExprPtr everywhere(Type type, float value) {
  return type.isScalar() ? literal(value) : construct(type, exprs(literal(value)));
}

/// The components that `place` selects, taken from `var`.
ExprPtr inVariable(const Function& function, const Expr& place, VarId var) {
  ExprPtr whole = varRef(function, var);
  const auto* n = std::get_if<Swizzle>(&place.node);
  if (n == nullptr) return whole;
  return swizzle(std::move(whole), n->components);
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
  body.push_back(assign(inVariable(function, place, errorTotal), BinaryOp::Add, std::move(sumError)));
  body.push_back(
      assign(clone(place), intrinsic(Intrinsic::RoundedSum, exprs(clone(place), std::move(value)))));
}

/// The accumulators that hold the rounding errors of a reduce's sums, one per sum; a combining reduce also
/// has inputs with the errors of its parts.
struct RoundingErrors {
  std::vector<FloatSum> sums;
  std::vector<VarId> totals, parts;
};

/// Adds statements that sum the rounding errors of additions.
void addRoundingErrors(const Kernel& kernel, Function& entry, Block& block, const RoundingErrors& errors) {
  Block rewritten;
  for (Stmt& stmt : block) {
    forEachBlock(stmt, [&](Block& inner) { addRoundingErrors(kernel, entry, inner, errors); });
    const std::optional<FoldTarget> target = foldedBy(kernel, stmt);
    const auto sum = std::ranges::find_if(
        errors.sums, [&](const FloatSum& one) { return target && one.overlaps(*target); });
    if (sum == errors.sums.end()) {
      rewritten.push_back(std::move(stmt));
      continue;
    }
    const auto& fold = std::get<Assign>(stmt.node);
    const auto k = static_cast<std::size_t>(sum - errors.sums.begin());
    if (!errors.parts.empty()) {
      rewritten.push_back(assign(inVariable(entry, *fold.place, errors.totals[k]), BinaryOp::Add,
                                 inVariable(entry, *fold.place, errors.parts[k])));
    }
    for (Term& term : termsOf(fold))
      addTerm(rewritten, entry, *fold.place, errors.totals[k], std::move(term));
  }
  block = std::move(rewritten);
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

class CompensatedVariantBuilder {
 public:
  CompensatedVariantBuilder(Module& module, KernelId id, std::vector<FloatSum> sums)
      : module_(module), id_(id), sums_(std::move(sums)) {}

  void make() {
    const KernelId fold = makeFold(makeCombination());
    const KernelId finish = makeFinish();
    Compensated compensated{fold, finish, {}, {}};
    if (kernel().reduction->commutative && !foldsBesideOutputs(kernel())) {
      compensated.term = onlyTerm(module_, kernel());
      compensated.addsDoubles = addsDoubles(module_, kernel());
    }
    compensated.sums = sums_;
    module_.kernels[fold].reduction->commutative = module_.kernels[id_].reduction->commutative;
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

  KernelId makeFold(KernelId combine) {
    FoldCopy copy(module_, id_, "_compensated");
    RoundingErrors errors{sums_, {}, {}};
    for (const FloatSum& sum : sums_) {
      // if the plain variant starts with its first element, this one starts with -0 + element
      if (kernel().reduction->seeded) startFromNegativeZero(copy.param(sum.accumulator).identity, sum);
      errors.totals.push_back(copy.addAccumulator(errorName(sum), sum.type, everywhere(sum.type, 0.0F)));
    }
    addRoundingErrors(kernel(), copy.entry(), copy.entry().body, errors);
    return copy.finish(combine);
  }

  /// Extends the plain variant's combining reduce, which adds the errors of its parts as well.
  KernelId makeCombination() {
    const KernelId plain = *kernel().reduction->combine;
    FoldCopy copy(module_, plain, plain == id_ ? "_combine" : "_compensated");
    RoundingErrors errors;
    for (const FloatSum& sum : sums_) {
      errors.sums.push_back(sum);
      errors.sums.back().accumulator = sameAccumulator(kernel(), sum.accumulator, module_.kernels[plain]);
      errors.parts.push_back(copy.addInput(errorName(sum) + "_part", sum.type));
      errors.totals.push_back(copy.addAccumulator(errorName(sum), sum.type));
    }
    addRoundingErrors(module_.kernels[plain], copy.entry(), copy.entry().body, errors);
    return copy.finishCombination();
  }

  KernelId makeFinish() {
    SynthesizedKernel synthesized(kernel(), "_finish");
    std::vector<VarId> accumulators;  // of the plain variant, each once
    for (const FloatSum& sum : sums_) {
      if (accumulators.empty() || accumulators.back() != sum.accumulator) {
        accumulators.push_back(sum.accumulator);
      }
    }
    const auto add = [&](VarId accumulator, std::string_view prefix, ParamRole role) {
      const KernelParam& param = kernel().params[accumulator];
      return synthesized.add(makeParam(std::string(prefix) + param.name, role, param.type, param.loc));
    };
    std::vector<VarId> inputs, errors, results;
    for (const VarId i : accumulators) inputs.push_back(add(i, "", ParamRole::Input));
    for (const FloatSum& sum : sums_) {
      errors.push_back(synthesized.add(makeParam(errorName(sum), ParamRole::Input, sum.type, kernel().loc)));
    }
    for (const VarId i : accumulators) results.push_back(add(i, "r_", ParamRole::Output));
    Block& body = synthesized.entry.body;
    for (std::size_t i = 0; i < accumulators.size(); ++i) {
      const bool hasMembers = synthesized.kernel.params[inputs[i]].type.kind == Type::Kind::Struct;
      if (hasMembers)
        body.push_back(assign(varRef(synthesized.entry, results[i]), varRef(synthesized.entry, inputs[i])));
    }
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      const auto i = static_cast<std::size_t>(std::ranges::find(accumulators, sums_[k].accumulator) -
                                              accumulators.begin());
      body.push_back(assign(member(module_, varRef(synthesized.entry, results[i]), sums_[k].members),
                            finished(member(module_, varRef(synthesized.entry, inputs[i]), sums_[k].members),
                                     synthesized.entry, errors[k])));
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
};

}  // namespace

namespace {

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
    CompensatedVariantBuilder(module, id, std::move(sums)).make();
  });
}

}  // namespace skc
