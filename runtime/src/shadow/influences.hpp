// SPDX-License-Identifier: MIT
//
// How much the errors of each input of a kernel count in its outputs: what a call inherits is divided by them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

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

  /// What the last compared call of a kernel has shown of an output.
  struct Compared {
    double own = 0;  ///< the error that it has added, relative
    double amplification = 1;  ///< of the errors of its inputs
  };
  void setCompared(const program::Kernel& kernel, std::size_t output, const Compared& compared) {
    compared_[{&kernel, output}] = compared;
  }
  Compared comparedOf(const program::Kernel& kernel, std::size_t output) const {
    const auto found = compared_.find({&kernel, output});
    return found == compared_.end() ? Compared{} : found->second;
  }

 private:
  std::map<const program::Kernel*, std::int64_t> asked_;
  std::map<std::pair<const program::Kernel*, std::size_t>, Compared> compared_;
  std::map<std::tuple<const program::Kernel*, std::size_t, std::size_t>, double> factors_;
};

}  // namespace sk::shadow
