// SPDX-License-Identifier: MIT
#include "command.hpp"

#include <exception>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>

namespace fuzz {

namespace fs = std::filesystem;

void Command::addTo(CLI::App& app, const std::string& input) {
  app.add_option("--seed", seed, "Which " + input + "s: each seed has its own");
  app.add_option("--first", first, "Number of the first " + input);
  app.add_option("--count", count, "How many");
  app.add_option("--seconds", seconds, "A " + input + " that takes more processor time hangs");
  app.add_option("--out", out, "Where " + input + "s with findings are written to");
  app.add_flag("--show", show, "Print the " + input + "s instead of trying them");
}

fs::path Command::keep(const std::string& prefix, const Finding& finding, const std::string& text,
                       const std::string& suffix) const {
  fs::create_directories(out);
  const fs::path file =
      fs::path(out) / (prefix + "-" + std::to_string(seed) + "-" + std::to_string(finding.number) + suffix);
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

void tell(const std::string& input, const Finding& finding, const std::string& again) {
  std::cout << input << " " << finding.number << ": " << finding.what << "\n"
            << finding.log << "again by: " << again << "\n"
            << std::flush;
}

void conclude(const Summary& summary) {
  std::cout << summary.inputs << " inputs, " << summary.findings << " findings";
  for (const auto& [name, count] : summary.tallies) std::cout << ", " << count << " " << name;
  std::cout << "; the largest process took " << summary.largestProcess / 1024 << " MiB\n";
}

int guarded(const char* program, const std::function<int()>& work) {
  try {
    return work();
  } catch (const std::exception& error) {
    std::cerr << program << ": " << error.what() << "\n";
    return 1;
  }
}

}  // namespace fuzz
