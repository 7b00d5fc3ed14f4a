// SPDX-License-Identifier: MIT
#include "pass_meter.hpp"

#include <algorithm>

#include "study.hpp"

namespace rays {

double milliseconds(const sk::Device& device, const std::function<void()>& call) {
  return callMilliseconds(device.isSoftware() || device.name().starts_with("native"), call);
}

void PassMeter::note(std::string_view kernel, std::int64_t elements, double time) {
  auto row = std::ranges::find(rows_, kernel, &Row::kernel);
  if (row == rows_.end()) row = rows_.insert(rows_.end(), Row{.kernel = kernel});
  const sk::PassCount count = device_.passCount();
  ++row->calls;
  row->elements += elements;
  row->count.passes += count.passes;
  row->count.bytesRead += count.bytesRead;
  row->count.bytesWritten += count.bytesWritten;
  row->milliseconds += time;
}

}  // namespace rays
