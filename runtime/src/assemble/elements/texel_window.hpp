// SPDX-License-Identifier: MIT
//
// The packed texels around that of an invocation in which a body finds the neighbours of its four elements. They are variables of
// the program, filled before the body runs; compilers remove unused ones.
#pragma once

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "assemble/region_layout.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

class TexelWindow {
 public:
  /// A gather of rank 1 or 2, whose neighbours are at constant offsets.
  explicit TexelWindow(const program::Parameter& gather) : gather_(gather) {}

  /// How many texels away neighbours may be: left and right, and above and below.
  int reachInX() const { return (gather_.reach + lanes - 1) / lanes; }
  int reachInY() const { return gather_.rank == 1 ? 0 : gather_.reach; }
  std::string texelName(int x, int y) const {
    const auto part = [](int offset) { return fmt::format("{}{}", offset < 0 ? "m" : "", std::abs(offset)); };
    return fmt::format("sk_texel_{}_{}_{}", part(x), part(y), gather_.symbol);
  }

  /// Adds statements that set sk_v to the texel that is sk_c texels to the right and sk_d.y below.
  void chooseTexel(std::string_view type, std::vector<std::string>& lines) const {
    for (int y = -reachInY(); y <= reachInY(); ++y) {
      std::string row;
      for (int x = -reachInX(); x < reachInX(); ++x)
        row += fmt::format("sk_c == {} ? {} : ", x, texelName(x, y));
      row += texelName(reachInX(), y);
      lines.push_back(y == -reachInY() ? fmt::format("{} sk_v = {};", type, row)
                                       : fmt::format("if (sk_d.y == {}) sk_v = {};", y, row));
    }
  }

 private:
  const program::Parameter& gather_;
};

}  // namespace sk::assemble
