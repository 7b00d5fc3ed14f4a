// SPDX-License-Identifier: MIT
//
// Kernels against GLSL written by hand, which must also agree in every bit. Both sides get new textures
// three times: where textures happen to lie in memory is worth some per cent.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <sk/sk.hpp>

#include "hand_written.hpp"
#include "report.hpp"
#include "rounds.hpp"

namespace bench {

/// How long everything is measured.
struct Patience {
  int rounds;
  double sampleMilliseconds;
};

/// Numbers in [0, 1) to work on.
std::vector<float> ramp(std::int64_t size, float step);

class SideBySide {
 public:
  SideBySide(sk::Device& device, const PlainContext& context, Patience patience, Report& report)
      : device_(device), context_(context), patience_(patience), report_(report) {}

  void saxpy(int size);
  void binomial(int size);
  /// One program against itself: how far from 1 this machine puts a ratio for no reason.
  void control(int size);

 private:
  using Inputs = std::vector<std::vector<float>>;
  using Call =
      std::function<void(const sk::Stream<float>& x, const sk::Stream<float>& y, sk::Stream<float>& r)>;

  void against(const std::string& name, std::optional<double> limit, const Call& call, const char* text,
               int size, const Inputs& inputs);
  void compare(const Contender& ours, const Contender& theirs, Comparison& rounds) const;

  sk::Device& device_;
  const PlainContext& context_;
  Patience patience_;
  Report& report_;
};

}  // namespace bench
