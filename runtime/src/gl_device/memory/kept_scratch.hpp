// SPDX-License-Identifier: MIT
//
// Scratch of calls, whose memory is kept for the next call, so that a repeated call allocates none.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace sk {

template <class T>
class KeptScratch {
 public:
  /// The scratch of one call: it owns the memory as long as this object lives, and another lease meanwhile gets memory of its own.
  class Lease {
   public:
    explicit Lease(KeptScratch& kept) : values(std::move(kept.values_)), kept_(kept) {
      kept_.values_.clear();
    }
    ~Lease() {
      if (values.capacity() > kept_.values_.capacity()) values.swap(kept_.values_);
    }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;

    /// The first `count` values: what an earlier call has left there, or zeros.
    T* room(std::size_t count) {
      if (values.size() < count) values.resize(count);
      return values.data();
    }

    std::vector<T> values;

   private:
    KeptScratch& kept_;
  };

 private:
  std::vector<T> values_;
};

}  // namespace sk
