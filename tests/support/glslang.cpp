// SPDX-License-Identifier: MIT
#include "glslang.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include <unistd.h>

namespace glslang {
namespace {

namespace fs = std::filesystem;

/// A folder for this process, removed at the end.
class Folder {
 public:
  Folder() { fs::create_directories(path_); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_ = fs::temp_directory_path() / ("sk_glslang_" + std::to_string(getpid()));
};

struct Outcome {
  int status;
  std::string output;
};

Outcome run(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("glslangValidator cannot be run");
  std::string output;
  std::array<char, 4096> buffer{};
  while (const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), got);
  }
  return {pclose(pipe), output};
}

bool isCompute(const std::string& program) { return program.find("local_size_x") != std::string::npos; }

}  // namespace

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
  const Folder folder;
  std::string command = "cd '" + folder.path().string() + "' && '" SK_GLSLANG_VALIDATOR "'";
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const std::string name = std::to_string(i) + (isCompute(programs[i]) ? ".comp" : ".frag");
    // glslang has `precise` of GLSL 4.00, but not of the extension
    const bool hasPrecise = programs[i].find("GL_ARB_gpu_shader5") != std::string::npos;
    constexpr std::string_view version = "#version 330";
    const bool isRaised = hasPrecise && programs[i].starts_with(version);
    std::ofstream(folder.path() / name, std::ios::binary)
        << (isRaised ? "#version 400" + programs[i].substr(version.size()) : programs[i]);
    command += " " + name;
  }
  const Outcome outcome = run(command);

  // "12.frag" or "12.comp" alone on a line begins a program's messages, which read "ERROR: SOURCE:LINE: text".
  static const std::regex name(R"((\d+)\.(?:frag|comp))");
  static const std::regex message(R"((?:ERROR|WARNING): (?:(\d+):(\d+): )?(.*))");
  std::vector<std::vector<Complaint>> complaints(programs.size());
  std::size_t current = 0;
  std::istringstream lines(outcome.output);
  for (std::string line; std::getline(lines, line);) {
    std::smatch parts;
    if (std::regex_match(line, parts, name)) {
      current = std::stoul(parts[1]);
    } else if (line.find("extension is only partially supported") != std::string::npos) {
      // a warning about GL_ARB_gpu_shader5
    } else if (std::regex_match(line, parts, message) && parts[1].matched) {
      complaints[current].push_back({std::stoi(parts[1]), std::stoi(parts[2]), parts[3]});
    }
  }
  const bool hasMessages = std::ranges::any_of(complaints, [](const auto& one) { return !one.empty(); });
  if (outcome.status != 0 && !hasMessages && !programs.empty()) {
    complaints[0].push_back({0, 0, "glslang failed: " + outcome.output});
  }
  return complaints;
}

}  // namespace glslang
