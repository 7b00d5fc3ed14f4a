// SPDX-License-Identifier: MIT
//
// How much the errors of each input of a kernel count in its outputs: what a call inherits is divided by them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>

#include "sk/program.hpp"

namespace sk::shadow {

/// The factor from the relative error of an input to that of an output, as some of a kernel's calls have shown it.
class Influences {
 public:
  /// Whether a call of the kernel is to be examined: the first, second, fourth, eighth ... that asks.
  bool isDue(const program::Kernel& kernel) {
    const std::int64_t count = ++asked_[&kernel];
    return (count & (count - 1)) == 0;
  }
  void set(const program::Kernel& kernel, std::size_t output, std::size_t input, double factor) {
    factors_[{&kernel, output, input}] = factor;
  }
  /// Nullopt if no call has shown it. Arguments are named by their numbers.
  std::optional<double> of(const program::Kernel& kernel, std::size_t output, std::size_t input) const {
    const auto found = factors_.find({&kernel, output, input});
    return found == factors_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::map<const program::Kernel*, std::int64_t> asked_;
  std::map<std::tuple<const program::Kernel*, std::size_t, std::size_t>, double> factors_;
};

}  // namespace sk::shadow
