// SPDX-License-Identifier: MIT
//
// What the public functions of the runtime tell the recorder of SK_RESULTS. All of it does nothing if the device has none.
#pragma once

#include <exception>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "device/device_state.hpp"
#include "device/internal_work.hpp"
#include "results/recorder.hpp"

namespace sk::results {

using sk::InternalWork;

/// The recorder, unless the runtime works on its own.
inline Recorder* recorderOf(const DeviceState& device) {
  return device.internalWork == 0 ? device.results : nullptr;
}

/// Measures a call for as long as it lives. The parts of the call are internal work.
class CallScope {
 public:
  CallScope(DeviceState& device, std::string_view kernel)
      : recorder_(recorderOf(device)), device_(device), kernel_(kernel), work_(device) {
    if (recorder_ == nullptr) return;
    if (recorder_->measures() && device_.hasQueue()) {
      device_.finish();
      hasOwnClock_ = device_.beginMeasuring();
    }
    begin_ = Trace::now();
  }
  ~CallScope() {
    if (recorder_ != nullptr) end();
  }
  CallScope(const CallScope&) = delete;
  CallScope& operator=(const CallScope&) = delete;

 private:
  void end() noexcept {
    Recorder::Time end = 0;
    try {
      if (hasOwnClock_) {
        end = begin_ + device_.endMeasuring();
      } else if (recorder_->measures() && device_.hasQueue()) {
        device_.finish();
      }
    } catch (const std::exception&) {
      return;  // the device is lost; the next operation says so
    }
    if (!hasOwnClock_) end = Trace::now();
    recorder_->addTime(kernel_, begin_, end, recorder_->measures() || !device_.hasQueue());
  }

  Recorder* const recorder_;
  DeviceState& device_;
  const std::string_view kernel_;
  const InternalWork work_;
  Recorder::Time begin_ = 0;
  bool hasOwnClock_ = false;  ///< the call is measured by the device's clock, without the time of the waits
};

/// Adds a call that has been checked.
inline void noteCall(const DeviceState& device, const program::Kernel& kernel,
                     const program::Reduction* reduction, const CallOptions& called,
                     const CallOptions& used) {
  if (Recorder* const recorder = recorderOf(device))
    recorder->addCall(device, kernel, reduction, called, used);
}

/// Adds the elements that the host has read from a region without strides.
inline void noteRead(const StreamRegion& dense, const StreamState& stream, const std::byte* elements) {
  Recorder* const recorder = recorderOf(*stream.device);
  if (recorder == nullptr) return;
  const auto count = static_cast<std::size_t>(dense.shape.size());
  std::size_t components = 0;
  for (const program::Field& field : stream.element->fields) {
    components += field.scalar == program::Scalar::Float ? field.width : 0;
    if (field.scalar != program::Scalar::Float || !stream.device->isReference())
      return recorder->addRead(stream, elements, count);
  }
  std::vector<double> values(components * count);
  dense.stream->readReals(dense, values.data());
  recorder->addReals(stream, values, Values::Kind::Double);
}

/// Adds what readReals() returns.
inline void noteReals(const StreamState& stream, std::span<const double> components) {
  Recorder* const recorder = recorderOf(*stream.device);
  if (recorder == nullptr || components.empty()) return;
  const bool isWide = stream.device->isReference() || stream.storage >= Storage::Extended;
  recorder->addReals(stream, components, isWide ? Values::Kind::Double : Values::Kind::Single);
}

/// Notes that the application gets elements by other ways than reads.
inline void noteHandedOut(const StreamState& stream, std::string_view how) {
  Recorder* const recorder = recorderOf(*stream.device);
  if (recorder == nullptr) return;
  recorder->addNote(
      fmt::format("what the program does with elements that it takes by {}() is left out", how));
}

}  // namespace sk::results
