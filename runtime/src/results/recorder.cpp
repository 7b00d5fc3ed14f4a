// SPDX-License-Identifier: MIT
#include "results/recorder.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>

#include <pthread.h>
#include <unistd.h>

#include <fmt/format.h>

#include "device/configuration.hpp"
#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "results/members.hpp"
#include "sk/linked_file.hpp"
#include "support/process_name.hpp"

namespace sk::results {

namespace {

constinit std::atomic<int> forks = 0;

/// Writes the file when the process ends, or when the library that contains the runtime is unloaded.
struct WriteAtEnd {
  ~WriteAtEnd() {
    if (recorder != nullptr) recorder->write();
  }
  Recorder* const recorder;
};

Recorder* openRecorder() {
  const char* const setting = std::getenv("SK_RESULTS");
  if (setting == nullptr || *setting == '\0') return nullptr;
  ::pthread_atfork(nullptr, [] { forks.fetch_add(1, std::memory_order_relaxed); }, nullptr);
  return new Recorder(setting);  // never deleted: devices that outlive the end of main() still refer to it
}

std::string nameOf(const std::string& name, const Member& member) {
  return member.path.empty() ? name : fmt::format("{}.{}", name, member.path);
}

/// Empty if the stream is the runtime's own.
std::string nameOf(const StreamState& stream) {
  if (stream.resultNumber == 0 || stream.name.starts_with("sk::")) return {};
  if (!stream.name.empty()) return stream.name;
  if (stream.resultNumber == Recorder::scalarNumber) return "scalar";
  return fmt::format("stream {}", stream.resultNumber);
}

std::uint64_t hashOfValues(std::uint64_t hash, const Values& values) {
  const auto add = [&](std::uint64_t word) {
    hash = std::rotl((hash ^ word) * 0x9e3779b97f4a7c15, 29) * 0xbf58476d1ce4e5b9;
  };
  add(values.bytes.size());
  add(static_cast<std::uint64_t>(values.kind));
  std::size_t at = 0;
  for (; at + sizeof(std::uint64_t) <= values.bytes.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, values.bytes.data() + at, sizeof word);
    add(word);
  }
  std::uint64_t rest = 0;
  std::memcpy(&rest, values.bytes.data() + at, values.bytes.size() - at);
  add(rest);
  return hash;
}

/// What a read counts towards the limit: as many bytes as on a reference device, which gives doubles, so that the same reads are kept there.
std::size_t bytesAsDoubles(const Values& values) { return values.count() * sizeof(double); }

/// The variants and choices of a kernel, or of a reduction whose fold it is.
Kernel kernelOf(const DeviceState& device, const program::Kernel& kernel,
                const program::Reduction* reduction) {
  const bool isNative = device.kind() == "native";
  const bool hasHalf = reduction != nullptr ? reduction->half != nullptr : kernel.half != nullptr;
  const bool hasWide = reduction != nullptr ? reduction->wide != nullptr : kernel.wide != nullptr;
  const bool hasFloats = hasHalf || hasWide || !kernel.whyNotHalf.empty() || !kernel.whyNotWide.empty();
  Kernel result{.name = std::string(kernel.name),
                .device = device.name(),
                .isNative = isNative,
                .isOnReference = device.isReference(),
                .isReduce = reduction != nullptr,
                .hasFloats = hasFloats};
  if (!hasHalf) result.whyNotHalf = kernel.whyNotHalf;
  if (!hasWide && !isNative) result.whyNotWide = kernel.whyNotWide;
  result.compensates = reduction != nullptr && reduction->compensated != nullptr;
  result.sumsExactly = reduction != nullptr && !reduction->exact.empty();
  result.hasFastFunctions = !isNative && !kernel.intrinsics.empty();
  result.mayContract = hasFloats;
  for (const program::TableUse& use : kernel.tables) result.tables.emplace_back(use.table->function);
  return result;
}

/// The choices of a call, and "tables default" where it has none of tables.
std::vector<std::string> usedBy(const CallOptions& options) {
  std::vector<std::string> choices = choicesOf(options);
  for (const std::string_view key : {"precision", "accumulate", "intrinsics", "tables", "contraction"}) {
    const auto isOfKey = [&](const std::string& choice) {
      return choice.starts_with(fmt::format("{} ", key));
    };
    if (std::ranges::none_of(choices, isOfKey)) choices.push_back(fmt::format("{} default", key));
  }
  return choices;
}

void addNew(std::vector<std::string>& list, const std::vector<std::string>& more) {
  for (const std::string& each : more) {
    if (std::ranges::find(list, each) == list.end()) list.push_back(each);
  }
}

}  // namespace

Recorder* Recorder::ofProcess() {
  static const WriteAtEnd end{openRecorder()};
  return end.recorder;
}

Recorder::Recorder(std::string setting, std::uint64_t limit)
    : file_(std::move(setting)), limit_(limit), process_id_(::getpid()) {
  constexpr std::string_view times = ",times";
  if (file_.ends_with(times)) {
    file_.resize(file_.size() - times.size());
    measures_ = true;
  }
  file_ = withProcess(file_, std::to_string(process_id_));
}

/// Runs what adds to the record, in the process that began it.
template <class Add>
void Recorder::add(Add&& add) noexcept {
  if (::getpid() != process_id_) return;
  try {
    const std::lock_guard lock(mutex_);
    add();
    end_ = Trace::now();
  } catch (const std::exception&) {
    // out of memory: addNote() would need some, too; write() finds that reads are missing
  }
}

void Recorder::addDevice(const DeviceState& device) noexcept {
  add([&] {
    if (process_.devices.empty()) begin_ = Trace::now();
    const bool isNative = device.kind() == "native";
    process_.devices.push_back({device.name(), device.isReference(), isNative});
  });
}

std::uint32_t Recorder::addStream(std::string_view name, std::optional<Storage> chosenByFile,
                                  std::uint64_t bytes) noexcept {
  add([&] {
    ++streamCount_;
    if (!chosenByFile) return;
    auto found = streams_.find(name);
    if (found == streams_.end()) {
      found = streams_.emplace(name, Stream{.name = std::string(name)}).first;
    }
    found->second.storage = sk::nameOf(*chosenByFile);
    ++found->second.count;
    found->second.bytes += bytes;
  });
  return streamCount_;
}

void Recorder::keep(const std::string& name, Values values) {
  auto found = series_.find(name);
  if (found == series_.end()) {
    order_.push_back(name);
    found = series_.emplace(name, Recorded{.series = {.name = name}}).first;
  }
  Recorded& recorded = found->second;
  Series& series = recorded.series;
  series.hash = hashOfValues(series.hash, values);
  const bool isFirst = series.reads++ < Series::keptAtEnds;
  const std::size_t bytes = bytesAsDoubles(values);
  makeRoom(recorded, bytes);
  if (bytes_ + bytes > limit_) {
    series.droppedBytes += values.bytes.size();
    return;
  }
  bytes_ += bytes;
  if (isFirst) return series.first.push_back(std::move(values));
  recorded.last.push_back(std::move(values));
}

/// Drops the oldest of the last reads where there are enough of them, or where one more has no room.
void Recorder::makeRoom(Recorded& recorded, std::size_t bytes) {
  while (!recorded.last.empty() && (recorded.last.size() >= Series::keptAtEnds || bytes_ + bytes > limit_)) {
    if (recorded.last.size() < Series::keptAtEnds)
      recorded.series.droppedBytes += recorded.last.front().bytes.size();
    bytes_ -= bytesAsDoubles(recorded.last.front());
    recorded.last.pop_front();
  }
}

void Recorder::addComponents(const std::string& name, const program::Element& element,
                             const std::byte* elements, std::size_t count) {
  for (const Member& member : membersOf(element))
    keep(nameOf(name, member), valuesOf(member, element, elements, count));
}

void Recorder::addComponents(const std::string& name, const program::Element& element,
                             std::span<const double> components, Values::Kind kind) {
  for (const Member& member : membersOf(element))
    keep(nameOf(name, member), valuesOf(member, element, components, kind));
}

void Recorder::addRead(const StreamState& stream, const std::byte* elements, std::size_t count) noexcept {
  add([&] {
    if (const std::string name = nameOf(stream); !name.empty())
      addComponents(name, *stream.element, elements, count);
  });
}

void Recorder::addReals(const StreamState& stream, std::span<const double> components,
                        Values::Kind kind) noexcept {
  add([&] {
    if (const std::string name = nameOf(stream); !name.empty())
      addComponents(name, *stream.element, components, kind);
  });
}

void Recorder::addValue(const std::string& name, const program::Element& element,
                        const std::byte* value) noexcept {
  add([&] { addComponents(name, element, value, 1); });
}

void Recorder::addValue(const std::string& name, const program::Element& element,
                        std::span<const double> components) noexcept {
  add([&] { addComponents(name, element, components, Values::Kind::Double); });
}

void Recorder::addCall(const DeviceState& device, const program::Kernel& kernel,
                       const program::Reduction* reduction, const CallOptions& called,
                       const CallOptions& used) noexcept {
  add([&] {
    auto found = kernels_.find(kernel.name);
    if (found == kernels_.end()) {
      kernelOrder_.emplace_back(kernel.name);
      found = kernels_
                  .emplace(kernel.name,
                           Called{.kernel = kernelOf(device, kernel, reduction), .called = {}, .used = {}})
                  .first;
    }
    Called& call = found->second;
    isUnmeasured_ = isUnmeasured_ || (device.hasQueue() && !measures_);
    call.kernel.isNative = call.kernel.isNative && device.kind() == "native";
    call.kernel.isOnReference = call.kernel.isOnReference && device.isReference();
    if (!call.isNew && call.called == called && call.used == used) return;
    call.isNew = false;
    call.called = called;
    call.used = used;
    addNew(call.kernel.called, choicesOf(called));
    addNew(call.kernel.used, usedBy(used));
  });
}

void Recorder::addTime(std::string_view kernel, Time begin, Time end, bool isMeasured) noexcept {
  add([&] {
    const auto found = kernels_.find(kernel);
    if (found == kernels_.end()) return;
    Called& call = found->second;
    ++call.kernel.calls;
    if (!isMeasured) return;
    const double seconds = static_cast<double>(end - begin) * 1e-9;
    if (call.kernel.calls == 1) call.firstSeconds = seconds;
    call.kernel.seconds += seconds;
  });
}

void Recorder::addNote(std::string_view note) noexcept {
  add([&] { addNew(process_.notes, {std::string(note)}); });
}

Kernel Recorder::measured(const Called& call) const {
  Kernel kernel = call.kernel;
  if (!measures_ || kernel.calls < 2) return kernel;
  const auto calls = static_cast<double>(kernel.calls);
  kernel.seconds = (kernel.seconds - call.firstSeconds) * calls / (calls - 1);
  return kernel;
}

void Recorder::write() noexcept {
  if (::getpid() != process_id_) return;
  try {
    const std::lock_guard lock(mutex_);
    Process all = process_;
    all.span = static_cast<double>(end_ - begin_) * 1e-9;
    all.hasTimes = measures_ || !isUnmeasured_;
    all.linkedKernels = program::LinkedFile::namesOfAll().kernels;
    for (const std::string& name : kernelOrder_) all.kernels.push_back(measured(kernels_.find(name)->second));
    for (const auto& [name, stream] : streams_) all.streams.push_back(stream);
    for (const std::string& name : order_) {
      const Recorded& recorded = series_.find(name)->second;
      Series& series = all.series.emplace_back(recorded.series);
      series.last.assign(recorded.last.begin(), recorded.last.end());
      if (series.droppedBytes == 0) continue;
      all.notes.push_back(fmt::format("{} byte(s) of '{}' are left out, because results end at {} MiB",
                                      series.droppedBytes, name, limit_ >> 20));
    }
    if (const int count = forks.load(std::memory_order_relaxed); count != 0) {
      all.notes.push_back(
          fmt::format("the program has forked {} time(s); what its children read is left out", count));
    }
    const std::string temporary = fmt::format("{}.{}", file_, process_id_);
    std::ofstream out(temporary, std::ios::binary);
    out << toBytes(all);
    out.close();
    std::error_code failed;
    if (out) std::filesystem::rename(temporary, file_, failed);
    if (!out || failed) std::filesystem::remove(temporary, failed);
  } catch (const std::exception&) {
    // out of memory: there is no file, which sk tune reports
  }
}

}  // namespace sk::results
