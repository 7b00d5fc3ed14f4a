// SPDX-License-Identifier: MIT
//
// Which entries the object code of a kernel has.
#include "native/entries.hpp"

#include <algorithm>

#include "ir/call_graph.hpp"
#include "native/leaves.hpp"
#include "transforms/fold_pattern.hpp"

namespace skc::native {
namespace {

using namespace ir;
using sk::native::EntryKind;

/// True if the reduction can fold partial results: its inputs have the types of its accumulators, and it has no
/// outputs and uses no index.
bool combines(const Module& module, const Kernel& kernel) {
  std::vector<Type> inputs, accumulators;
  for (const KernelParam& param : kernel.params) {
    if (param.role == ParamRole::Input) inputs.push_back(param.type);
    if (param.role == ParamRole::Accumulator) accumulators.push_back(param.type);
  }
  return inputs == accumulators && !foldsBesideOutputs(kernel) && !usesIndex(module, kernel);
}

}  // namespace

bool mayHoldFloats(const Module& module, const Kernel& kernel) {
  const auto isInMemory = [&](Type type) {
    return std::ranges::any_of(leavesOf(module, type), [](const Leaf& leaf) {
      return leaf.scalar == Scalar::Float && !leaf.dimensions.empty();
    });
  };
  for (const Constant& constant : module.constants) {
    if (isInMemory(constant.type)) return false;
  }
  for (const FunctionId id : functionsOf(module, kernel)) {
    const Function& function = module.functions[id];
    if (isInMemory(function.result)) return false;
    for (const Variable& variable : function.variables) {
      if (isInMemory(variable.type)) return false;
    }
  }
  return true;
}

bool hasIdentities(const Kernel& kernel) {
  return std::ranges::none_of(kernel.params, [](const KernelParam& param) {
    return param.role == ParamRole::Accumulator && param.identity == nullptr;
  });
}

std::vector<EntryKind> entriesOf(const Module& module, const Kernel& kernel, bool scans) {
  std::vector<EntryKind> kinds;
  if (kernel.reduction) {
    kinds.push_back(EntryKind::Fold);
    kinds.push_back(EntryKind::FoldRows);
    if (combines(module, kernel)) kinds.push_back(EntryKind::Combine);
    if (hasIdentities(kernel)) kinds.push_back(EntryKind::Identity);
    if (scans) kinds.push_back(EntryKind::Scan);
  } else {
    kinds.push_back(EntryKind::Run);
  }
  const bool hasBorders = std::ranges::any_of(kernel.params, [](const KernelParam& param) {
    return param.role == ParamRole::Gather && param.boundary == Boundary::Border;
  });
  if (hasBorders && readsNeighbors(kernel)) kinds.push_back(EntryKind::Borders);
  const bool scatters = std::ranges::any_of(
      kernel.params, [](const KernelParam& param) { return param.role == ParamRole::Scatter; });
  if (scatters) kinds.push_back(EntryKind::Apply);
  return kinds;
}

}  // namespace skc::native
