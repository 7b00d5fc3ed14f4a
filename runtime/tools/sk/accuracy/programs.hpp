// SPDX-License-Identifier: MIT
//
// The programs that `sk accuracy` measures, each in its own file (sums.cpp has three).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "accuracy/experiment.hpp"
#include "accuracy/sum_data.hpp"
#include "sk/device.hpp"

namespace sk_tool {

/// The seed of all inputs.
inline constexpr unsigned inputSeed = 2004;

struct Measurement {
  std::size_t size = 0;  ///< elements
  int rounds = 0;  ///< timed rounds, at least 1
  std::optional<SumData> data = {};  ///< for sums; nullopt: all kinds
};

struct Program {
  std::string_view name;
  std::string_view about;
  std::vector<Experiment> (*measure)(sk::Device& device, const Measurement& measurement);
};

/// All of them.
std::span<const Program> programs();

std::vector<Experiment> measureSum(sk::Device& device, const Measurement& measurement);
std::vector<Experiment> measureDot(sk::Device& device, const Measurement& measurement);
std::vector<Experiment> measureMoments(sk::Device& device, const Measurement& measurement);
std::vector<Experiment> measureDiffusion(sk::Device& device, const Measurement& measurement);
std::vector<Experiment> measurePolynomial(sk::Device& device, const Measurement& measurement);
std::vector<Experiment> measureTranscendentals(sk::Device& device, const Measurement& measurement);
std::vector<Experiment> measureTables(sk::Device& device, const Measurement& measurement);

}  // namespace sk_tool
