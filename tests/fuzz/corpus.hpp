// SPDX-License-Identifier: MIT
//
// The programs that mutations start from: every .sk file of some folders, and every whole program in a Markdown
// page's ```sk blocks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "random.hpp"

namespace fuzz {

struct Program {
  std::string path;  ///< where its own includes are looked for
  std::string text;
};

class Corpus {
 public:
  /// In an order that does not depend on the file system. Throws std::runtime_error where there is none.
  explicit Corpus(const std::vector<std::filesystem::path>& folders);

  /// Short programs come more often: they compile faster, and a mutation hits more of what matters.
  const Program& pick(Random& random) const;
  const std::vector<Program>& programs() const { return programs_; }

 private:
  std::vector<Program> programs_;
  std::vector<std::size_t> weights_;  ///< sums up to and with each
};

}  // namespace fuzz
