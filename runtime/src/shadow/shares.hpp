// SPDX-License-Identifier: MIT
//
// Whose errors the error of a stream consists of: a share for each kernel. A call passes on the shares of what it inherited,
// and adds its own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace sk::shadow {

/// The number of a kernel in the report; values that the application wrote have a number of their own.
inline constexpr int writtenByHost = -1;

class Shares {
 public:
  void add(int kernel, double share) {
    if (!(share > 0)) return;
    const auto found = std::ranges::find(all_, kernel, &std::pair<int, double>::first);
    if (found == all_.end()) {
      all_.emplace_back(kernel, share);
    } else {
      found->second += share;
    }
  }
  void add(const Shares& other, double factor) {
    for (const auto& [kernel, share] : other.all_) add(kernel, share * factor);
  }
  double sum() const {
    double sum = 0;
    for (const auto& each : all_) sum += each.second;
    return sum;
  }
  /// Makes them add up to 1, without those that are next to nothing.
  void normalize() {
    const double whole = sum();
    if (whole <= 0) return all_.clear();
    for (auto& each : all_) each.second /= whole;
    std::erase_if(all_, [](const auto& each) { return each.second < 1e-9; });
  }
  const std::vector<std::pair<int, double>>& all() const { return all_; }

 private:
  std::vector<std::pair<int, double>> all_;
};

}  // namespace sk::shadow
