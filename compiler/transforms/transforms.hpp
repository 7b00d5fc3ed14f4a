// SPDX-License-Identifier: MIT
//
// The rewrites of the IR between frontend and emission, in order. Each is a free function in a file of its
// own; this one lists them and gives the reasons for their order.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

struct TransformOptions {
  /// What the targets can read and write in one pass: kernels that need more get plans.
  std::vector<ir::Limits> limits = {};
  /// Whether kernels get variants for other precisions.
  bool precisions = false;
  /// Whether the target is WebGL, where `?:` does not choose between structs or arrays.
  bool expandsSelects = false;
  /// Called with the name and the module after each transform; may be empty.
  std::function<void(std::string_view name, const ir::Module& module)> after = {};
};

/// Names of the transforms, in execution order: the values that --print-after takes.
std::span<const std::string_view> transformNames();

/// True if the module is validated before and after each transform: in builds with assertions (all builds
/// with tests have them), unless SKC_VALIDATE is "off".
bool validatesTransforms();

/// Runs all transforms; stops after one that reports an error.
void runTransforms(ir::Module& module, Diagnostics& diagnostics, const TransformOptions& options = {});

}  // namespace skc
