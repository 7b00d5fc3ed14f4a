// SPDX-License-Identifier: MIT
#include "native/push_buffers.hpp"

#include <algorithm>
#include <utility>

#include "native/scalars.hpp"

namespace sk {

namespace {

constexpr std::int64_t firstCapacity = 256;

void append(native::Pushed& to, const native::Pushed& from) {
  for (std::size_t c = 0; c < to.size(); ++c) to[c].insert(to[c].end(), from[c].begin(), from[c].end());
}

}  // namespace

PushBuffer::PushBuffer(const program::Element& element, RealType real) {
  forEachScalar(element, real,
                [&](std::size_t, std::size_t bytes, program::Scalar) { bytes_.push_back(bytes); });
  arrays_.resize(bytes_.size());
  pointers_.resize(bytes_.size());
  sink_ = {{pointers_.data(), 0, 0, [](native::Sink* sink) { static_cast<Sink*>(sink)->buffer->grow(); }},
           this};
}

void PushBuffer::grow() {
  sink_.capacity = std::max(firstCapacity, sink_.capacity * 2);
  for (std::size_t c = 0; c < arrays_.size(); ++c) {
    // whole vectors may be stored beyond the last element
    arrays_[c].resize(static_cast<std::size_t>(sink_.capacity + native::mostLanes) * bytes_[c]);
    pointers_[c] = arrays_[c].data();
  }
}

native::Pushed PushBuffer::take() {
  for (std::size_t c = 0; c < arrays_.size(); ++c) {
    arrays_[c].resize(static_cast<std::size_t>(sink_.count) * bytes_[c]);
  }
  return std::move(arrays_);
}

PushFrame::PushFrame(const program::Kernel& kernel, const CodeFrame& frame, RealType real)
    : arguments_(frame.arguments().begin(), frame.arguments().end()), frame_(*frame.get()) {
  frame_.arguments = arguments_.data();
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    if (parameter.role != program::Role::VariableOutput) continue;
    arguments_[i].sink =
        buffers_.emplace_back(std::make_unique<PushBuffer>(*parameter.element, real))->sink();
  }
}

std::vector<native::Pushed> PushFrame::take() {
  std::vector<native::Pushed> pushed;
  for (const auto& buffer : buffers_) pushed.push_back(buffer->take());
  return pushed;
}

void PushParts::add(std::int64_t order, std::vector<native::Pushed> pushed) {
  const std::lock_guard lock(mutex_);
  parts_.push_back({order, std::move(pushed)});
}

void PushParts::store(std::span<const native::Operand> operands) {
  if (parts_.empty()) return;
  std::ranges::sort(parts_, {}, &Part::order);
  for (std::size_t k = 1; k < parts_.size(); ++k) {
    for (std::size_t output = 0; output < parts_[k].pushed.size(); ++output) {
      append(parts_[0].pushed[output], parts_[k].pushed[output]);
    }
  }
  std::size_t output = 0;
  for (const native::Operand& operand : operands) {
    if (operand.pushed != nullptr) *operand.pushed = std::move(parts_[0].pushed[output++]);
  }
}

}  // namespace sk
