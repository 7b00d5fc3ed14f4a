// SPDX-License-Identifier: MIT
//
// Memory for the records that object code appends for variable and scatter outputs (sk/native/code.hpp), and
// their sorting. Each thread has its own buffers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "native/code_frame.hpp"
#include "native/components.hpp"
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

}  // namespace sk
