// SPDX-License-Identifier: MIT
//
// What a run observes, as lines of comma-separated values, one a frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "scene.hpp"
#include "simulation.hpp"

namespace examples {

class TableFile {
 public:
  /// Creates the file's folder. Throws std::runtime_error where it cannot be written.
  explicit TableFile(const std::filesystem::path& file);
  /// A line for the cloth as it is now.
  void add(const Simulation& simulation, const Scene& scene);
  void finish();

 private:
  std::string name_;
  std::ofstream file_;
  std::int64_t linksAtFirst_ = 0;
};

}  // namespace examples
