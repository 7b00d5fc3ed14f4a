// SPDX-License-Identifier: MIT
//
// Carries out the records of scatter outputs (sk/native/code.hpp) as if elements ran one after another. A
// single thread does so after each chunk. Several threads log what their elements store in buckets, each for
// a range of the target's elements. A bucket then belongs to one thread, which carries out its logs in the
// order of elements.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "native/code_frame.hpp"
#include "native/entries.hpp"
#include "native/record_buffer.hpp"
#include "sk/program.hpp"

namespace sk {

/// The scatter outputs of one call that are not omitted.
class Scatters {
 public:
  /// The kernel and the frame must outlive this.
  Scatters(const program::Kernel& kernel, const CodeFrame& frame, const CodeChoice& choice);

  /// Carries out the records of a frame and clears them; for a single thread.
  void apply(RecordFrame& records) const;

  /// The destination of a record: its bucket, and its position among the records that go there from one
  /// chunk.
  struct Place {
    std::uint32_t bucket, position;
  };
  /// The records of neighbouring elements: for each output, its buckets.
  struct Log {
    std::int64_t order = 0;
    std::vector<std::vector<std::unique_ptr<RecordBuffer>>> buckets;
    std::vector<Place> places;
  };
  /// Returns an empty log. Thread-safe.
  std::unique_ptr<Log> newLog();
  /// Moves the records of a frame to a log.
  void move(RecordFrame& records, Log& log) const;
  /// Adds a log; logs are carried out in ascending `order`. Thread-safe.
  void add(std::int64_t order, std::unique_ptr<Log> log);
  /// Carries out all logs, in order, on all threads.
  void applyLogs();

 private:
  struct Target {
    std::size_t parameter;
    RecordShape shape;
    std::int64_t first;  ///< number of the target's first element
    int shift;  ///< a bucket has 2^shift elements
    std::size_t buckets;
  };
  static void distribute(const RecordBuffer& records, const Target& target, Log& log,
                         std::span<const std::unique_ptr<RecordBuffer>> buckets);
  void applyBucket(std::size_t target, std::size_t bucket) const;

  const CodeFrame& frame_;
  native::ApplyFunction* function_ = nullptr;
  std::vector<Target> targets_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Log>> logs_, unused_;
};

}  // namespace sk
