// SPDX-License-Identifier: MIT
//
// The programs to mutate: every .sk file of some folders, and every whole program in a ```sk block of a Markdown page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "random.hpp"

namespace fuzz {

struct Program {
  std::string path;  ///< its includes are searched for in the same folder
  std::string text;
};

class Corpus {
 public:
  /// Sorts the programs by path, so that their order does not depend on the file system. Throws std::runtime_error if there
  /// are none.
  explicit Corpus(const std::vector<std::filesystem::path>& folders);

  /// Prefers short programs: they compile faster, and a mutation is more likely to hit something that matters.
  const Program& pick(Random& random) const;
  const std::vector<Program>& programs() const { return programs_; }

 private:
  std::vector<Program> programs_;
  std::vector<std::size_t> weights_;  ///< inclusive prefix sums of the programs' weights
};

}  // namespace fuzz
