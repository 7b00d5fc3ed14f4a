// SPDX-License-Identifier: MIT
#include "native/record_buffer.hpp"

#include <algorithm>
#include <cstring>

#include "native/scalars.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

constexpr std::int64_t firstCapacity = 64;

template <std::size_t bytes>
void moveTo(std::span<const std::size_t> positions, const std::byte* from, std::byte* to) {
  for (std::size_t i = 0; i < positions.size(); ++i)
    std::memcpy(to + positions[i] * bytes, from + i * bytes, bytes);
}

}  // namespace

// ---- buffers ---------------------------------------------------------------------------------------

RecordShape::RecordShape(const program::Parameter& parameter, RealType real, bool isReordered)
    : hasTarget(parameter.role == program::Role::Scatter), hasElement(isReordered) {
  forEachScalar(*parameter.element, real,
                [&](std::size_t, std::size_t scalar, program::Scalar) { bytes.push_back(scalar); });
}

RecordBuffer::RecordBuffer(const RecordShape& shape)
    : bytes_(shape.bytes), hasTarget_(shape.hasTarget), hasElement_(shape.hasElement) {
  if (hasTarget_) bytes_.push_back(sizeof(std::int64_t));
  sortedColumns_ = bytes_.size();
  if (hasElement_) bytes_.push_back(sizeof(std::uint32_t));
  arrays_.resize(bytes_.size());
  pointers_.resize(bytes_.size());
  const auto grow = [](native::AppendBuffer* appendBuffer) {
    static_cast<AppendBuffer*>(appendBuffer)->buffer->reserve(appendBuffer->count + 1);
  };
  appendBuffer_ = {{pointers_.data(), nullptr, nullptr, 0, 0, grow}, this};
}

void RecordBuffer::reserve(std::int64_t count) {
  if (count <= appendBuffer_.capacity) return;
  const std::int64_t capacity = std::max({firstCapacity, appendBuffer_.capacity * 2, count});
  std::vector<ArrayMemory> larger;
  for (const std::size_t bytes : bytes_) {
    // code stores whole groups of lanes beyond the last record
    larger.push_back(allocated(bytesOf(capacity + native::mostLanes, bytes)));
  }
  for (std::size_t c = 0; c < bytes_.size(); ++c) {
    if (appendBuffer_.count > 0)
      std::memcpy(larger[c].get(), arrays_[c].get(),
                  static_cast<std::size_t>(appendBuffer_.count) * bytes_[c]);
  }
  arrays_ = std::move(larger);
  appendBuffer_.capacity = capacity;
  setPointers();
}

void RecordBuffer::adopt(std::vector<ArrayMemory>&& arrays, std::int64_t capacity) {
  arrays_ = std::move(arrays);
  appendBuffer_.count = 0;
  appendBuffer_.capacity = capacity;
  setPointers();
}

void RecordBuffer::setPointers() {
  for (std::size_t c = 0; c < arrays_.size(); ++c) pointers_[c] = arrays_[c].get();
  if (hasTarget_) appendBuffer_.targets = reinterpret_cast<std::int64_t*>(pointers_[sortedColumns_ - 1]);
  if (hasElement_) appendBuffer_.elements = reinterpret_cast<std::uint32_t*>(pointers_.back());
}

/// A counting sort by element number; there are at most as many numbers as elements in a chunk.
void RecordBuffer::sort() {
  const std::int64_t first = sorted_;
  sorted_ = appendBuffer_.count;
  const std::span<const std::uint32_t> elements(appendBuffer_.elements + first,
                                                static_cast<std::size_t>(hasElement_ ? sorted_ - first : 0));
  if (std::ranges::is_sorted(elements)) return;
  starts_.assign(*std::ranges::max_element(elements) + std::size_t{2}, 0);
  for (const std::uint32_t element : elements) ++starts_[element + std::size_t{1}];
  for (std::size_t e = 1; e < starts_.size(); ++e) starts_[e] += starts_[e - 1];
  positions_.resize(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) positions_[i] = starts_[elements[i]]++;
  for (std::size_t c = 0; c < sortedColumns_; ++c) permute(c, first, positions_);
}

void RecordBuffer::permute(std::size_t column, std::int64_t first, std::span<const std::size_t> positions) {
  const std::size_t bytes = bytes_[column];
  std::byte* const array = pointers_[column] + static_cast<std::size_t>(first) * bytes;
  copy_.assign(array, array + positions.size() * bytes);
  switch (bytes) {
    case 1: return moveTo<1>(positions, copy_.data(), array);
    case 2: return moveTo<2>(positions, copy_.data(), array);
    case 4: return moveTo<4>(positions, copy_.data(), array);
    case 8: return moveTo<8>(positions, copy_.data(), array);
    default: return moveTo<mostScalarBytes>(positions, copy_.data(), array);
  }
}

// ---- frames ----------------------------------------------------------------------------------------

RecordFrame::RecordFrame(const program::Kernel& kernel, const CodeFrame& frame, const RecordOptions& options)
    : arguments_(frame.arguments().begin(), frame.arguments().end()), frame_(*frame.get()) {
  frame_.arguments = arguments_.data();
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    const bool isPushed = parameter.role == program::Role::VariableOutput;
    const bool isScattered =
        parameter.role == program::Role::Scatter && options.scatters && arguments_[i].components != nullptr;
    if (!isPushed && !isScattered) continue;
    auto buffer = std::make_unique<RecordBuffer>(RecordShape(parameter, options.real, options.isReordered));
    arguments_[i].appendBuffer = buffer->appendBuffer();
    (isPushed ? pushed_ : scattered_).push_back({i, std::move(buffer)});
  }
}

void RecordFrame::sort() {
  for (const Output& output : pushed_) output.buffer->sort();
  for (const Output& output : scattered_) output.buffer->sort();
}

}  // namespace sk
