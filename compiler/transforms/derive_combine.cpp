// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/ir.hpp"
#include "ir/operators.hpp"
#include "ir/print.hpp"
#include "ir/walk.hpp"
#include "transforms/check_folds.hpp"
#include "transforms/check_limits.hpp"
#include "transforms/fold_copy.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc {

using namespace ir;

namespace {

// Builds the statement that combines two partial results for one target of a fold.

/// The target's member or components of a variable.
ExprPtr access(const Module& module, const Function& function, VarId var, const FoldTarget& target) {
  ExprPtr expr = member(module, varRef(function, var, target.loc), target.members, target.loc);
  if (target.isWhole()) return expr;
  std::vector<std::uint8_t> components;
  for (std::uint8_t i = 0; i < target.type.width; ++i) {
    if ((target.components >> i & 1U) != 0) components.push_back(i);
  }
  return swizzle(std::move(expr), std::move(components), target.loc);
}

/// `total op= partial` for the target's member or components. Both are variables of `function` with the
/// accumulator's type.
Stmt combineTarget(const Module& module, const Function& function, const FoldTarget& target, VarId partial,
                   VarId total) {
  const auto as = [&](Scalar scalar, ExprPtr value) {
    return value->type.isMatrix() ? std::move(value) : convert(scalar, std::move(value), target.loc);
  };
  const auto read = [&](VarId var) {   // operators take arithmetic types only
    return as(arithmeticScalar(target.type.scalar), access(module, function, var, target));
  };
  ExprPtr place = access(module, function, total, target);
  if (const auto* n = std::get_if<Intrinsic>(&target.op)) {
    ExprPtr value = intrinsic(*n, exprs(read(total), read(partial)), target.loc);
    return assign(std::move(place), as(target.type.scalar, std::move(value)), target.loc);
  }
  const BinaryOp op = std::get<BinaryOp>(target.op);
  const bool isLogical = op == BinaryOp::LogicalAnd || op == BinaryOp::LogicalOr;
  if (!isLogical && !target.type.isNarrow() && !target.type.isMatrix()) {
    return assign(std::move(place), op, access(module, function, partial, target), target.loc);
  }
  ExprPtr value = binary(op, read(total), read(partial), target.loc);
  return assign(std::move(place), as(target.type.scalar, std::move(value)), target.loc);
}

// ---- identities -------------------------------------------------------------------------------

/// A value with `component` in every component.
ExprPtr everywhere(Type type, const Expr& component) {
  if (type.isScalar()) return clone(component);
  if (type.isVector()) return construct(type, exprs(clone(component)));
  std::vector<ExprPtr> rows;
  for (int i = 0; i < type.width; ++i) rows.push_back(everywhere(type.indexed(), component));
  return construct(type, std::move(rows));
}

/// The identity of a scalar, vector or matrix member; null if one of its components is not folded.
ExprPtr leafIdentity(const FoldPattern& pattern, const AccumulatorPart& leaf) {
  const Type type = leaf.type;
  std::vector<ExprPtr> components(type.width);
  for (const FoldTarget& target : pattern.targets) {
    if (!target.isOfMember(leaf)) continue;
    const ExprPtr one = neutralOf(target.op, type.scalar);
    if (target.isWhole()) return everywhere(type, *one);
    for (unsigned i = 0; i < type.width; ++i) {
      if ((target.components >> i & 1U) != 0) components[i] = clone(*one);
    }
  }
  for (const ExprPtr& component : components) {
    if (!component) return nullptr;
  }
  return construct(type, std::move(components));
}

ExprPtr identityOf(const Module& module, const FoldPattern& pattern, AccumulatorPart part) {
  const Type type = part.type;
  if (type.isArithmetic() || type.isMatrix()) return leafIdentity(pattern, part);
  if (type.kind != Type::Kind::Struct) return nullptr;
  std::vector<ExprPtr> fields;
  part.members.push_back(0);
  for (const StructField& field : module.structs[type.index].fields) {
    part.type = field.type;
    fields.push_back(identityOf(module, pattern, part));
    if (!fields.back()) return nullptr;
    ++part.members.back();
  }
  return construct(type, std::move(fields));
}

// ---- combining kernels ------------------------------------------------------------------------

/// Builds the reduce that combines the results of a known pattern: `total op= total_part` for each target.
KernelId makeCombination(Module& module, KernelId id, const FoldPattern& pattern) {
  const Kernel& kernel = module.kernels[id];
  SynthesizedKernel synthesized(kernel, "_combine");
  synthesized.kernel.name = synthesized.entry.name;
  const std::vector<VarId> accumulators = paramsOf(kernel, ParamRole::Accumulator);
  const std::vector<VarId> parts = synthesized.addEach(kernel, accumulators, ParamRole::Input, "", "_part");
  const std::vector<VarId> totals = synthesized.addEach(kernel, accumulators, ParamRole::Accumulator, "", "");
  for (const FoldTarget& target : pattern.targets) {
    const auto i = std::ranges::find(accumulators, target.accumulator) - accumulators.begin();
    synthesized.entry.body.push_back(combineTarget(module, synthesized.entry, target, parts[i], totals[i]));
  }
  return synthesized.finishCombination(module);
}

// ---- the cases --------------------------------------------------------------------------------

bool isAssociative(FoldOp op) {
  return std::holds_alternative<Intrinsic>(op) || row(std::get<BinaryOp>(op)).isAssociative;
}

class CombineDeriver {
 public:
  CombineDeriver(Module& module, Diagnostics& diagnostics) : module_(module), diagnostics_(diagnostics) {}

  void derive(KernelId id) {
    Kernel& kernel = module_.kernels[id];
    const std::optional<FoldPattern> pattern = recogniseFold(kernel, module_.functions[kernel.entry]);
    kernel.reduction->pattern = pattern;
    const bool isDerived = pattern && !kernel.reduction->combine;
    if (isDerived && !checkAssociative(kernel, *pattern)) return;
    const bool isGiven = anyAccumulator(kernel, [](const KernelParam& param) { return !!param.identity; });
    if (isDerived && !checkIdentities(module_, kernel, diagnostics_)) return;
    if (pattern) addIdentities(kernel, *pattern);
    if (kernel.reduction->combine) {
      if (!checkOverload(kernel)) return;
      needInputs(module_.kernels[*kernel.reduction->combine]);
    } else if (foldsBesideOutputs(kernel) && !pattern && foldsAccumulators(kernel)) {
      if (!combineByFoldAlone(id, !isGiven)) return;
    } else if (!foldsBesideOutputs(kernel) && (pattern ? pattern->isPlain : foldsAccumulators(kernel))) {
      if (!checkIndex(kernel, id)) return;
      combineByItself(kernel, id, !isGiven);
      if (!pattern) unknown_.push_back(id);
    } else if (pattern) {
      const KernelId combine = makeCombination(module_, id, *pattern);
      Reduction& reduction = *module_.kernels[id].reduction;
      reduction.combine = combine;
      reduction.operands.assign(module_.kernels[combine].params.size(), 0);
    } else {
      return needCombine(kernel);
    }
    Reduction& reduction = *module_.kernels[id].reduction;
    // a component that no operator folds keeps what its run starts from
    reduction.commutative = isDerived && (!reduction.seeded || hasIdentities(module_.kernels[id]));
    needIdentities(module_.kernels[id]);
    if (checkCombinationFits(module_, module_.kernels[id], diagnostics_)) derived_.push_back(id);
  }

  /// Tries all folds on numbers. An overload that combines results of others meets no other values.
  void check() {
    std::vector<bool> combinesOthers(module_.kernels.size(), false);
    for (const KernelId id : derived_) {
      const KernelId combine = *module_.kernels[id].reduction->combine;
      if (combine != id && checkCombination(module_, id, diagnostics_)) combinesOthers[combine] = true;
    }
    for (const KernelId id : derived_) {
      if (module_.kernels[id].reduction->combine != id) continue;
      if (std::ranges::find(unknown_, id) != unknown_.end()) {
        checkOwnCombination(module_, id, combinesOthers[id], diagnostics_);
      } else if (!combinesOthers[id]) {
        checkCombination(module_, id, diagnostics_);
      }
    }
  }

 private:
  template <class Predicate>
  static bool anyAccumulator(const Kernel& kernel, Predicate&& holds) {
    return std::any_of(kernel.params.begin(), kernel.params.end(), [&](const KernelParam& param) {
      return param.role == ParamRole::Accumulator && holds(param);
    });
  }

  void addIdentities(Kernel& kernel, const FoldPattern& pattern) const {
    for (VarId i = 0; i < kernel.params.size(); ++i) {
      KernelParam& param = kernel.params[i];
      if (param.role != ParamRole::Accumulator || param.identity) continue;
      param.identity = identityOf(module_, pattern, {i, {}, param.type, 0});
    }
  }

  static void combineByItself(Kernel& kernel, KernelId id, bool seeded) {
    Reduction& reduction = *kernel.reduction;
    reduction.combine = id;
    reduction.seeded = seeded;
    for (std::uint32_t i = 0; i < kernel.params.size(); ++i) reduction.operands.push_back(i);
    needInputs(kernel);
  }

  /// Makes a reduce without the outputs, which combines its own results and the kernel's.
  bool combineByFoldAlone(KernelId id, bool seeded) {
    if (!checkIndex(module_.kernels[id], id)) return false;
    FoldCopy copy(module_, id, "_combine");
    copy.drop({ParamRole::Output});
    const KernelId alone = copy.finishFold(seeded);
    if (!checkOwnCombination(module_, alone, false, diagnostics_)) return false;
    Kernel& kernel = module_.kernels[id];
    Reduction reduction{alone, {}, seeded};
    for (std::uint32_t i = 0; i < kernel.params.size(); ++i) {
      if (kernel.params[i].role != ParamRole::Output) reduction.operands.push_back(i);
    }
    kernel.reduction = std::move(reduction);
    needInputs(kernel);
    needInputs(module_.kernels[alone]);
    return true;
  }

  /// A run that starts from its first elements needs the inputs, whatever the spec parameters.
  static void needInputs(Kernel& kernel) {
    for (KernelParam& param : kernel.params) {
      if (param.role == ParamRole::Input) param.neededIf = nullptr;
    }
  }

  /// Partial results have no index.
  bool checkOverload(const Kernel& kernel) {
    const std::optional<Loc> place = usesIndex(module_, module_.kernels[*kernel.reduction->combine]);
    if (place) diagnostics_.report(Diag::CombineUsesIndex, *place, {kernel.name});
    return !place;
  }
  bool checkIndex(const Kernel& kernel, KernelId id) {
    const std::optional<Loc> place = usesIndex(module_, kernel);
    const bool isReported = std::any_of(  // it is the overload that combines for another
        module_.kernels.begin(), module_.kernels.end(),
        [&](const Kernel& other) { return other.reduction && other.reduction->combine == id; });
    if (place && !isReported) diagnostics_.report(Diag::ReduceIndexCombine, *place, {kernel.name});
    return !place;
  }

  bool checkAssociative(const Kernel& kernel, const FoldPattern& pattern) {
    for (const FoldTarget& target : pattern.targets) {
      if (isAssociative(target.op)) continue;
      const BinaryOp op = std::get<BinaryOp>(target.op);
      const std::string& name = kernel.params[target.accumulator].name;
      std::string advice = "fold with '+', '*', '&', '|', '^', min or max";
      if (op == BinaryOp::Sub) advice = "write '" + name + " += ...' and subtract once, from the result";
      if (op == BinaryOp::Div) advice = "write '" + name + " *= ...' and divide once, by the result";
      diagnostics_.report(Diag::ReduceNotAssociative, target.loc, {spelling(op), name, advice});
      return false;
    }
    return true;
  }

  void needIdentities(const Kernel& kernel) {
    if (kernel.reduction->seeded) return;
    std::string elements;
    for (const KernelParam& param : kernel.params) {
      if (param.role != ParamRole::Input) continue;
      elements += (elements.empty() ? "'" : " and '") + print(module_, param.type) + "'";
    }
    if (elements.empty()) elements = "values";
    for (const KernelParam& param : kernel.params) {
      if (param.role != ParamRole::Accumulator || param.identity) continue;
      diagnostics_.report(
          Diag::ReduceNeedsIdentity, param.loc,
          {kernel.name, elements, print(module_, param.type), param.name, accumulatorWordOf(kernel)});
    }
  }

  void needCombine(const Kernel& kernel) {
    std::string parts, totals, identities;
    for (const KernelParam& param : kernel.params) {
      if (param.role != ParamRole::Accumulator) continue;
      const std::string type = print(module_, param.type);
      const std::string total = std::string(accumulatorWordOf(kernel)) + " " + type + " " + param.name + "<>";
      parts += type + " " + param.name + "_part<>, ";
      totals += (totals.empty() ? "" : ", ") + total;
      if (!param.identity) identities += "an identity, '" + total + " = ...', and ";
    }
    diagnostics_.report(Diag::ReduceNeedsCombine, kernel.loc,
                        {kernel.name, parts + totals, identities, accumulatorWordOf(kernel)});
  }

  Module& module_;
  Diagnostics& diagnostics_;
  std::vector<KernelId> derived_;  ///< without an error
  std::vector<KernelId> unknown_;  ///< combine their own results by no known operator
};

}  // namespace

void deriveCombine(Module& module, Diagnostics& diagnostics) {
  CombineDeriver state(module, diagnostics);
  forEachDeclaredKernel(module, [&](KernelId id) {
    if (module.kernels[id].reduction) state.derive(id);
  });
  state.check();
}

}  // namespace skc
