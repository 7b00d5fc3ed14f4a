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
  void add(int kernel, double share) { add(all_, kernel, share); }
  void add(const Shares& other, double factor) {
    for (const auto& [kernel, share] : other.all_) add(kernel, share * factor);
    for (const auto& [kernel, share] : other.through_) add(through_, kernel, share * factor);
  }
  /// Nobody knows whose errors a share is: they arose in a kernel of which no call was compared, or that kernel has magnified them.
  void addThrough(int kernel, double share) {
    add(notCompared, share);
    add(through_, kernel, share);
  }
  /// The errors have passed through the same kernels as those of `other`, of which no call was compared.
  void addPath(const Shares& other, double factor) {
    for (const auto& [kernel, share] : other.through_) add(through_, kernel, share * factor);
  }
  /// The same for other numbers of kernels.
  template <class NumberOf>
  Shares renumbered(NumberOf&& numberOf) const {
    Shares others;
    for (const Share& each : all_) others.add(numberOf(each.kernel), each.share);
    for (const Share& each : through_) add(others.through_, numberOf(each.kernel), each.share);
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
    for (std::vector<Share>* const list : {&all_, &through_}) {
      for (Share& each : *list) each.share = whole > 0 ? std::min(1.0, each.share / whole) : 0;
      std::erase_if(*list, [](const Share& each) { return each.share < 1e-9; });
    }
  }
  const std::vector<Share>& all() const { return all_; }
  /// Kernels of which no call was compared, and which part of the errors has passed through each of them.
  const std::vector<Share>& through() const { return through_; }
  template <class Archive>
  void visitMembers(Archive& archive) {
    archive(all_, through_);
  }

 private:
  static void add(std::vector<Share>& list, int kernel, double share) {
    if (!(share > 0)) return;
    const auto found = std::ranges::find(list, kernel, &Share::kernel);
    if (found == list.end()) {
      list.push_back({kernel, share});
    } else {
      found->share += share;
    }
  }

  std::vector<Share> all_, through_;
};

}  // namespace sk::shadow
