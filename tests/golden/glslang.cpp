// SPDX-License-Identifier: MIT
#include "glslang.hpp"

#include <regex>
#include <sstream>

#include "skc.hpp"

namespace golden {

std::vector<std::string> programsOf(const std::string& listing) {
  std::vector<std::string> programs;
  std::istringstream lines(listing);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#version")) programs.emplace_back();
    if (!programs.empty()) programs.back() += line + "\n";
  }
  return programs;
}

std::vector<std::vector<Complaint>> complaintsOf(const std::vector<std::string>& programs) {
  const fs::path folder = workFolder("glslang");
  std::string command = "'" SK_GLSLANG_VALIDATOR "'";
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const std::string name = std::to_string(i) + ".frag";
    writeFile(folder / name, programs[i]);
    command += " " + name;
  }
  const Outcome outcome = run(folder, command);

  // "12.frag" alone on a line begins a program's messages, which read "ERROR: SOURCE:LINE: text".
  static const std::regex name(R"((\d+)\.frag)");
  static const std::regex message(R"((?:ERROR|WARNING): (?:(\d+):(\d+): )?(.*))");
  std::vector<std::vector<Complaint>> complaints(programs.size());
  std::size_t current = 0;
  std::istringstream lines(outcome.output);
  for (std::string line; std::getline(lines, line);) {
    std::smatch parts;
    if (std::regex_match(line, parts, name)) {
      current = std::stoul(parts[1]);
    } else if (std::regex_match(line, parts, message) && parts[1].matched) {
      complaints[current].push_back({std::stoi(parts[1]), std::stoi(parts[2]), parts[3]});
    }
  }
  if (outcome.status != 0 && !complaints.empty()) {
    bool isTold = false;
    for (const auto& one : complaints) isTold = isTold || !one.empty();
    if (!isTold) complaints[0].push_back({0, 0, "glslang failed: " + outcome.output + outcome.errors});
  }
  return complaints;
}

}  // namespace golden
