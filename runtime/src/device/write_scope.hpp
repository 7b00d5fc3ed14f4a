// SPDX-License-Identifier: MIT
//
// A write as a transaction. Whoever changes elements of streams says first which streams these are, then that it begins, and at
// the end that they hold what was to be written. If an exception comes in between, their elements are lost
// (StreamState::isLost), since nobody knows which of them are old and which are new.
//
//   WriteScope writes;
//   writes.add(keys.stream);       // what may throw comes before begin()
//   ...
//   writes.begin();                // from here on the stream holds a mixture
//   copy(...);
//   writes.commit();               // it is whole again
//
// Scopes may lie within each other: a call of several steps has one around the scopes of its steps.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "device/stream_state.hpp"

namespace sk {

class WriteScope {
 public:
  WriteScope() = default;
  /// For streams in a list that outlives the scope. The writing has begun.
  explicit WriteScope(std::span<StreamState* const> streams) noexcept : given_(streams), hasBegun_(true) {}
  ~WriteScope() {
    if (hasBegun_) forEach([](StreamState& stream) { stream.markLost(); });
  }
  WriteScope(const WriteScope&) = delete;
  WriteScope& operator=(const WriteScope&) = delete;

  /// Adds a stream that will change, or has changed; null is ignored. Throws std::bad_alloc.
  void add(StreamState* stream) {
    if (stream == nullptr) return;
    if (fewCount_ < few_.size()) {
      few_[fewCount_++] = stream;
    } else {
      more_.push_back(stream);
    }
  }
  /// The first element is about to change.
  void begin() noexcept { hasBegun_ = true; }
  /// All elements have been written. The streams are whole, and what is added later belongs to the next writing.
  void commit() noexcept {
    forEach([](StreamState& stream) { stream.setWritten(); });
    hasBegun_ = false;
    fewCount_ = 0;
    more_.clear();
    given_ = {};
  }

 private:
  template <class Visit>
  void forEach(Visit&& visit) noexcept {
    for (std::size_t i = 0; i < fewCount_; ++i) visit(*few_[i]);
    for (StreamState* const stream : more_) visit(*stream);
    for (StreamState* const stream : given_) visit(*stream);
  }

  std::array<StreamState*, 4> few_{};  ///< so that a call that writes no more allocates nothing
  std::size_t fewCount_ = 0;
  std::vector<StreamState*> more_;
  std::span<StreamState* const> given_;
  bool hasBegun_ = false;
};

}  // namespace sk
