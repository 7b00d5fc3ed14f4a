// SPDX-License-Identifier: MIT
//
// Which kernels' loops a driver has ended early. Mesa's llvmpipe ends all loops of an invocation, and of those that share its
// vectors, after 65,535 iterations together, and goes on with what they have computed. Programs with long loops report that
// (assemble/glsl/loop_check.glsl); whoever asks the driver for its errors asks for the reports, too.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gl/loop_check.hpp"
#include "gl_device/gl_context.hpp"

namespace sk {

class LoopReports {
 public:
  /// The number, from 1, by which a kernel's programs report.
  std::int32_t numberOf(std::string_view kernel);
  /// Must be called before a program that reports runs, and before its outputs count as written.
  void begin(GlContext& context) {
    check_.bind(context.bound());
    open(context);
  }
  /// Must be called before logs run such programs again.
  void repeat(GlContext& context) {
    if (!kernels_.empty()) open(context);
  }
  /// Whether programs that report have run since take().
  bool isOpen() const { return isOpen_; }
  struct Report {
    std::string_view kernel;  ///< empty: no loop has been ended early
    std::int64_t period = 0;  ///< streams that were written before it are right (GlContext::period())
    bool isKnown = true;  ///< false if the driver has failed
  };
  /// What has been reported since the last call. Waits for the device if programs that report have run.
  Report take(gl::BoundState& bound);

 private:
  void open(GlContext& context) {
    if (!std::exchange(isOpen_, true)) period_ = context.beginPeriod();
  }

  std::vector<std::string> kernels_;
  bool isOpen_ = false;
  std::int64_t period_ = 0;  ///< began with the first of them
  gl::LoopCheck check_;
};

}  // namespace sk
