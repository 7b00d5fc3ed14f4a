// SPDX-License-Identifier: MIT
//
// Folders of programs that tests show to glslang. They stay in SK_TEST_FOLDER for inspection.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// All but those of browsers, whose programs have the same text as for ES and are shown to Chromium (tests/web).
inline std::vector<Profile> shownProfiles() {
  std::vector<Profile> shown(profiles().begin(), profiles().end());
  std::erase_if(shown, [](const Profile& profile) { return profile.webgl; });
  return shown;
}

/// A folder of programs that one process checks.
class Programs {
 public:
  explicit Programs(std::string_view name) : folder_(std::filesystem::path(SK_TEST_FOLDER) / name) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }

  void add(std::string_view text, std::string_view stage = "frag") {
    std::ofstream(folder_ / fmt::format("{:04}.{}", count_++, stage)) << text;
  }

  /// glslang does not know the formats that GL_NV_image_formats adds.
  void add(const Profile& profile, std::string_view text) {
    if (text.find("GL_NV_image_formats") != std::string_view::npos) {
      ++count_;
      ++unknown_;
      return;
    }
    add(text, profile.stage == Stage::Compute ? "comp" : "frag");
  }

  /// The errors that glslang reports.
  std::string complaints() const {
    const std::string command =
        fmt::format("cd '{}' && '{}' *.* > complaints.txt 2>&1", folder_.string(), SK_GLSLANG_VALIDATOR);
    const bool accepted = std::system(command.c_str()) == 0;
    std::ifstream file(folder_ / "complaints.txt");
    std::string line;
    std::string result;
    for (int shown = 0; shown < 20 && std::getline(file, line);) {
      if (!line.starts_with("ERROR") && !line.starts_with("WARNING")) continue;
      result += line + '\n';
      ++shown;
    }
    return accepted && result.empty() ? "" : "glslang: " + result;
  }

  int count() const { return count_; }
  int unknown() const { return unknown_; }

 private:
  std::filesystem::path folder_;
  int count_ = 0;
  int unknown_ = 0;
};

inline void checkAccepted(const Programs& programs) {
  const std::string complaints = programs.complaints();
  INFO(complaints);
  CHECK(complaints.empty());
  CHECK(4 * programs.unknown() <= programs.count());
}

}  // namespace sk::assemble
