// SPDX-License-Identifier: MIT
#include "command.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

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

void SlicedCommand::addTo(CLI::App& app, const std::string& input) {
  Command::addTo(app, input);
  app.add_option("--minutes", minutes, "How long, instead of --count");
  app.add_option("--findings", mostFindings, "Stop after this many findings");
}

void SlicedCommand::forSlices(std::uint64_t slice,
                              const std::function<std::uint64_t(std::uint64_t, std::uint64_t)>& run) const {
  using Clock = std::chrono::steady_clock;
  const auto stop = Clock::now() + std::chrono::duration<double>(60 * minutes);
  const bool isTimed = minutes > 0;
  const std::uint64_t end = first + count;
  for (std::uint64_t at = first; isTimed ? Clock::now() <= stop : at < end; at += slice) {
    if (run(at, isTimed ? slice : std::min(slice, end - at)) >= mostFindings) break;
  }
}

void conclude(const Kinds& kinds) {
  for (const auto& [kind, count] : kinds) std::cout << count << " x " << kind << "\n";
}

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
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
