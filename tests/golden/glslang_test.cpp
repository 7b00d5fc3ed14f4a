// SPDX-License-Identifier: MIT
//
// glslang, the reference compiler of GLSL, takes every program that skc writes for the .sk files of
// this repository, in every profile. (Of glsl330, whose programs are those of essl300 but for what they begin with,
// it compiles the programs of this folder.)
#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

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
        files.push_back(entry.path());  // without "<>" there is no kernel: the file is one to include
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// What skc reports but for its warning that these programs leave out printf, which has two lines of the file below it.
std::string mistakesIn(const std::string& errors) {
  std::istringstream lines(errors);
  std::string rest;
  int skipped = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("warning: printf prints on native devices alone") != std::string::npos) skipped = 3;
    if (skipped > 0)
      --skipped;
    else
      rest += line + "\n";
  }
  return rest;
}

/// Prints the programs of all files by one run of skc, which does not validate the IR: the build of their programs does.
std::vector<std::string> programsOf(const std::vector<fs::path>& files, const std::string& profile,
                                    const std::string& options = "") {
  std::string command = "SKC_VALIDATE=off '" SK_SKC "' --emit=glsl --profile=" + profile + options;
  for (const fs::path& file : files) command += " '" + file.string() + "'";
  const Outcome outcome = run(SK_SOURCE_FOLDER, command);
  INFO(outcome.errors);
  CHECK(mistakesIn(outcome.errors) == "");
  REQUIRE(outcome.status == 0);
  return glslang::programsOf(outcome.output);
}

/// A program without what versions of GLSL begin with, and without the numbers of its lines, which that moves.
std::string withoutHeader(const std::string& program) {
  std::istringstream lines(program);
  std::string rest;
  for (std::string line; std::getline(lines, line);) {
    const bool isHeader =
        line.starts_with("#version") || line.starts_with("#line") || line.starts_with("precision highp ") ||
        line.find(" for essl300: ") != std::string::npos || line.find(" for glsl330: ") != std::string::npos;
    if (!isHeader) rest += line + "\n";
  }
  return rest;
}

/// Programs without headers, by the kernel or reduce that their second line names.
std::map<std::string, std::vector<std::string>> programsByKernel(const std::vector<std::string>& programs) {
  std::map<std::string, std::vector<std::string>> all;
  for (const std::string& program : programs) {
    std::istringstream lines(program);
    std::string version, mark, name;
    std::getline(lines, version);
    lines >> mark >> name;
    all[name].push_back(withoutHeader(program));
  }
  return all;
}

}  // namespace

namespace {

/// Lets skc show programs with the barrier that both languages have.
struct SameBarrier {
  SameBarrier() { setenv("SK_BARRIER", "xor", 1); }
  ~SameBarrier() { unsetenv("SK_BARRIER"); }
};

}  // namespace

// Tests rely on it, and leave one of the two profiles out (onEveryDoubleConfig, tests/run/support/devices.hpp).
TEST_CASE("on essl300, programs are those of glsl330 with another header") {
  const SameBarrier same;
  const std::vector<fs::path> files = {fs::path(SK_SOURCE_FOLDER) / "tests/run/precision.sk"};
  const auto desktop = programsOf(files, "glsl330", " --precision=extended");
  const auto embedded = programsOf(files, "essl300", " --precision=extended");
  REQUIRE(desktop.size() == embedded.size());
  CHECK(desktop.size() >= 20);
  for (std::size_t i = 0; i < desktop.size(); ++i)
    CHECK(withoutHeader(desktop[i]) == withoutHeader(embedded[i]));
}

// There are two exceptions: doubles, which are pairs of floats on essl300, and more outputs than a pass has there.
TEST_CASE("so are those of all .sk files, but for doubles and many outputs") {
  const SameBarrier same;
  const std::vector<fs::path> files = kernelFiles();
  const auto desktop = programsByKernel(programsOf(files, "glsl330"));
  const auto embedded = programsByKernel(programsOf(files, "essl300"));
  std::size_t compared = 0;
  for (const auto& [name, programs] : desktop) {
    const auto there = embedded.find(name);
    INFO(name);
    REQUIRE(there != embedded.end());
    if (programs.size() != there->second.size()) continue;
    for (std::size_t i = 0; i < programs.size(); ++i) {
      if (programs[i].find("sk_double") != std::string::npos) continue;
      CHECK(programs[i] == there->second[i]);
      ++compared;
    }
  }
  CHECK(compared > 2000);
}

TEST_CASE("glslang takes every program of every .sk file") {
  const std::vector<fs::path> files = kernelFiles();
  CHECK(files.size() >= 20);
  std::vector<fs::path> goldens = files;
  std::erase_if(goldens, [](const fs::path& file) { return file.parent_path().filename() != "golden"; });
  CHECK(goldens.size() >= 8);
  std::map<std::string, std::vector<std::string>> all;  // by profile
  for (const char* profile : {"glsl430", "essl300", "essl310"}) all[profile] = programsOf(files, profile);
  all["glsl330"] = programsOf(goldens, "glsl330");
  CHECK(all["essl300"].size() >= files.size());
  for (const auto& [profile, programs] : all) {
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
