// SPDX-License-Identifier: MIT
#include "native/variable_outputs.hpp"

#include <algorithm>
#include <array>
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

namespace {

constexpr std::size_t mostBuckets = 64;
/// Buckets have 2^4 elements or more: threads share cache lines only at their borders.
constexpr int leastShift = 4;

template <std::size_t bytes>
void moveTo(std::span<const Scatters::Place> places, const std::byte* from, std::byte* const* to) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Scatters::Place place = places[i];
    std::memcpy(to[place.bucket] + place.position * bytes, from + i * bytes, bytes);
  }
}

void moveTo(std::size_t bytes, std::span<const Scatters::Place> places, const std::byte* from,
            std::byte* const* to) {
  switch (bytes) {
    case 1: return moveTo<1>(places, from, to);
    case 2: return moveTo<2>(places, from, to);
    case 4: return moveTo<4>(places, from, to);
    case 8: return moveTo<8>(places, from, to);
    default: return moveTo<mostScalarBytes>(places, from, to);
  }
}

}  // namespace

Scatters::Scatters(const program::Kernel& kernel, const CodeFrame& frame, const CodeChoice& choice)
    : frame_(frame) {
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    const native::Argument& argument = frame.arguments()[i];
    if (parameter.role != program::Role::Scatter || argument.components == nullptr) continue;
    std::int64_t last = 0;
    for (std::size_t d = 0; d < 4; ++d) last += (argument.extent[d] - 1) * argument.stride[d];
    last = std::max<std::int64_t>(last, 0);  // an empty output has no records
    int shift = leastShift;
    while (last >> shift >= static_cast<std::int64_t>(mostBuckets)) ++shift;
    const auto buckets = static_cast<std::size_t>(last >> shift) + 1;
    targets_.push_back({i, RecordShape(parameter, choice.real, false), argument.first, shift, buckets});
  }
  if (targets_.empty()) return;
  function_ = functionOf<native::ApplyFunction>(entryOf(kernel, native::EntryKind::Apply, choice));
}

void Scatters::apply(RecordFrame& records) const {
  for (RecordFrame::Output& output : records.scattered()) {
    function_(frame_.get(), output.buffer->appendBuffer(), static_cast<std::int64_t>(output.parameter));
    output.buffer->clear();
  }
}

std::unique_ptr<Scatters::Log> Scatters::newLog() {
  {
    const std::lock_guard lock(mutex_);
    if (!unused_.empty()) {
      std::unique_ptr<Log> log = std::move(unused_.back());
      unused_.pop_back();
      return log;
    }
  }
  auto log = std::make_unique<Log>();
  for (const Target& target : targets_) {
    auto& buckets = log->buckets.emplace_back();
    for (std::size_t b = 0; b < target.buckets; ++b)
      buckets.push_back(std::make_unique<RecordBuffer>(target.shape));
  }
  return log;
}

void Scatters::move(RecordFrame& records, Log& log) const {
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    RecordBuffer& buffer = *records.scattered()[k].buffer;
    distribute(buffer, targets_[k], log, log.buckets[k]);
    buffer.clear();
  }
}

void Scatters::distribute(const RecordBuffer& records, const Target& target, Log& log,
                          std::span<const std::unique_ptr<RecordBuffer>> buckets) {
  const auto count = static_cast<std::size_t>(records.count());
  if (log.places.size() < count) resizeChecked(log.places, count);
  const std::span<Place> places(log.places.data(), count);
  const std::int64_t* const targets = records.records().targets;
  const std::int64_t first = target.first;
  const int shift = target.shift;
  std::array<std::uint32_t, mostBuckets> counts{};
  std::array<std::int64_t, mostBuckets> next{};
  for (std::size_t i = 0; i < count; ++i) {
    const auto bucket = static_cast<std::uint32_t>((targets[i] - first) >> shift);
    places[i] = {bucket, counts[bucket]++};
  }
  std::array<std::byte*, mostBuckets> to{};
  for (std::size_t b = 0; b < buckets.size(); ++b) {
    const std::int64_t before = buckets[b]->count();
    buckets[b]->reserve(before + counts[b]);
    buckets[b]->addUnwritten(counts[b]);
    next[b] = before;
  }
  const std::span<const std::size_t> bytes = buckets[0]->bytes();
  for (std::size_t column = 0; column < bytes.size(); ++column) {
    for (std::size_t b = 0; b < buckets.size(); ++b)
      to[b] = buckets[b]->array(column) + static_cast<std::size_t>(next[b]) * bytes[column];
    moveTo(bytes[column], places, records.array(column), to.data());
  }
}

void Scatters::add(std::int64_t order, std::unique_ptr<Log> log) {
  log->order = order;
  const std::lock_guard lock(mutex_);
  logs_.push_back(std::move(log));
}

void Scatters::applyLogs() {
  std::ranges::sort(logs_, {}, [](const auto& log) { return log->order; });
  std::vector<std::pair<std::size_t, std::size_t>> work;
  std::int64_t records = 0;
  for (std::size_t k = 0; k < targets_.size(); ++k) {
    for (std::size_t b = 0; b < targets_[k].buckets; ++b) {
      work.emplace_back(k, b);
      for (const auto& log : logs_) records += log->buckets[k][b]->count();
    }
  }
  const auto count = static_cast<std::int64_t>(work.size());
  const std::int64_t cost = count == 0 ? 0 : records / count;  // no work if all outputs are omitted
  native::inParallel(count, cost, native::Deal::AsTheyCome, [&](native::Range range) {
    for (std::int64_t i = range.begin; i < range.end; ++i) {
      const auto& [target, bucket] = work[static_cast<std::size_t>(i)];
      applyBucket(target, bucket);
    }
  });
  std::ranges::move(logs_, std::back_inserter(unused_));
  logs_.clear();
}

void Scatters::applyBucket(std::size_t target, std::size_t bucket) const {
  for (const auto& log : logs_) {
    RecordBuffer& records = *log->buckets[target][bucket];
    function_(frame_.get(), records.appendBuffer(), static_cast<std::int64_t>(targets_[target].parameter));
    records.clear();
  }
}

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
