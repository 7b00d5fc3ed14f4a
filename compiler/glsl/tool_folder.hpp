// SPDX-License-Identifier: MIT
//
// For tests: a folder of generated files that another program checks. The files stay, so that people can look
// at them, too.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace skc::emit {

class ToolFolder {
 public:
  explicit ToolFolder(std::string_view name) : folder_(std::filesystem::path(SK_TEST_FOLDER) / name) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }

  void write(const std::string& file, std::string_view text) const { std::ofstream(folder_ / file) << text; }

  /// Runs a command there; returns its output if it fails, else "".
  std::string complaints(const std::string& command) const {
    const std::string whole = "cd '" + folder_.string() + "' && (" + command + ") > complaints.txt 2>&1";
    if (std::system(whole.c_str()) == 0) return {};
    std::ifstream file(folder_ / "complaints.txt");
    return "failed: " + std::string(std::istreambuf_iterator<char>(file), {});
  }

  /// glslang's messages about the *.frag files.
  std::string glslang() const { return complaints(std::string(SK_GLSLANG_VALIDATOR) + " *.frag"); }

 private:
  std::filesystem::path folder_;
};

}  // namespace skc::emit
