// SPDX-License-Identifier: MIT
//
// Carries out the records of scatter outputs (sk/native/code.hpp) as if elements ran one after another. One thread does so after each
// chunk. Several threads keep logs of what their elements store, divided by where it goes: into buckets, each a range of the
// target's elements. A bucket then belongs to one thread, which goes through the logs in the order of elements.
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

/// The scatter outputs of one call that are not left out.
class Scatters {
 public:
  /// The kernel and the frame must outlive this.
  Scatters(const program::Kernel& kernel, const CodeFrame& frame, const CodeChoice& choice);

  /// For a single thread: carries out the records of a frame, and clears them.
  void apply(RecordFrame& records) const;

  /// Where a record goes: to which bucket, behind how many others of its chunk.
  struct Place {
    std::uint32_t bucket, position;
  };
  /// Records of neighbouring elements: for each output, its buckets.
  struct Log {
    std::int64_t order = 0;
    std::vector<std::vector<std::unique_ptr<RecordBuffer>>> buckets;
    std::vector<Place> places;
  };
  /// An empty log. Any thread may ask for one.
  std::unique_ptr<Log> newLog();
  /// Moves the records of a frame to a log.
  void move(RecordFrame& records, Log& log) const;
  /// Any thread may add the log of the elements from number `order` on.
  void add(std::int64_t order, std::unique_ptr<Log> log);
  /// Carries out all logs, in order, on all threads.
  void applyLogs();

 private:
  struct Target {
    std::size_t parameter;
    RecordShape shape;
    std::int64_t first;  ///< number of its first element
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
