// SPDX-License-Identifier: MIT
#include "split/passes.hpp"

#include <utility>

#include "ir/walk.hpp"
#include "split/cost.hpp"
#include "split/plan_passes.hpp"
#include "split/slice.hpp"

namespace skc::split {
namespace {

using namespace ir;

class AssertionSlicer {
 public:
  AssertionSlicer(Module& module, Diagnostics& diagnostics) : module_(module), diagnostics_(diagnostics) {}

  void slice(KernelId id) {
    const KernelId check = module_.kernels[id].assertions->check;
    const Function& entry = module_.functions[module_.kernels[check].entry];
    const VarId failed = entry.parameterCount - 1;
    VarSet wanted(entry.variables.size(), false);
    wanted[failed] = true;
    const Slicer slicer(module_, entry);
    Slice slice = slicer.slice(wanted, VarSet(wanted.size(), false));
    if (isFolded(module_.kernels[id], slice)) return;
    const Pass made =
        makePassKernel(module_, check, {}, {.targets = {{failed, true, 0, 1}}, .slice = std::move(slice)});
    Kernel sliced = std::move(module_.kernels[made.kernel]);
    module_.kernels.pop_back();
    readExtents(sliced);
    sliced.isPart = true;
    sliced.choices = module_.kernels[id].choices;
    sliced.choices.ahead = 0;
    module_.kernels[check] = std::move(sliced);
    std::vector<std::uint32_t>& operands = module_.kernels[id].assertions->operands;
    for (const PassOperand& operand : made.operands) operands.push_back(operand.index);
    operands.pop_back();  // of `failed`
  }

 private:
  /// Reports an accumulator that the slice reads.
  bool isFolded(const Kernel& kernel, const Slice& slice) {
    for (VarId var = 0; var < kernel.params.size(); ++var) {
      if (kernel.params[var].role != ParamRole::Accumulator || !slice.used[var]) continue;
      diagnostics_.report(Diag::AssertFolded, firstRead(var, slice).value_or(kernel.params[var].loc),
                          {kernel.name, kernel.params[var].name});
      return true;
    }
    return false;
  }

  /// The check writes no streams but its output.
  void readExtents(Kernel& check) {
    for (std::size_t i = 0; i < check.params.size(); ++i) {
      if (check.params[i].role != ParamRole::Scatter) continue;
      check.params[i].role = ParamRole::Gather;
      module_.functions[check.entry].variables[i].role = VarRole::Gather;
    }
  }

  Module& module_;
  Diagnostics& diagnostics_;
};

}  // namespace

void sliceAssertions(Module& module, Diagnostics& diagnostics) {
  AssertionSlicer state(module, diagnostics);
  forEachDeclaredKernel(module, [&](KernelId id) {
    if (module.kernels[id].assertions) state.slice(id);
  });
}

}  // namespace skc::split
