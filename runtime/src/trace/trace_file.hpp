// SPDX-License-Identifier: MIT
//
// The file of a trace: JSON in the trace event format, which Perfetto and chrome://tracing open. It is whole after each
// write, so that a process may end at any time. All devices of a process write to one file, each by an object of its
// own; the file itself is all that they share. What events mean is trace/trace.hpp's business.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace sk {

/// A text as a JSON string, with its quotes.
std::string quoted(std::string_view text);

class TraceFile {
 public:
  /// Begins the file, or joins in where this process has begun it; "%p" in the name stands for the number of the
  /// process. Throws sk::Error where it cannot be written.
  explicit TraceFile(const std::string& name);
  ~TraceFile();
  TraceFile(const TraceFile&) = delete;
  TraceFile& operator=(const TraceFile&) = delete;

  /// Names a new track. Its number is no thread's, and no other track's in this file.
  std::int64_t openTrack(std::string_view name);
  /// Adds events, one or more, with commas between them. What cannot be written is lost, and failure() says why.
  void append(std::string_view events) noexcept;

  /// Empty as long as everything could be written.
  const std::string& failure() const { return failure_; }

 private:
  void begin();
  void put(std::string_view events);

  std::string name_;
  int file_ = -1;
  std::string failure_;
};

}  // namespace sk
