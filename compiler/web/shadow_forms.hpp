// SPDX-License-Identifier: MIT
//
// The forms of kernels and reduces that device.shadow() runs beside the plain ones (runtime/web/src/shadow): they compute in
// doubles, and, unlike the forms of `extended`, their streams hold doubles as well.
#pragma once

#include <string>
#include <vector>

#include "sk/program.hpp"

namespace skc::web {

/// A kernel that reads and writes streams of what it computes with. It may be moved, but not copied, as it refers to its own
/// parameters.
class ShadowKernel {
 public:
  /// `wide`: the variant in doubles of a kernel (program::Kernel::wide).
  explicit ShadowKernel(const sk::program::Kernel& wide);
  ShadowKernel(ShadowKernel&&) = default;
  ShadowKernel& operator=(ShadowKernel&&) = default;

  const sk::program::Kernel& get() const { return kernel_; }

 private:
  std::vector<sk::program::Parameter> parameters_;
  sk::program::Kernel kernel_;
};

/// Why browsers cannot run such a form of a kernel; "" if they can.
std::string whyNotBeside(const ShadowKernel& kernel);

}  // namespace skc::web
