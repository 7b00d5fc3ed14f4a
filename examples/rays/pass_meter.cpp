// SPDX-License-Identifier: MIT
#include "pass_meter.hpp"

#include <algorithm>

namespace rays {

void PassMeter::note(std::string_view kernel, std::int64_t elements, double milliseconds) {
  auto row = std::ranges::find(rows_, kernel, &Row::kernel);
  if (row == rows_.end()) row = rows_.insert(rows_.end(), Row{.kernel = kernel});
  const sk::PassCount count = device_.passCount();
  ++row->calls;
  row->elements += elements;
  row->count.passes += count.passes;
  row->count.bytesRead += count.bytesRead;
  row->count.bytesWritten += count.bytesWritten;
  row->milliseconds += milliseconds;
}

}  // namespace rays
