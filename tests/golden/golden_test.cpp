// SPDX-License-Identifier: MIT
//
// What skc writes for the .sk files of this folder is what lies beside them: FILE.glsl330, FILE.glsl430,
// FILE.essl300, FILE.ir and FILE.stub (the header); of reach.sk, FILE.plan. With SK_UPDATE_GOLDENS=1 in the environment the
// expected texts are written anew; read what `git diff` then shows.
#include <cstdlib>
#include <sstream>
#include <string_view>

#include <catch2/catch.hpp>

#include "skc.hpp"

using namespace golden;

namespace {

struct Kind {
  const char* extension;
  const char* arguments;
};
constexpr Kind kinds[] = {{".glsl330", "--emit=glsl --profile=glsl330"},
                          {".essl300", "--emit=glsl --profile=essl300"},
                          {".glsl430", "--emit=glsl --profile=glsl430"},
                          {".ir", "--emit=ir"},
                          {".stub", "--emit=stubs"}};

/// The first line that differs, with its number; "" where none does.
std::string firstDifference(const std::string& actual, const std::string& expected) {
  std::istringstream a(actual), b(expected);
  for (int number = 1;; ++number) {
    std::string lineA, lineB;
    const bool hasA = bool(std::getline(a, lineA)), hasB = bool(std::getline(b, lineB));
    if (!hasA && !hasB) return actual == expected ? "" : "another end of line";
    if (hasA != hasB || lineA != lineB) {
      return "line " + std::to_string(number) + "\n  is  " + (hasA ? lineA : "(missing)") + "\n  not " +
             (hasB ? lineB : "(nothing)");
    }
  }
}

std::string emitted(const fs::path& file, const Kind& kind) {
  const bool isStub = std::string_view(kind.extension) == ".stub";
  const fs::path folder = isStub ? workFolder("stubs") : fs::path();
  const Outcome outcome = skc(kind.arguments + (isStub ? " -o '" + folder.string() + "'" : ""), file);
  INFO("skc " << kind.arguments << " " << file.filename().string() << "\n" << outcome.errors);
  CHECK(outcome.errors == "");
  REQUIRE(outcome.status == 0);
  return isStub ? readFile(folder / (file.filename().string() + ".hpp")) : outcome.output;
}

}  // namespace

TEST_CASE("skc writes what the goldens say") {
  const char* update = std::getenv("SK_UPDATE_GOLDENS");
  int files = 0;
  for (const char* name :
       {"heat", "particles", "loops", "folds", "append_outputs", "unrolling", "scans", "folded_outputs"}) {
    for (const Kind& kind : kinds) {
      const fs::path file = fs::path(SK_GOLDEN_FOLDER) / (std::string(name) + ".sk");
      const fs::path expected = fs::path(file).replace_extension(kind.extension);
      const std::string text = emitted(file, kind);
      if (update != nullptr && std::string_view(update) == "1") writeFile(expected, text);
      INFO(expected.filename().string() << "; SK_UPDATE_GOLDENS=1 writes it anew");
      CHECK(firstDifference(text, readFile(expected)) == "");
      ++files;
    }
  }
  CHECK(files == 40);
}

TEST_CASE("plans say how far kernels read") {
  const fs::path file = fs::path(SK_GOLDEN_FOLDER) / "reach.sk";
  const fs::path expected = fs::path(file).replace_extension(".plan");
  const std::string text = emitted(file, {".plan", "--emit=plan"});
  const char* update = std::getenv("SK_UPDATE_GOLDENS");
  if (update != nullptr && std::string_view(update) == "1") writeFile(expected, text);
  INFO("SK_UPDATE_GOLDENS=1 writes it anew");
  CHECK(firstDifference(text, readFile(expected)) == "");
}

TEST_CASE("skc writes the same again, wherever it runs and whatever else it compiles") {
  const fs::path file = fs::path(SK_GOLDEN_FOLDER) / "particles.sk";
  const std::string text = emitted(file, kinds[0]);
  const Outcome elsewhere = run("/", "'" SK_SKC "' --emit=glsl '" + file.string() + "'");
  CHECK(elsewhere.output == text);
  const Outcome both = skc("--emit=glsl heat.sk", file);
  CHECK(both.output == emitted(fs::path(SK_GOLDEN_FOLDER) / "heat.sk", kinds[0]) + text);
}
