// SPDX-License-Identifier: MIT
//
// The numerics of the cloth, measured on a device: each study prints a table in Markdown, as it stands in docs/feedback.md
// (studies.sh puts it there).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "scene.hpp"
#include "simulation.hpp"

namespace examples {

struct ClothStudy {
  std::string_view name;
  std::string_view asks;
  std::string (*run)(sk::Device& device);
};

/// All of them, in the order of the documentation.
const std::vector<ClothStudy>& studies();
/// Throws std::runtime_error, listing the names, for an unknown one.
const ClothStudy& findStudy(std::string_view name);

std::string studyFall(sk::Device& device);
std::string studyPendulum(sk::Device& device);
std::string studyCatenary(sk::Device& device);
std::string studyEnergy(sk::Device& device);
std::string studyStability(sk::Device& device);
std::string studyChaos(sk::Device& device);
std::string studyCost(sk::Device& device);

/// What studies have in common.
struct Trial {
  const char* name;
  Verlet verlet;
  sk::Precision precision;
};
/// The textbook's form and ours in single precision, ours in more.
const std::vector<Trial>& trials();
Simulation simulate(sk::Device& device, const Scene& scene, sk::Precision precision = sk::Precision::Single);
/// A row of a table in Markdown.
std::string row(const std::vector<std::string>& cells);
/// The heads, and the line below them.
std::string heads(const std::vector<std::string>& cells);

}  // namespace examples
