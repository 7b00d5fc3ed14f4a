// SPDX-License-Identifier: MIT
//
// sk_race: how fast are kernels against the same work written otherwise? Measures, prints times, and writes them as
// JSON, which report.py makes tables, bars and charts of. Exit status 1 where somebody's result was wrong.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "ours.hpp"
#include "peers.hpp"
#include "peers/glsl/all.hpp"
#include "results.hpp"
#include "session.hpp"

namespace {

struct CommandLine {
  race::Settings settings;
  std::string sizes;
  std::string device = "gl";
  std::filesystem::path peers;
  std::filesystem::path json;
  bool noPeers = false;
  double sampleMilliseconds = 20;
};

/// "12,16,20", or "10..22", which counts by twos.
std::vector<int> sizesOf(const std::string& text) {
  std::vector<int> sizes;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    const std::size_t dots = part.find("..");
    const int first = std::stoi(part);
    const int last = dots == std::string::npos ? first : std::stoi(part.substr(dots + 2));
    for (int size = first; size <= last; size += 2) sizes.push_back(size);
  }
  for (const int size : sizes) {
    if (size < 10 || size > 30) throw std::runtime_error(fmt::format("no size is 2^{}: 10 to 30", size));
  }
  return sizes;
}

int run(CommandLine& c, const std::filesystem::path& executable) {
  c.settings.sizes = sizesOf(c.sizes);
  c.settings.withPeers = !c.noPeers;
  c.settings.patience.sampleSeconds = c.sampleMilliseconds / 1000;

  const race::OurDevices devices(c.device);
  race::Field peers;
  peers.absent = devices.absent();
  if (!c.noPeers) {
    race::addGlslPeers(devices.renderer(), peers);
    race::loadPeers(c.peers.empty() ? executable.parent_path() : c.peers, peers);
  }
  for (const std::string& text : peers.absent) fmt::print("absent: {}\n", text);
  race::Session session(c.settings, devices, peers.contenders);
  // Kept as it goes: who ends a long run early has what was measured.
  const auto keep = [&] {
    if (c.json.empty()) return;
    std::ofstream file(c.json);
    file << race::resultsOf(session, devices.renderer()).dump(1) << "\n";
    if (!file.flush()) throw std::runtime_error(fmt::format("cannot write '{}'", c.json.string()));
  };
  keep();
  session.runAll(keep);

  const auto& absences = session.absences();
  return std::any_of(absences.begin(), absences.end(), [](const auto& a) { return a.isWrong; }) ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine c;
  c.settings.patience = {9, 0, 5};
  CLI::App cli("Races kernels of StreamKernel against the same work written otherwise.", "sk_race");
  cli.add_option("--filter", c.settings.filter, "a regular expression: programs whose names it is found in");
  cli.add_option("--sizes", c.sizes,
                 "logarithms to base 2: 12,16,20, or 10..22 by twos (default: each program's own)");
  cli.add_option("--device", c.device, "the device with GL, as SK_DEVICE names it (default: the best)");
  cli.add_option("--rounds", c.settings.patience.rounds, "rounds, at most (default: 9)")
      ->check(CLI::Range(1, 1000));
  cli.add_option("--sample", c.sampleMilliseconds, "milliseconds of a contender in a round (default: 20)")
      ->check(CLI::Range(0.1, 1e5));
  cli.add_option("--group", c.settings.patience.groupSeconds,
                 "seconds for the rounds of a problem, unless they are fewer than three (default: 5)");
  cli.add_option("--longest", c.settings.longestSeconds,
                 "leave out who would take more seconds for a problem (default: 3)");
  cli.add_option("--peers", c.peers, "the folder of the peers' libraries (default: that of sk_race)");
  cli.add_flag("--no-peers", c.noPeers, "ours alone");
  cli.add_option("--only", c.settings.only, "a regular expression: contenders whose names it is found in");
  cli.add_option("--busy", c.settings.busyProcesses, "measure again beside this number of busy processes")
      ->check(CLI::Range(0, 1024));
  cli.add_option("--json", c.json, "write the times to this file");
  CLI11_PARSE(cli, argc, argv);
  try {
    return run(c, std::filesystem::read_symlink("/proc/self/exe"));
  } catch (const std::exception& error) {
    fmt::print(stderr, "sk_race: {}\n", error.what());
    return 1;
  }
}
