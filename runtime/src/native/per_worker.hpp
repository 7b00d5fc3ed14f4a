// SPDX-License-Identifier: MIT
//
// What each thread of a loop needs for itself and keeps from range to range.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace sk {

/// An object for each thread of a loop (sk/native/parallel.hpp), made when the thread first needs it.
template <class T>
class PerWorker {
 public:
  explicit PerWorker(std::int64_t threads) : ofHelpers_(static_cast<std::size_t>(threads - 1)) {}

  /// The worker's own object, made from these arguments if there is none.
  template <class... Arguments>
  T& of(int worker, const Arguments&... arguments) {
    if (worker == 0) return ofCaller_ ? *ofCaller_ : ofCaller_.emplace(arguments...);
    std::unique_ptr<T>& own = ofHelpers_[static_cast<std::size_t>(worker) - 1];
    if (!own) own = std::make_unique<T>(arguments...);
    return *own;
  }

 private:
  std::optional<T> ofCaller_;
  std::vector<std::unique_ptr<T>> ofHelpers_;
};

}  // namespace sk
