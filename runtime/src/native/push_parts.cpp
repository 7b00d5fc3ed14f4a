// SPDX-License-Identifier: MIT
#include "native/push_parts.hpp"

#include <algorithm>
#include <cstring>

#include "sk/native/parallel.hpp"
#include "support/checked_size.hpp"

namespace sk {

void PushParts::add(std::int64_t order, std::span<RecordFrame::Output> pushed) {
  Part part{order, {}};
  for (RecordFrame::Output& output : pushed) part.outputs.push_back(std::move(output.buffer));
  const std::lock_guard lock(mutex_);
  parts_.push_back(std::move(part));
}

void PushParts::store(std::span<const native::Operand> operands) {
  if (parts_.empty()) return;
  std::ranges::sort(parts_, {}, &Part::order);
  std::size_t output = 0;
  for (const native::Operand& operand : operands) {
    if (operand.pushed != nullptr) *operand.pushed = joined(output++);
  }
}

native::Pushed PushParts::joined(std::size_t output) const {
  native::Pushed all;
  std::vector<std::int64_t> starts;
  for (const Part& part : parts_) {
    starts.push_back(all.count);
    all.count += part.outputs[output]->count();
  }
  const std::span<const std::size_t> bytes = parts_[0].outputs[output]->bytes();
  for (const std::size_t scalar : bytes) all.arrays.push_back(allocated(bytesOf(all.count, scalar)));
  const auto count = static_cast<std::int64_t>(parts_.size());
  native::inParallel(count, all.count / count, native::Deal::Evenly, [&](native::Range range) {
    for (auto k = static_cast<std::size_t>(range.begin); k < static_cast<std::size_t>(range.end); ++k) {
      const RecordBuffer& part = *parts_[k].outputs[output];
      for (std::size_t c = 0; c < bytes.size() && part.count() > 0; ++c) {
        std::memcpy(all.arrays[c].get() + static_cast<std::size_t>(starts[k]) * bytes[c], part.array(c),
                    static_cast<std::size_t>(part.count()) * bytes[c]);
      }
    }
  });
  return all;
}

}  // namespace sk
