// SPDX-License-Identifier: MIT
//
// What skc writes for the .sk files of this folder is what lies beside them: FILE.glsl330, FILE.glsl430,
// FILE.essl300 and FILE.essl310 (abbreviated, see abbreviation.hpp), FILE.ir and FILE.stub (the header); of reach.sk, FILE.plan. With
// SK_UPDATE_GOLDENS=1 in the environment the expected texts are written anew; read what `git diff` then shows.
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string_view>

#include <catch2/catch.hpp>

#include "abbreviation.hpp"
#include "skc.hpp"

using namespace golden;

namespace {

struct Kind {
  const char* extension;
  const char* arguments;
};
constexpr Kind glslKinds[] = {{".glsl330", "--emit=glsl --profile=glsl330"},
                              {".essl300", "--emit=glsl --profile=essl300"},
                              {".glsl430", "--emit=glsl --profile=glsl430"},
                              {".essl310", "--emit=glsl --profile=essl310"}};
constexpr Kind otherKinds[] = {{".ir", "--emit=ir"}, {".stub", "--emit=stubs"}};

const std::vector<std::string> names = {"heat",           "particles", "loops", "folds",
                                        "append_outputs", "unrolling", "scans", "folded_outputs"};

bool isUpdate() {
  const char* update = std::getenv("SK_UPDATE_GOLDENS");
  return update != nullptr && std::string_view(update) == "1";
}

fs::path goldenOf(const std::string& name, const Kind& kind) {
  return fs::path(SK_GOLDEN_FOLDER) / (name + kind.extension);
}

fs::path kernelsOf(const std::string& name) { return fs::path(SK_GOLDEN_FOLDER) / (name + ".sk"); }

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

TEST_CASE("skc writes the GLSL that the goldens say") {
  const fs::path libraryFile = fs::path(SK_GOLDEN_FOLDER) / "library.glsl";
  std::vector<std::vector<std::string>> outputs;
  for (const std::string& name : names) {
    outputs.emplace_back();
    for (const Kind& kind : glslKinds) outputs.back().push_back(emitted(kernelsOf(name), kind));
  }
  if (isUpdate()) {
    const Library library = Library::of(outputs);
    writeFile(libraryFile, library.text());
    for (std::size_t file = 0; file < names.size(); ++file) {
      std::string base;
      for (std::size_t kind = 0; kind < std::size(glslKinds); ++kind) {
        const std::string golden = abbreviated(outputs[file][kind], base, library);
        writeFile(goldenOf(names[file], glslKinds[kind]), golden);
        if (kind == 0) base = golden;
      }
    }
  }
  const Library library(readFile(libraryFile));
  std::string all;
  for (std::size_t file = 0; file < names.size(); ++file) {
    const std::string base = readFile(goldenOf(names[file], glslKinds[0]));
    for (std::size_t kind = 0; kind < std::size(glslKinds); ++kind) {
      const fs::path expected = goldenOf(names[file], glslKinds[kind]);
      const std::string golden = readFile(expected);
      all += golden;
      INFO(expected.filename().string() << "; SK_UPDATE_GOLDENS=1 writes it anew");
      CHECK(firstDifference(outputs[file][kind], expanded(golden, kind == 0 ? "" : base, library)) == "");
    }
  }
  for (const auto& [first, lines] : library.texts()) {
    INFO("library.glsl has a text that no golden refers to: " << first);
    CHECK(all.find("\n... " + first + "\n") != std::string::npos);
  }
}

TEST_CASE("skc writes the IR and the headers that the goldens say") {
  for (const std::string& name : names) {
    for (const Kind& kind : otherKinds) {
      const std::string text = emitted(kernelsOf(name), kind);
      if (isUpdate()) writeFile(goldenOf(name, kind), text);
      INFO(name << kind.extension << "; SK_UPDATE_GOLDENS=1 writes it anew");
      CHECK(firstDifference(text, readFile(goldenOf(name, kind))) == "");
    }
  }
}

TEST_CASE("plans say how far kernels read") {
  const Kind plan = {".plan", "--emit=plan"};
  const std::string text = emitted(kernelsOf("reach"), plan);
  if (isUpdate()) writeFile(goldenOf("reach", plan), text);
  INFO("SK_UPDATE_GOLDENS=1 writes it anew");
  CHECK(firstDifference(text, readFile(goldenOf("reach", plan))) == "");
}

TEST_CASE("skc writes the same again, wherever it runs and whatever else it compiles") {
  const fs::path file = kernelsOf("particles");
  const std::string text = emitted(file, glslKinds[0]);
  const Outcome elsewhere = run("/", "'" SK_SKC "' --emit=glsl '" + file.string() + "'");
  CHECK(elsewhere.output == text);
  const Outcome both = skc("--emit=glsl heat.sk", file);
  CHECK(both.output == emitted(kernelsOf("heat"), glslKinds[0]) + text);
}
