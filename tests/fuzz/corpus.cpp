// SPDX-License-Identifier: MIT
#include "corpus.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace fuzz {
namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Adds the ```sk blocks of a page, except bodies of kernels, which are no programs by themselves.
void addBlocks(const fs::path& page, std::vector<Program>& programs) {
  std::istringstream lines(textOf(page));
  std::string block;
  bool isInside = false;
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      if (isInside) {
        programs.push_back({page.string() + "." + std::to_string(++count) + ".sk", block});
      }
      isInside = !isInside && line.starts_with("```sk") && line.find("body") == std::string::npos;
      block.clear();
    } else if (isInside) {
      block += line + "\n";
    }
  }
}

}  // namespace

Corpus::Corpus(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      const fs::path& file = entry.path();
      if (file.extension() == ".sk") programs_.push_back({file.string(), textOf(file)});
      if (file.extension() == ".md") addBlocks(file, programs_);
    }
  }
  if (programs_.empty()) throw std::runtime_error("no .sk file to start from");
  std::ranges::sort(programs_, {}, &Program::path);
  std::size_t sum = 0;
  for (const Program& program : programs_) {
    sum += 1 + 20000 / (200 + program.text.size());
    weights_.push_back(sum);
  }
}

const Program& Corpus::pick(Random& random) const {
  const std::size_t at = random.below(weights_.back());
  const auto found = std::ranges::upper_bound(weights_, at);
  return programs_[static_cast<std::size_t>(found - weights_.begin())];
}

}  // namespace fuzz
