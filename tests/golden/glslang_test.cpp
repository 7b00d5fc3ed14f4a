// SPDX-License-Identifier: MIT
//
// glslang, the reference compiler of GLSL, takes every program that skc writes for the .sk files of
// this repository, in every profile.
#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "glslang.hpp"
#include "skc.hpp"

using namespace golden;

namespace {

std::vector<fs::path> kernelFiles() {
  std::vector<fs::path> files;
  for (const char* folder : {"tests/golden", "tests/run", "tests/bench", "examples"}) {
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(fs::path(SK_SOURCE_FOLDER) / folder)) {
      if (entry.path().extension() == ".sk" && readFile(entry.path()).find("<>") != std::string::npos) {
        files.push_back(entry.path());   // without "<>" there is no kernel: the file is one to include
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Prints the programs of all files by one run of skc.
std::vector<std::string> programsOf(const std::vector<fs::path>& files, const std::string& profile) {
  std::string command = "'" SK_SKC "' --emit=glsl --profile=" + profile;
  for (const fs::path& file : files) command += " '" + file.string() + "'";
  const Outcome outcome = run(SK_SOURCE_FOLDER, command);
  INFO(outcome.errors);
  CHECK(outcome.errors == "");
  REQUIRE(outcome.status == 0);
  return glslang::programsOf(outcome.output);
}

}  // namespace

TEST_CASE("glslang takes every program of every .sk file") {
  const std::vector<fs::path> files = kernelFiles();
  CHECK(files.size() >= 20);
  for (const fs::path& file : files) {
    INFO(file.string());
    CHECK(!programsOf({file}, "glsl330").empty());
  }
  for (const std::string profile : {"glsl330", "glsl430", "essl300"}) {
    const std::vector<std::string> programs = programsOf(files, profile);
    const auto complaints = glslang::complaintsOf(programs);
    for (std::size_t i = 0; i < programs.size(); ++i) {
      for (const glslang::Complaint& complaint : complaints[i]) {
        INFO(profile << ", program " << i << ":\n" << programs[i]);  // its second line names the kernel
        FAIL_CHECK(complaint.source << ":" << complaint.line << ": " << complaint.text);
      }
    }
  }
}

TEST_CASE("glslang complains where there is reason to") {
  const auto complaints =
      glslang::complaintsOf({"#version 330 core\nvoid main() {}\n",
                             "#version 330 core\n#line 7 3\nint i = 1.5;\nvoid main() {}\n"});
  CHECK(complaints[0].empty());
  REQUIRE(!complaints[1].empty());
  CHECK(complaints[1][0].source == 3);
  CHECK(complaints[1][0].line == 7);
}
