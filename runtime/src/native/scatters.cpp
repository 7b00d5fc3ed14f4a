// SPDX-License-Identifier: MIT
#include "native/scatters.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "native/scalars.hpp"
#include "sk/native/parallel.hpp"

namespace sk {

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
  if (log.places.size() < count) log.places.resize(count);
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

}  // namespace sk
