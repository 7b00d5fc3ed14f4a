// SPDX-License-Identifier: MIT
#include "split/passes.hpp"

#include <algorithm>
#include <utility>

#include "split/plan_passes.hpp"
#include "split/slice.hpp"

namespace skc::split {
namespace {

using namespace ir;

/// Pushes and scatters have passes of their own in the runtime, which plans do not cover.
bool hasAppendOutputs(const Kernel& kernel) {
  return std::ranges::any_of(kernel.params, [](const KernelParam& param) {
    return param.role == ParamRole::VariableOutput || param.role == ParamRole::Scatter;
  });
}

/// The largest number of planes that any pass writes.
std::uint32_t widestOf(const std::vector<PlannedPass>& passes) {
  std::uint32_t widest = 0;
  for (const PlannedPass& pass : passes) {
    std::uint32_t planes = 0;
    for (const Target& target : pass.targets) planes += target.planeCount;
    widest = std::max(widest, planes);
  }
  return widest;
}

bool isWithin(const Limits& demand, const Limits& limits) {
  return demand.drawBuffers <= limits.drawBuffers && demand.textureUnits <= limits.textureUnits;
}

Plan makePlan(Module& module, KernelId whole, const Limits& limits) {
  const PlannedSplit planned = planPasses(module, module.kernels[whole], limits);
  const Function& entry = module.functions[module.kernels[whole].entry];
  Plan plan{.limits = {widestOf(planned.passes), limits.textureUnits},
            .temporaries = {},
            .stacks = planned.stacks,
            .passes = {},
            .cost = planned.cost,
            .costWithoutTemporaries = planned.costWithoutTemporaries};
  for (std::size_t i = 0; i < planned.saved.size(); ++i) {
    const VarId var = planned.saved[i];
    const auto readers = std::ranges::count_if(
        planned.passes, [&](const PlannedPass& pass) { return pass.slice.loaded[var]; });
    plan.temporaries.push_back({entry.variables[var].name, entry.variables[var].type, planned.computeCosts[i],
                                static_cast<std::uint32_t>(readers)});
  }
  for (std::uint32_t number = 1; const PlannedPass& pass : planned.passes) {
    plan.passes.push_back(makePassKernel(module, whole, planned, pass));
    module.kernels.back().isSynthesized = module.kernels[whole].isSynthesized;
    module.kernels.back().pass = {whole, number++, static_cast<std::uint32_t>(planned.passes.size())};
  }
  return plan;
}

}  // namespace

void splitKernels(Module& module, std::span<const Limits> limits) {
  std::vector<Limits> generousFirst(limits.begin(), limits.end());
  std::ranges::sort(generousFirst, std::greater(),
                    [](const Limits& one) { return std::pair(one.drawBuffers, one.textureUnits); });
  const std::size_t count = module.kernels.size();   // passes are appended while the loop runs
  for (KernelId id = 0; id < count; ++id) {
    const Kernel& kernel = module.kernels[id];
    if (kernel.reduction || kernel.isNativeOnly || hasAppendOutputs(kernel)) continue;
    const Limits demand = demandOf(module, module.kernels[id]);
    for (const Limits& limit : generousFirst) {
      const std::vector<Plan>& plans = module.kernels[id].plans;
      if (isWithin(demand, limit) || (!plans.empty() && isWithin(plans.back().limits, limit))) continue;
      Plan plan = makePlan(module, id, limit);
      module.kernels[id].plans.push_back(std::move(plan));
    }
  }
}

}  // namespace skc::split
