// SPDX-License-Identifier: MIT
#include "gl_device/pass/loop_reports.hpp"

#include <algorithm>
#include <optional>

namespace sk {

std::int32_t LoopReports::numberOf(std::string_view kernel) {
  auto found = std::ranges::find(kernels_, kernel);
  if (found == kernels_.end()) found = kernels_.emplace(found, kernel);
  return static_cast<std::int32_t>(found - kernels_.begin()) + 1;
}

LoopReports::Report LoopReports::take(gl::BoundState& bound) {
  if (!std::exchange(isOpen_, false)) return {};
  const std::optional<std::int32_t> number = check_.take(bound);
  if (!number) return {{}, period_, false};
  if (*number <= 0) return {};
  return {kernels_[static_cast<std::size_t>(*number) - 1], period_};
}

}  // namespace sk
