// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "ir/walk_module.hpp"
#include "transforms/float_sums.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"
#include "transforms/synthesized_kernel.hpp"

namespace skc {
namespace {

using namespace ir;

Type widened(Type type) { return type.withScalar(Scalar::Double); }

/// A constant as a double; literals stay literals.
ExprPtr inDouble(ExprPtr value) {
  if (const auto* n = std::get_if<Literal>(&value->node))
    return literal(double{std::bit_cast<float>(n->bits)}, value->loc);
  return convert(Scalar::Double, std::move(value));
}

class DoubleSummation {
 public:
  DoubleSummation(Module& module, KernelId id, std::vector<FloatSum> sums)
      : module_(module), id_(id), sums_(std::move(sums)) {}

  void make() {
    const KernelId combine = makeCombination();
    const KernelId finish = makeFinish();
    FoldCopy copy(module_, id_, "_doubles");
    for (const FloatSum& sum : sums_) {
      KernelParam& param = copy.param(sum.accumulator);
      if (param.identity) param.identity = inDouble(std::move(param.identity));
      widen(copy, sum.accumulator);
    }
    addInDoubles(module_.kernels[id_], copy.entry(), copy.entry().body, sums_);
    const KernelId fold = copy.finish(combine);
    Kernel& made = module_.kernels[fold];
    made.isNativeOnly = true;
    made.reduction->finish = finish;
    made.reduction->commutative = kernel().reduction->commutative;
    module_.kernels[id_].parts->inDoubles = fold;
  }

 private:
  const Kernel& kernel() const { return module_.kernels[id_]; }

  static void widen(FoldCopy& copy, VarId var) {
    copy.param(var).type = widened(copy.param(var).type);
    copy.entry().variables[var].type = copy.param(var).type;
  }

  /// Replaces statements that add floats to a sum by additions of doubles.
  static void addInDoubles(const Kernel& kernel, Function& entry, Block& block,
                           const std::vector<FloatSum>& sums) {
    Block rewritten;
    for (Stmt& stmt : block) {
      forEachBlock(stmt, [&](Block& inner) { addInDoubles(kernel, entry, inner, sums); });
      const std::optional<FoldTarget> target = foldedBy(kernel, stmt);
      const auto sum =
          std::ranges::find_if(sums, [&](const FloatSum& one) { return target && one.overlaps(*target); });
      if (sum == sums.end()) {
        rewritten.push_back(std::move(stmt));
        continue;
      }
      const auto& fold = std::get<Assign>(stmt.node);
      for (Term& term : termsOf(fold)) {
        const auto wide = [&](ExprPtr value) {
          ExprPtr whole = ofType(fold.place->type, std::move(value));
          return whole->type.isDouble() ? std::move(whole) : convert(Scalar::Double, std::move(whole));
        };
        ExprPtr value = wide(std::move(term.value));
        if (term.factor) value = binary(BinaryOp::Mul, std::move(value), wide(std::move(term.factor)));
        rewritten.push_back(assign(placeIn(entry, *fold.place), BinaryOp::Add, std::move(value), stmt.loc));
      }
    }
    block = std::move(rewritten);
  }

  /// The place that is a sum, or components of one, whose variable has become a double.
  static ExprPtr placeIn(const Function& entry, const Expr& place) {
    ExprPtr whole = varRef(entry, rootOf(place), place.loc);
    const auto* n = std::get_if<Swizzle>(&place.node);
    if (n == nullptr) return whole;
    return swizzle(std::move(whole), n->components, place.loc);
  }

  /// The combining reduce adds partial results, which are doubles, too.
  KernelId makeCombination() {
    const KernelId plain = *kernel().reduction->combine;
    FoldCopy copy(module_, plain, "_doubles");
    std::vector<FloatSum> sums;
    for (const FloatSum& sum : sums_) {
      sums.push_back(sum);
      sums.back().accumulator = sameAccumulator(kernel(), sum.accumulator, module_.kernels[plain]);
      widen(copy, sums.back().accumulator);
      widen(copy, elementOf(module_.kernels[plain], sums.back().accumulator));
    }
    const Function& entry = copy.entry();
    walkExprs(copy.entry().body, [&](Expr& expr) {
      if (const auto* n = std::get_if<VarRef>(&expr.node)) expr.type = entry.variables[n->var].type;
    });
    addInDoubles(module_.kernels[plain], copy.entry(), copy.entry().body, sums);
    const KernelId made = copy.finishCombination();
    module_.kernels[made].isNativeOnly = true;
    return made;
  }

  KernelId makeFinish() {
    SynthesizedKernel synthesized(kernel(), "_finish");
    synthesized.kernel.isNativeOnly = true;
    std::vector<VarId> inputs;
    for (const bool isResult : {false, true}) {
      std::size_t next = 0;
      for (VarId i = 0; i < kernel().params.size(); ++i) {
        const KernelParam& accumulator = kernel().params[i];
        if (accumulator.role != ParamRole::Accumulator) continue;
        const bool isSum = std::ranges::find(sums_, i, &FloatSum::accumulator) != sums_.end();
        if (!isResult) {
          const Type type = isSum ? widened(accumulator.type) : accumulator.type;
          inputs.push_back(
              synthesized.add(makeParam(accumulator.name, ParamRole::Input, type, accumulator.loc)));
          continue;
        }
        const VarId result = synthesized.add(
            makeParam("r_" + accumulator.name, ParamRole::Output, accumulator.type, accumulator.loc));
        ExprPtr value = varRef(synthesized.entry, inputs[next++]);
        if (isSum) value = convert(Scalar::Float, std::move(value));
        synthesized.entry.body.push_back(assign(varRef(synthesized.entry, result), std::move(value)));
      }
    }
    return synthesized.finish(module_);
  }

  Module& module_;
  KernelId id_;
  std::vector<FloatSum> sums_;
};

/// True if a variable is an accumulator as a whole, all of whose components are sums, and nothing else uses it.
bool isWhole(const Module& module, const Kernel& kernel, const FloatSum& sum) {
  if (!sum.members.empty() || !sum.isWhole()) return false;
  bool isOnlySummed = true;
  walkStmts(module.functions[kernel.entry].body, [&](const Stmt& stmt) {
    const std::optional<FoldTarget> target = foldedBy(kernel, stmt);
    if (target && sum.overlaps(*target)) return;
    forEachOperand(stmt, [&](const ExprPtr& operand) {
      walkExprs(*operand, [&](const Expr& expr) {
        const auto* n = std::get_if<VarRef>(&expr.node);
        isOnlySummed = isOnlySummed && (n == nullptr || n->var != sum.accumulator);
      });
    });
  });
  return isOnlySummed;
}

}  // namespace

void sumInDoubles(Module& module, Diagnostics&) {
  forEachDeclaredKernel(module, [&](KernelId id) {
    const Kernel& kernel = module.kernels[id];
    if (!kernel.parts || !kernel.reduction->compensated || kernel.isSynthesized) return;
    std::vector<FloatSum> sums = kernel.reduction->compensated->sums;
    const Kernel& combine = module.kernels[*kernel.reduction->combine];
    const bool areWhole = std::ranges::all_of(sums, [&](const FloatSum& sum) {
      FloatSum combined = sum;
      combined.accumulator = sameAccumulator(kernel, sum.accumulator, combine);
      return isWhole(module, kernel, sum) && isWhole(module, combine, combined);
    });
    if (areWhole) DoubleSummation(module, id, std::move(sums)).make();
  });
}

}  // namespace skc
