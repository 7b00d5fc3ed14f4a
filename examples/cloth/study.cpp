// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace examples {

const std::vector<ClothStudy>& studies() {
  static const std::vector<ClothStudy> all = {
      {"fall", "does a point fall as far as it should, however small the step?", studyFall},
      {"pendulum", "is the period of a pendulum the closed form's?", studyPendulum},
      {"catenary", "does a chain hang in a catenary?", studyCatenary},
      {"energy", "what becomes of the energy in 100,000 steps?", studyEnergy},
      {"stability", "where is the limit of the time step, and where should it be?", studyStability},
      {"chaos", "how do single and double precision part, and what do they agree on?", studyChaos},
      {"cost", "what does each part of the model cost, beside all of it?", studyCost},
  };
  return all;
}

const ClothStudy& findStudy(std::string_view name) {
  std::string names;
  for (const ClothStudy& study : studies()) {
    if (study.name == name) return study;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", study.name);
  }
  throw std::runtime_error(fmt::format("no study is called '{}'; there are {}", name, names));
}

const std::vector<Trial>& trials() {
  static const std::vector<Trial> all = {
      {"positions, single", Verlet::Positions, sk::Precision::Single},
      {"displacements, single", Verlet::Displacements, sk::Precision::Single},
      {"displacements, extended", Verlet::Displacements, sk::Precision::Extended},
      {"displacements, double", Verlet::Displacements, sk::Precision::Double},
  };
  return all;
}

Simulation simulate(sk::Device& device, const Scene& scene, sk::Precision precision) {
  return {device, scene, Features::of(scene), precision};
}

std::string row(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string heads(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) line += i == 0 ? "---|" : "---:|";
  return row(cells) + line + "\n";
}

}  // namespace examples
