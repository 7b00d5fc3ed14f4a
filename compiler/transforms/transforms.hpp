// SPDX-License-Identifier: MIT
//
// The rewrites of the IR between the frontend and emission, in order. Each is a free function in a
// file of its own; this one knows their names and why they come in this order.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

struct TransformOptions {
  /// What the targets can read and write in a pass: kernels that need more get plans.
  std::vector<ir::Limits> limits = {};
  /// Whether kernels get forms for other precisions.
  bool precisions = false;
  /// Told the name and the module after each transform; may be empty.
  std::function<void(std::string_view name, const ir::Module& module)> after = {};
};

/// Names of the transforms in the order in which they run: what --print-after takes.
std::span<const std::string_view> transformNames();

/// Whether the module is validated before and after each: in builds with assertions, as those with tests are, unless SKC_VALIDATE
/// is "off".
bool validatesTransforms();

/// Runs them all; stops after one that reports an error.
void runTransforms(ir::Module& module, Diagnostics& diagnostics, const TransformOptions& options = {});

}  // namespace skc
