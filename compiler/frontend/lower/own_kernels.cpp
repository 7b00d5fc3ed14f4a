// SPDX-License-Identifier: MIT
//
// Decides which kernels a file's stubs offer: those that are written in it, not those of .sk files that it includes.
#include <algorithm>
#include <filesystem>

#include <clang/Basic/SourceManager.h>

#include "frontend/lower/module_lowering.hpp"
#include "support/header_files.hpp"

namespace skc::frontend {

using clang::SourceLocation;

/// True if the declaration is in the main file, or in a file that this includes and that is no .sk file.
bool ModuleLowering::isOwn(SourceLocation where) const {
  clang::FileID file = sources().getFileID(sources().getExpansionLoc(where));
  while (file != sources().getMainFileID()) {
    const clang::OptionalFileEntryRef entry = sources().getFileEntryRefForID(file);
    const SourceLocation includedAt = sources().getIncludeLoc(file);
    if ((entry && isKernelFile(entry->getName())) || includedAt.isInvalid()) return false;
    file = sources().getFileID(includedAt);
  }
  return true;
}

/// Removes the kernels of included .sk files, which the stubs of those files offer. What combines partial results of this file's
/// own kernels stays, as if synthesized.
void ModuleLowering::keepOwnKernels() {
  const auto fileOf = [&](const ir::Kernel& kernel) {
    return std::filesystem::path(module_.sources[kernel.loc.file]).lexically_normal().string();
  };
  std::vector<bool> stays = isOwn_;
  for (ir::KernelId id = 0; id < module_.kernels.size(); ++id) {
    const ir::Kernel& kernel = module_.kernels[id];
    if (isOwn_[id] && kernel.reduction && kernel.reduction->combine) stays[*kernel.reduction->combine] = true;
  }
  const bool hasOwn = std::ranges::find(isOwn_, true) != isOwn_.end();
  if (!isOwn_.empty() && !hasOwn && module_.streams.empty()) {
    const ir::Kernel& first = module_.kernels.front();
    diagnostics_.report(Diag::NoOwnKernels, first.loc, {module_.file, first.name, fileOf(first)});
  }
  for (ir::KernelId id = 0; id < module_.kernels.size(); ++id) {
    const ir::Kernel& kernel = module_.kernels[id];
    for (ir::KernelId other = 0; isOwn_[id] && other < module_.kernels.size(); ++other) {
      const ir::Kernel& included = module_.kernels[other];
      if (isOwn_[other] || included.name != kernel.name || included.scope != kernel.scope) continue;
      diagnostics_.report(Diag::OverloadOfIncluded, kernel.loc, {kernel.name, fileOf(included)});
      break;
    }
  }
  std::vector<ir::KernelId> numbers;
  std::vector<ir::Kernel> kernels;
  for (ir::KernelId id = 0; id < module_.kernels.size(); ++id) {
    numbers.push_back(static_cast<ir::KernelId>(kernels.size()));
    if (!stays[id]) continue;
    kernels.push_back(std::move(module_.kernels[id]));
    kernels.back().isSynthesized = !isOwn_[id];
  }
  for (ir::Kernel& kernel : kernels) {
    if (kernel.reduction && kernel.reduction->combine)
      kernel.reduction->combine = numbers[*kernel.reduction->combine];
  }
  module_.kernels = std::move(kernels);
}

}  // namespace skc::frontend
