// SPDX-License-Identifier: MIT
//
// Records what a device does as slices and counters in the file that SK_TRACE names. A device's Trace is null
// if there is none, so that tracing then costs only a test. Times come from the host's clock;
// gl_device/pass/pass_trace.hpp measures passes on a GPU.
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

/// Describes a pass.
struct PassRecord {
  std::string kernel;
  std::string step;  ///< step of a reduction or plan: "fold", "tree" ...; empty if there is one pass
  std::string_view kind;  ///< "draw", "copy", "native"
  std::string domain;  ///< number of elements, or texels, in each dimension
  std::int64_t bytesRead = 0;  ///< counts each texel of the inputs once
  std::int64_t bytesWritten = 0;

  void addTo(PassCount& count) const;
};

class Trace {
 public:
  /// Nanoseconds of the monotonic clock, which all processes share.
  using Time = std::int64_t;
  static Time now();

  /// Throws sk::Error if the file cannot be written.
  Trace(const std::string& file, std::string_view device);
  ~Trace();
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;

  /// The copy bandwidth to compare passes with: bytes read and written per nanosecond; 0 disables the
  /// comparison.
  void setBandwidth(double bandwidth) { bandwidth_ = bandwidth; }
  /// Record a pass on the track of the host or of the device. `clock` names the source of the device's times.
  void hostPass(const PassRecord& pass, Time begin, Time end);
  void devicePass(const PassRecord& pass, Time begin, Time end, std::string_view clock);
  /// Records the current bytes of the device's streams and temporaries, and of the memory kept for reuse.
  void countBytes(std::int64_t used, std::int64_t kept) noexcept;

  /// Throws sk::Error, once, if the file could not be written since the last call.
  void throwFailure();

 private:
  friend class TraceScope;
  struct Open {
    std::string_view category;
    std::string name;
    std::string arguments;  ///< JSON members, each preceded by a comma
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
  std::string counter_;  ///< the counter's name
  std::vector<std::int64_t> threads_;  ///< threads that have a name in the file
  std::vector<Open> open_;
  std::string events_;  ///< not yet written
  bool isReported_ = false;  ///< a failure of the file has been reported
};

/// A slice of the calling thread's track that lasts as long as this object; does nothing if `trace` is null.
/// The end of the outermost slice writes all events.
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
