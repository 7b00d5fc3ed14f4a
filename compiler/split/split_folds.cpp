// SPDX-License-Identifier: MIT
#include "split/passes.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "ir/walk.hpp"
#include "split/cost.hpp"
#include "split/plan_passes.hpp"
#include "split/slice.hpp"

namespace skc::split {
namespace {

using namespace ir;

class FoldSplitter {
 public:
  FoldSplitter(Module& module, Diagnostics& diagnostics) : module_(module), diagnostics_(diagnostics) {}

  void split(KernelId id) {
    const Kernel& kernel = module_.kernels[id];
    const Function& entry = module_.functions[kernel.entry];
    const VarSet outputs = paramsOf(kernel, ParamRole::Output);
    const VarSet accumulators = paramsOf(kernel, ParamRole::Accumulator);
    const Slicer slicer(module_, entry);
    Slice map = slicer.slice(outputs, VarSet(outputs.size(), false));
    if (dependsOn(accumulators, map, slicer.slice(outputs, accumulators), kernel)) return;
    const std::optional<Slice> after = sliceAfter(kernel, slicer, outputs, accumulators);
    FoldParts parts;
    parts.map = part(id, {.targets = targetsOf(kernel), .slice = std::move(map)}, {}, parts.mapOperands);
    if (after) parts.after = fold(id, *after, variables(outputs), parts.afterOperands);
    module_.kernels[id].parts = std::move(parts);
  }

 private:
  VarSet paramsOf(const Kernel& kernel, ParamRole role) const {
    VarSet set(module_.functions[kernel.entry].variables.size(), false);
    for (std::size_t i = 0; i < kernel.params.size(); ++i) set[i] = kernel.params[i].role == role;
    return set;
  }

  static std::vector<VarId> variables(const VarSet& set) {
    std::vector<VarId> list;
    for (VarId var = 0; var < set.size(); ++var) {
      if (set[var]) list.push_back(var);
    }
    return list;
  }

  std::vector<Target> targetsOf(const Kernel& kernel) const {
    std::vector<Target> targets;
    for (VarId i = 0; i < kernel.params.size(); ++i) {
      if (kernel.params[i].role != ParamRole::Output) continue;
      const std::size_t planes = planesOf(module_, heldType(kernel.params[i])).size();
      targets.push_back({i, true, 0, static_cast<std::uint32_t>(planes)});
    }
    return targets;
  }

  /// Reports an accumulator that a slice reads. `reading` is the slice without what folds, if it reads only results.
  bool dependsOn(const VarSet& accumulators, const Slice& slice, const Slice& reading, const Kernel& kernel) {
    for (VarId var = 0; var < accumulators.size(); ++var) {
      if (!accumulators[var] || !slice.used[var]) continue;
      diagnostics_.report(Diag::FoldedRead, firstRead(var, reading).value_or(kernel.params[var].loc),
                          {kernel.name, kernel.params[var].name});
      return true;
    }
    return false;
  }

  /// What computes the accumulators from outputs; nullopt if that is impossible, or costs no less than from
  /// the inputs alone. Outputs hold what was computed only if they keep all of its bits.
  std::optional<Slice> sliceAfter(const Kernel& kernel, const Slicer& slicer, const VarSet& outputs,
                                  const VarSet& accumulators) const {
    const Reduction& reduction = *kernel.reduction;
    const bool needsOperands =
        std::ranges::any_of(module_.kernels[*reduction.combine].params, [](const KernelParam& param) {
          return param.role != ParamRole::Input && param.role != ParamRole::Accumulator;
        });
    if (needsOperands || reduction.seeded) return std::nullopt;
    VarSet kept = outputs;
    for (VarId i = 0; i < kernel.params.size(); ++i)
      kept[i] = kept[i] && keepsBits(kernel.params[i].type) && !kernel.params[i].neededIf;
    Slice slice = slicer.slice(accumulators, kept);
    if (std::ranges::find(slice.loaded, true) == slice.loaded.end()) return std::nullopt;
    const Slice alone = slicer.slice(accumulators, VarSet(kept.size(), false));
    if (costOf(kernel, slice) >= costOf(kernel, alone)) return std::nullopt;
    return slice;
  }

  bool keepsBits(Type type) const {
    if (type.kind == Type::Kind::Struct) {
      return std::ranges::all_of(module_.structs[type.index].fields,
                                 [&](const StructField& field) { return keepsBits(field.type); });
    }
    return !type.isNarrow() && !type.is64Bit();
  }

  double costOf(const Kernel& kernel, const Slice& slice) const {
    const Function& entry = module_.functions[kernel.entry];
    double cost = CostModel(module_, kernel).run(entry.body, slice);
    const VarSet params = Demand(module_, kernel).params(slice);
    for (VarId i = 0; i < kernel.params.size(); ++i) {
      if ((params[i] && kernel.params[i].role == ParamRole::Input) || slice.loaded[i])
        cost += elementCost(module_, kernel.params[i].type);
    }
    return cost;
  }

  /// Adds a kernel for a slice, and sets for each of its parameters the whole kernel's.
  KernelId part(KernelId whole, const PlannedPass& pass, std::vector<VarId> saved,
                std::vector<std::uint32_t>& operands) {
    PlannedSplit plan;
    plan.saved = std::move(saved);
    const Pass made = makePassKernel(module_, whole, plan, pass);
    for (const PassOperand& operand : made.operands)
      operands.push_back(operand.isTemporary ? plan.saved[operand.index] : operand.index);
    Kernel& kernel = module_.kernels[made.kernel];
    kernel.isPart = true;
    kernel.choices = module_.kernels[whole].choices;
    return made.kernel;
  }

  KernelId fold(KernelId whole, const Slice& slice, std::vector<VarId> outputs,
                std::vector<std::uint32_t>& operands) {
    const KernelId id = part(whole, {.targets = {}, .slice = slice}, std::move(outputs), operands);
    const Reduction& reduction = *module_.kernels[whole].reduction;
    std::vector<std::uint32_t> none(module_.kernels[*reduction.combine].params.size());
    Reduction own{reduction.combine, std::move(none), false};
    own.commutative = reduction.commutative;
    own.pattern = reduction.pattern;
    for (std::size_t i = 0; own.pattern && i < own.pattern->targets.size(); ++i) {
      VarId& accumulator = own.pattern->targets[i].accumulator;
      accumulator = static_cast<VarId>(std::ranges::find(operands, accumulator) - operands.begin());
    }
    module_.kernels[id].reduction = std::move(own);
    return id;
  }

  Module& module_;
  Diagnostics& diagnostics_;
};

}  // namespace

void splitFolds(Module& module, Diagnostics& diagnostics) {
  FoldSplitter state(module, diagnostics);
  forEachDeclaredKernel(module, [&](KernelId id) {
    if (foldsBesideOutputs(module.kernels[id])) state.split(id);
  });
}

}  // namespace skc::split
