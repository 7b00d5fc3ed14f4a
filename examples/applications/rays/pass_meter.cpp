// SPDX-License-Identifier: MIT
#include "pass_meter.hpp"

#include <algorithm>
#include <ctime>

#include "support/stopwatch.hpp"

namespace rays {

bool runsOnProcessor(const sk::Device& device) {
  return device.isSoftware() || device.name().starts_with("native");
}

double milliseconds(const sk::Device& device, const std::function<void()>& call) {
  const examples::Stopwatch stopwatch;
  const std::clock_t start = std::clock();
  call();
  return runsOnProcessor(device) ? 1e3 * double(std::clock() - start) / CLOCKS_PER_SEC
                                 : stopwatch.milliseconds();
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
