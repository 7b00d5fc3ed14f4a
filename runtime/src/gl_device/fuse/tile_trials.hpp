// SPDX-License-Identifier: MIT
//
// What trials of tiles have found out, by loops that compute the same: so that one that is recorded again, or in another process,
// is not tried again.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "assemble/program/tile_program.hpp"

namespace sk {

class GlDevice;

/// The fastest way.
struct TileVerdict {
  int iterations = 0;  ///< that tiles compute at once; 0: loops run iteration by iteration
  std::array<int, 2> texels{};  ///< of TilePlan
  int invocations = 0;
  double gain = 0;  ///< how many times as fast the best tiles are as iteration by iteration

  bool isFor(const assemble::TilePlan& plan) const {
    return plan.iterations == iterations && plan.texels == texels && plan.invocations == invocations;
  }
};

class TileTrials {
 public:
  explicit TileTrials(const GlDevice& device) : device_(device) {}

  /// `loop` has everything on which the verdict depends, apart from the device.
  std::optional<TileVerdict> find(std::string_view loop);
  void keep(std::string_view loop, const TileVerdict& verdict);

 private:
  std::string key(std::string_view loop) const;

  const GlDevice& device_;
  std::map<std::string, TileVerdict> known_;
};

}  // namespace sk
