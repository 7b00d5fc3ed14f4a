// SPDX-License-Identifier: MIT
#include "shaders.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <unistd.h>

namespace fuzz {
namespace {

namespace fs = std::filesystem;

/// Each program begins with its version.
std::vector<std::string> programsOf(const std::string& listing) {
  std::vector<std::string> programs;
  std::istringstream lines(listing);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#version")) programs.emplace_back();
    if (!programs.empty()) programs.back() += line + "\n";
  }
  return programs;
}

}  // namespace

std::string complaints(const std::vector<std::string>& listings) {
  const fs::path folder = fs::temp_directory_path() / ("sk_fuzz_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::string command = "cd '" + folder.string() + "' && '" SK_GLSLANG_VALIDATOR "'";
  std::size_t count = 0;
  for (const std::string& listing : listings) {
    for (const std::string& program : programsOf(listing)) {
      const std::string name = std::to_string(count++) + ".frag";
      std::ofstream(folder / name) << program;
      command += " " + name;
    }
  }
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("glslangValidator cannot be run");
  std::string output;
  std::array<char, 4096> buffer{};
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe))
    output.append(buffer.data(), got);
  const int status = pclose(pipe);
  fs::remove_all(folder);
  return status == 0 ? "" : "glslang: " + output;
}

}  // namespace fuzz
