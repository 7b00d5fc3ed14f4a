// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "transforms/float_sums.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {
namespace {

using namespace ir;

/// A constant as a double; literals stay literals.
ExprPtr inDouble(ExprPtr value) {
  if (const auto* n = std::get_if<Literal>(&value->node))
    return literal(double{std::bit_cast<float>(n->bits)}, value->loc);
  return convert(Scalar::Double, std::move(value));
}

class DoubleSums : SumRepresentation {
 public:
  DoubleSums(Module& module, KernelId id, std::vector<FloatSum> sums)
      : module_(module), id_(id), sums_(std::move(sums)) {}

  void make() {
    const KernelId fold = makeSumVariant(module_, id_, sums_, "_doubles", *this);
    const KernelId finish = makeFinish();
    Reduction& reduction = *module_.kernels[fold].reduction;
    reduction.finish = finish;
    for (const KernelId made : {fold, finish, *reduction.combine}) module_.kernels[made].isNativeOnly = true;
    module_.kernels[id_].parts->inDoubles = fold;
  }

 private:
  const Kernel& kernel() const { return module_.kernels[id_]; }

  void hold(FoldCopy& copy, const FloatSum& sum, std::size_t, bool ofParts) override {
    widen(copy, sum.accumulator);
    if (!ofParts) return;
    const Kernel& combine = module_.kernels[*kernel().reduction->combine];
    widen(copy, counterpartOf(combine, sum.accumulator, combine, ParamRole::Input));
    const Function& entry = copy.entry();
    walkExprs(copy.entry().body, [&](Expr& expr) {
      if (const auto* n = std::get_if<VarRef>(&expr.node)) expr.type = entry.variables[n->var].type;
    });
  }

  static void widen(FoldCopy& copy, VarId var) {
    KernelParam& param = copy.param(var);
    copy.entry().variables[var].type = param.type = param.type.withScalar(Scalar::Double);
    if (param.identity) param.identity = inDouble(std::move(param.identity));
  }

  void add(Function& entry, const Stmt& stmt, std::size_t, bool, Block& to) override {
    const auto& fold = std::get<Assign>(stmt.node);
    const auto wide = [&](ExprPtr value) {
      return convert(Scalar::Double, ofType(fold.place->type, std::move(value)));
    };
    for (Term& term : termsOf(fold)) {
      ExprPtr value = wide(std::move(term.value));
      if (term.factor) value = binary(BinaryOp::Mul, std::move(value), wide(std::move(term.factor)));
      to.push_back(assign(sameComponents(entry, *fold.place, rootOf(*fold.place), fold.place->loc),
                          BinaryOp::Add, std::move(value), stmt.loc));
    }
  }

  KernelId makeFinish() {
    SynthesizedKernel synthesized(kernel(), "_finish");
    Function& entry = synthesized.entry;
    const std::vector<VarId> accumulators = paramsOf(kernel(), ParamRole::Accumulator);
    const std::vector<VarId> inputs =
        synthesized.addEach(kernel(), accumulators, ParamRole::Input, "", "", [&](VarId i) {
          const bool isSum = std::ranges::find(sums_, i, &FloatSum::accumulator) != sums_.end();
          return isSum ? kernel().params[i].type.withScalar(Scalar::Double) : kernel().params[i].type;
        });
    const std::vector<VarId> results =
        synthesized.addEach(kernel(), accumulators, ParamRole::Output, "r_", "");
    for (std::size_t i = 0; i < results.size(); ++i) {
      ExprPtr value = varRef(entry, inputs[i]);
      if (value->type != entry.variables[results[i]].type) value = convert(Scalar::Float, std::move(value));
      entry.body.push_back(assign(varRef(entry, results[i]), std::move(value)));
    }
    return synthesized.finish(module_);
  }

  Module& module_;
  KernelId id_;
  std::vector<FloatSum> sums_;
};

}  // namespace

void sumInDoubles(Module& module, Diagnostics&) {
  forEachDeclaredKernel(module, [&](KernelId id) {
    const Kernel& kernel = module.kernels[id];
    if (!kernel.parts || !kernel.reduction->compensated || kernel.isSynthesized) return;
    // of an accumulator that is such a sum as a whole, there is no other use (floatSums)
    const std::vector<FloatSum>& sums = kernel.reduction->compensated->sums;
    const bool areWhole =
        std::ranges::all_of(sums, [](const FloatSum& sum) { return sum.members.empty() && sum.isWhole(); });
    if (areWhole) DoubleSums(module, id, sums).make();
  });
}

}  // namespace skc
