// SPDX-License-Identifier: MIT
#include "transforms/find_reach.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "analysis/find_reach.hpp"

namespace skc {

using namespace ir;

void findReach(Module& module, Diagnostics&) {
  for (Kernel& kernel : module.kernels) {
    const auto isGather = [](const KernelParam& param) { return param.role == ParamRole::Gather; };
    if (kernel.isSynthesized || std::ranges::none_of(kernel.params, isGather)) continue;
    std::vector<analysis::GatherReach> found = analysis::findReach(module, kernel);
    for (std::size_t p = 0; p < found.size(); ++p) {
      kernel.params[p].reach = std::move(found[p].reach);
      kernel.params[p].reachShapes = found[p].shapes;
    }
  }
}

}  // namespace skc
