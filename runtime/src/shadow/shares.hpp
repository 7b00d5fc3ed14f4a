// SPDX-License-Identifier: MIT
//
// Whose errors the error of a stream consists of: a share for each kernel. A call passes on the shares of what it inherited,
// and adds its own.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace sk::shadow {

/// The number of a kernel in the report; values that the application wrote have a number of their own, and so has what calls added
/// that were not compared.
inline constexpr int writtenByHost = -1, notCompared = -2;

struct Share {
  int kernel;
  double share;
};

class Shares {
 public:
  void add(int kernel, double share) {
    if (!(share > 0)) return;
    const auto found = std::ranges::find(all_, kernel, &Share::kernel);
    if (found == all_.end()) {
      all_.push_back({kernel, share});
    } else {
      found->share += share;
    }
  }
  void add(const Shares& other, double factor) {
    for (const auto& [kernel, share] : other.all_) add(kernel, share * factor);
  }
  /// The same for other numbers of kernels.
  template <class NumberOf>
  Shares renumbered(NumberOf&& numberOf) const {
    Shares others;
    for (const Share& each : all_) others.add(numberOf(each.kernel), each.share);
    return others;
  }
  double sum() const {
    double sum = 0;
    for (const Share& each : all_) sum += each.share;
    return sum;
  }
  /// Makes them add up to 1, without those that are next to nothing.
  void normalize() {
    const double whole = sum();
    if (whole <= 0) return all_.clear();
    for (Share& each : all_) each.share /= whole;
    std::erase_if(all_, [](const Share& each) { return each.share < 1e-9; });
  }
  const std::vector<Share>& all() const { return all_; }
  template <class Archive>
  void visitMembers(Archive& archive) {
    archive(all_);
  }

 private:
  std::vector<Share> all_;
};

}  // namespace sk::shadow
