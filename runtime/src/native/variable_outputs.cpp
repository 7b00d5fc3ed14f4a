// SPDX-License-Identifier: MIT
#include "native/variable_outputs.hpp"

#include <algorithm>
#include <cstring>
#include <thread>
#include <utility>

#include "native/scalars.hpp"
#include "sk/limits.hpp"
#include "sk/native/code.hpp"
#include "sk/native/parallel.hpp"
#include "support/checked_size.hpp"

namespace sk {

using program::Parameter;
using program::Role;

namespace {

/// If elements push more often, arrays with room for all pushes may be much too large.
constexpr std::int32_t mostPushesOfElement = 2;

}  // namespace

bool PushRooms::mayHold(const program::Kernel& kernel, std::int64_t elements) {
  return std::ranges::all_of(kernel.parameters, [&](const Parameter& parameter) {
    if (parameter.role != Role::VariableOutput) return parameter.role != Role::Scatter;
    return parameter.pushes >= 0 && parameter.pushes <= mostPushesOfElement &&
           elements <= mostExtent / mostPushesOfElement;
  });
}

PushRooms::PushRooms(const program::Kernel& kernel, const native::Call& call, RealType real,
                     std::int64_t slices)
    : slices_(slices) {
  const std::int64_t elements = call.domain[0] * call.domain[1] * call.domain[2] * call.domain[3];
  for (std::size_t i = 0; i < call.operands.size(); ++i) {
    const native::Operand& operand = call.operands[i];
    if (operand.pushed == nullptr) continue;
    Output& output = outputs_.emplace_back();
    output.bytes = RecordShape(kernel.parameters[i], real, /*isReordered=*/false).bytes;
    output.pushed = std::exchange(*operand.pushed, {});
    const std::int64_t capacity = elements * kernel.parameters[i].pushes + native::mostLanes;
    if (output.pushed.capacity < capacity || output.pushed.arrays.size() != output.bytes.size()) {
      output.pushed = {.arrays = {}, .capacity = capacity};
      for (const std::size_t bytes : output.bytes)
        output.pushed.arrays.push_back(allocated(bytesOf(capacity, bytes)));
    }
    output.pushed.count = 0;
    output.ends = std::make_unique<std::atomic<std::int64_t>[]>(static_cast<std::size_t>(slices));
    for (std::int64_t slice = 0; slice < slices; ++slice) output.ends[static_cast<std::size_t>(slice)] = -1;
  }
}

void PushRooms::lend(RecordFrame& frame) {
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    native::Pushed& pushed = outputs_[k].pushed;
    frame.pushed()[k].buffer->adopt(std::move(pushed.arrays), pushed.capacity - native::mostLanes);
  }
}

void PushRooms::place(std::int64_t slice, RecordFrame& frame) {
  const auto at = static_cast<std::size_t>(slice);
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    Output& output = outputs_[k];
    std::int64_t first = 0;
    for (int tries = 0; slice > 0 && (first = output.ends[at - 1].load(std::memory_order_acquire)) < 0;
         ++tries) {
      if (hasFailed_) return;
      constexpr int enough = 1 << 10;
      if (tries >= enough) std::this_thread::yield();
    }
    output.ends[at].store(first + frame.pushed()[k].buffer->count(), std::memory_order_release);
    copy(output, *frame.pushed()[k].buffer, first);
    frame.pushed()[k].buffer->clear();
  }
}

void PushRooms::copy(Output& output, const RecordBuffer& buffer, std::int64_t first) {
  if (buffer.count() == 0) return;
  for (std::size_t c = 0; c < output.bytes.size(); ++c) {
    const std::size_t bytes = output.bytes[c];
    std::memcpy(output.pushed.arrays[c].get() + static_cast<std::size_t>(first) * bytes, buffer.array(c),
                static_cast<std::size_t>(buffer.count()) * bytes);
  }
}

void PushRooms::settle(std::span<const native::Operand> operands) {
  std::size_t k = 0;
  for (const native::Operand& operand : operands) {
    if (operand.pushed == nullptr) continue;
    Output& output = outputs_[k++];
    if (slices_ > 0) output.pushed.count = output.ends[static_cast<std::size_t>(slices_ - 1)];
    *operand.pushed = std::move(output.pushed);
  }
}

void PushRooms::settle(std::span<const native::Operand> operands, RecordFrame& lent) {
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    RecordBuffer& buffer = *lent.pushed()[k].buffer;
    outputs_[k].ends[static_cast<std::size_t>(slices_ - 1)] = buffer.count();
    outputs_[k].pushed.arrays = buffer.release();
  }
  settle(operands);
}

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
