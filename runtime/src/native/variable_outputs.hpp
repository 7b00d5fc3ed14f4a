// SPDX-License-Identifier: MIT
//
// What object code pushes to variable outputs. The results are in the order of elements, whatever the number of threads. Rooms
// hold outputs whose number of elements has a small bound; the parts of others are joined at the end.
//
// Carries out the records of scatter outputs (sk/native/code.hpp) as if elements ran one after another. A
// single thread does so after each chunk. Several threads log what their elements store in buckets, each for
// a range of the target's elements. A bucket then belongs to one thread, which carries out its logs in the
// order of elements.
//
// Memory for the records that object code appends for variable and scatter outputs (sk/native/code.hpp), and
// their sorting. Each thread has its own buffers.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "native/call.hpp"
#include "native/components.hpp"
#include "native/entries.hpp"
#include "native/memory.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

/// The format of one output's records.
struct RecordShape {
  std::vector<std::size_t> bytes;  ///< size of each component
  bool hasTarget;  ///< it is a scatter output
  bool hasElement;  ///< records carry element numbers

  RecordShape(const program::Parameter& parameter, RealType real, bool isReordered);
};

class RecordBuffer {
 public:
  explicit RecordBuffer(const RecordShape& shape);
  RecordBuffer(const RecordBuffer&) = delete;
  RecordBuffer& operator=(const RecordBuffer&) = delete;

  native::AppendBuffer* appendBuffer() { return &appendBuffer_; }
  const native::AppendBuffer& records() const { return appendBuffer_; }
  std::int64_t count() const { return appendBuffer_.count; }
  /// The size of a value in each array, and the address of the array: the components, then the targets.
  std::span<const std::size_t> bytes() const { return {bytes_.data(), sortedColumns_}; }
  std::byte* array(std::size_t column) const { return pointers_[column]; }

  /// Makes room for `count` records in all. Throws NoMemory (support/checked_size.hpp).
  void reserve(std::int64_t count);
  /// Adds records whose arrays the caller then writes; there must be room for them.
  void addUnwritten(std::int64_t count) { appendBuffer_.count += count; }
  void clear() { appendBuffer_.count = sorted_ = 0; }
  /// Appends to these arrays, one for each component, which have room for `capacity` records and mostLanes more. Only for
  /// records without targets and element numbers. release() returns the arrays.
  void adopt(std::vector<ArrayMemory>&& arrays, std::int64_t capacity);
  std::vector<ArrayMemory> release() { return std::exchange(arrays_, {}); }

  /// Sorts the records since the last call, all of one chunk, by element; stable. Does nothing if records
  /// carry no element numbers.
  void sort();

 private:
  struct AppendBuffer : native::AppendBuffer {
    RecordBuffer* buffer;
  };
  void setPointers();
  void permute(std::size_t column, std::int64_t first, std::span<const std::size_t> positions);

  AppendBuffer appendBuffer_;
  std::vector<std::size_t> bytes_;
  std::size_t sortedColumns_;  ///< all arrays except element numbers
  bool hasTarget_;
  bool hasElement_;
  std::vector<ArrayMemory> arrays_;
  std::vector<std::byte*> pointers_;
  std::int64_t sorted_ = 0;  ///< number of records that are sorted
  std::vector<std::size_t> starts_, positions_;
  std::vector<std::byte> copy_;
};

/// What code records during a call.
struct RecordOptions {
  RealType real;
  bool isReordered;  ///< records carry element numbers
  bool scatters;  ///< also records scatter outputs, which code otherwise stores to immediately
};

/// The arguments of a call, with the buffers of one thread as append buffers.
class RecordFrame {
 public:
  RecordFrame(const program::Kernel& kernel, const CodeFrame& frame, const RecordOptions& options);

  const native::Frame* get() const { return &frame_; }
  void sort();

  struct Output {
    std::size_t parameter;
    std::unique_ptr<RecordBuffer> buffer;
  };
  /// The buffers of variable outputs, and those of scatter outputs that are recorded, in the order of
  /// parameters.
  std::span<Output> pushed() { return pushed_; }
  std::span<Output> scattered() { return scattered_; }

 private:
  std::vector<native::Argument> arguments_;
  native::Frame frame_;
  std::vector<Output> pushed_, scattered_;
};

/// Variable outputs whose number of elements has a small bound, because each element of the domain pushes only a few times. They
/// get arrays with room for that many, and no list grows. A single thread appends to the arrays themselves. Several threads
/// append the pushes of a slice of the domain to buffers of their own, which stay in a cache, and copy them to their
/// place, which is known as soon as all slices before have been computed: slices are dealt out in order.
class PushRooms {
 public:
  /// Whether all variable outputs of a kernel over so many elements can have such arrays.
  static bool mayHold(const program::Kernel& kernel, std::int64_t elements);

  /// Uses the arrays that the operands of variable outputs come with, if these have room. Throws NoMemory.
  PushRooms(const program::Kernel& kernel, const native::Call& call, RealType real, std::int64_t slices);

  /// For a single thread: lets code append to the arrays. settle() then takes them back.
  void lend(RecordFrame& frame);
  /// The next slice, or the number of slices after the last one. Thread-safe.
  std::int64_t next() { return std::min(next_++, slices_); }
  /// Copies what a slice has pushed to its place, and clears the buffers. Waits for earlier slices to be computed. Thread-safe.
  /// If another thread has failed, does nothing.
  void place(std::int64_t slice, RecordFrame& frame);
  /// Must be called if a slice cannot be placed, so that no thread waits for it.
  void fail() { hasFailed_ = true; }
  /// Gives the arrays to the operands of variable outputs.
  void settle(std::span<const native::Operand> operands);
  void settle(std::span<const native::Operand> operands, RecordFrame& lent);

 private:
  struct Output {
    native::Pushed pushed;
    std::vector<std::size_t> bytes;  ///< of a value in each array
    std::unique_ptr<std::atomic<std::int64_t>[]>
        ends;  ///< for each slice, the pushes up to its end; -1 if unknown
  };
  void copy(Output& output, const RecordBuffer& buffer, std::int64_t first);

  std::int64_t slices_;
  std::atomic<std::int64_t> next_ = 0;
  std::atomic<bool> hasFailed_ = false;
  std::vector<Output> outputs_;
};

/// Joins what threads push to variable outputs without such a bound.
class PushParts {
 public:
  /// Adds what a run of elements has pushed; parts are joined in ascending `order`. Thread-safe.
  void add(std::int64_t order, std::span<RecordFrame::Output> pushed);
  /// Joins all parts and gives them to the operands of variable outputs.
  void store(std::span<const native::Operand> operands);

 private:
  struct Part {
    std::int64_t order;
    std::vector<std::unique_ptr<RecordBuffer>> outputs;
  };
  native::Pushed joined(std::size_t output) const;

  std::mutex mutex_;
  std::vector<Part> parts_;
};

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
