// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "analysis/gather_reach.hpp"

namespace skc {

using namespace ir;

namespace {

void report(const KernelParam& param, const Reach& reach, Diagnostics& diagnostics) {
  const std::int32_t promised = param.promise[reach.dimension];
  const std::string most = std::to_string(promised), axis(1, "xyzw"[reach.dimension]);
  if (reach.kind == Reach::Kind::Whole) {
    diagnostics.report(Diag::HaloOfTable, param.loc, {param.name, most, axis});
    return;
  }
  const bool isKnown = reach.below.perSpec == Distance().perSpec && reach.above.perSpec == Distance().perSpec;
  const std::int64_t needed = std::max(reach.below.constant, reach.above.constant);
  if (!isKnown || needed <= promised) return;
  const std::string range =
      std::to_string(-reach.below.constant) + " to " + std::to_string(reach.above.constant);
  diagnostics.report(Diag::HaloExceeded, param.loc, {param.name, most, axis, range, std::to_string(needed)});
}

/// Puts the promise in the place of what is not known. A gather that is read as a table in some dimensions only, such as a stack of
/// grids, keeps these as they are.
void applyPromise(KernelParam& param, Diagnostics& diagnostics) {
  if (param.promise.empty()) return;
  const auto isTable = [](const Reach& reach) { return reach.kind == Reach::Kind::Whole; };
  const bool isTableAlone = std::ranges::all_of(param.reach, isTable);
  for (Reach& reach : param.reach) {
    if (isTable(reach) && !isTableAlone) continue;
    const Distance promised{param.promise[reach.dimension]};
    if (reach.kind == Reach::Kind::Computed) {
      reach = {reach.dimension, Reach::Kind::Near, promised, promised, true};
    } else {
      report(param, reach, diagnostics);
    }
  }
}

}  // namespace

void findReach(Module& module, Diagnostics& diagnostics) {
  for (Kernel& kernel : module.kernels) {
    const auto isGather = [](const KernelParam& param) { return param.role == ParamRole::Gather; };
    if (kernel.isSynthesized || std::ranges::none_of(kernel.params, isGather)) continue;
    std::vector<analysis::GatherReach> found = analysis::gatherReach(module, kernel);
    for (std::size_t p = 0; p < found.size(); ++p) {
      kernel.params[p].reach = std::move(found[p].reach);
      kernel.params[p].reachShapes = found[p].shapes;
      applyPromise(kernel.params[p], diagnostics);
    }
  }
}

}  // namespace skc
