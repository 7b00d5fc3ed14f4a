// SPDX-License-Identifier: MIT
//
// The file of a trace: JSON in the trace event format, which Perfetto and chrome://tracing open. It is
// complete after every write, because a process may end at any time. All devices of a process write to the
// same file, each through its own object; they share nothing else. Must not know what events mean
// (trace/trace.hpp does).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sk {

/// Quotes a text as a JSON string.
std::string jsonString(std::string_view text);

class TraceFile {
 public:
  /// Begins the file, or continues it if this process has begun it; "%p" in the name stands for the process
  /// id. Throws sk::Error if the file cannot be written.
  explicit TraceFile(const std::string& name);
  ~TraceFile();
  TraceFile(const TraceFile&) = delete;
  TraceFile& operator=(const TraceFile&) = delete;

  /// Names a new track. Its number differs from all thread ids and from all other tracks of this file.
  std::int64_t openTrack(std::string_view name);
  /// Appends one or more events, separated by commas. What cannot be written is lost, and failure() says why.
  void append(std::string_view events) noexcept;

  /// Empty unless a write has failed.
  const std::string& failure() const { return failure_; }

 private:
  void begin();
  void put(std::string_view events);

  std::string name_;
  int file_ = -1;
  std::string failure_;
};

}  // namespace sk
