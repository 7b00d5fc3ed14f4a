// SPDX-License-Identifier: MIT
//
// What a device does, as slices and counters of the file that SK_TRACE names. A device has a Trace, or null: then
// nothing costs more than the test for it. It times by the host's clock alone; the time of passes on a GPU is
// gl_device/pass/pass_trace.hpp's business.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sk/device.hpp"
#include "sk/shape.hpp"
#include "trace/trace_file.hpp"

namespace sk {

/// What the trace tells of a pass.
struct PassRecord {
  std::string kernel;
  std::string step;  ///< of a kernel's passes: "fold", "tree" ...; empty where there is just one
  std::string_view kind;  ///< "draw", "copy", "native"
  std::string domain;  ///< how many elements, or texels, in each direction
  std::int64_t bytesRead = 0;  ///< each texel of the inputs once
  std::int64_t bytesWritten = 0;

  void addTo(PassCount& count) const;
};

class Trace {
 public:
  /// Nanoseconds of the monotonic clock, which all processes share.
  using Time = std::int64_t;
  static Time now();

  /// Throws sk::Error where the file cannot be written.
  Trace(const std::string& file, std::string_view device);
  ~Trace();
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;

  /// What passes are measured by: bytes that the device copies in a nanosecond, read and written ones; 0: nothing.
  void setBandwidth(double bandwidth) { bandwidth_ = bandwidth; }
  /// A pass on the tracks of the host and of the device. `clock`: what told the device's times.
  void hostPass(const PassRecord& pass, Time begin, Time end);
  void devicePass(const PassRecord& pass, Time begin, Time end, std::string_view clock);
  /// The bytes of the device's streams and temporaries from now on, and those kept for new ones.
  void countBytes(std::int64_t used, std::int64_t kept) noexcept;

  /// Throws sk::Error where the file could not be written lately; once.
  void throwFailure();

 private:
  friend class TraceScope;
  struct Open {
    std::string_view category;
    std::string name;
    std::string arguments;  ///< JSON, each with a comma before it
    Time begin;
    int exceptions;
  };

  void open(std::string_view category, std::string_view name);
  void close() noexcept;
  void addSlice(std::int64_t track, std::string_view category, std::string_view name, Time begin, Time end,
                std::string_view arguments);
  void addEvent(std::string_view event);
  std::int64_t hostTrack();
  void write() noexcept;

  TraceFile file_;
  double bandwidth_ = 0;
  std::int64_t deviceTrack_;
  std::string counter_;  ///< its name
  std::vector<std::int64_t> threads_;  ///< that have a name in the file
  std::vector<Open> open_;
  std::string events_;  ///< not yet written
  bool isTold_ = false;  ///< of the file's failure
};

/// A slice of the calling thread's track for as long as this lives; nothing where `trace` is null. At the end of the
/// outermost one everything is written.
class TraceScope {
 public:
  TraceScope(Trace* trace, std::string_view category, std::string_view name) : trace_(trace) {
    if (trace_ != nullptr) trace_->open(category, name);
  }
  ~TraceScope() {
    if (trace_ != nullptr) trace_->close();
  }
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;

  void add(std::string_view name, std::string_view text) const {
    if (trace_ != nullptr) addText(name, text);
  }
  void add(std::string_view name, const Shape& shape) const {
    if (trace_ != nullptr) addText(name, toString(shape));
  }
  void add(std::string_view name, std::int64_t number) const {
    if (trace_ != nullptr) addNumber(name, number);
  }

 private:
  void addText(std::string_view name, std::string_view text) const;
  void addNumber(std::string_view name, std::int64_t number) const;

  Trace* trace_;
};

}  // namespace sk
