// SPDX-License-Identifier: MIT
#include "tune/choices.hpp"

#include <algorithm>

#include <catch2/catch.hpp>

namespace {

using sk::results::Kernel;
using sk::results::Process;
using sk_tool::tune::Choices;
using sk_tool::tune::choicesOf;
using sk_tool::tune::Step;

/// A kernel of floats, whose calls all take the defaults.
Kernel kernelNamed(const std::string& name, double seconds) {
  return {.name = name,
          .isNative = true,
          .calls = 1,
          .seconds = seconds,
          .hasFloats = true,
          .mayContract = true,
          .used = {"precision default", "accumulate default", "intrinsics default", "tables default",
                   "contraction default"}};
}

Process processWith(std::vector<Kernel> kernels, bool isNative = true) {
  Process process;
  for (Kernel& kernel : kernels) kernel.isNative = isNative;
  process.devices = {{.name = "device", .isReference = false, .isNative = isNative}};
  process.kernels = kernels;
  process.hasTimes = true;
  return process;
}

/// Texts like "k: precision half".
std::vector<std::string> textsOf(const std::vector<Step>& steps) {
  std::vector<std::string> texts;
  for (const Step& step : steps) texts.push_back(describe(step.changes));
  return texts;
}

bool has(const std::vector<std::string>& texts, const std::string& text) {
  return std::ranges::find(texts, text) != texts.end();
}

}  // namespace

TEST_CASE("each other value of a kernel's choices is tried") {
  CHECK(textsOf(choicesOf(processWith({kernelNamed("k", 1)})).others) ==
        std::vector<std::string>{"k: contraction fast", "k: precision half", "k: precision double"});
  Kernel kernel = kernelNamed("k", 1);
  kernel.hasFastFunctions = true;
  kernel.tables = {"f"};
  CHECK(textsOf(choicesOf(processWith({kernel}, false)).others) ==
        std::vector<std::string>{"k: contraction fast", "k: intrinsics fast", "k: tables off",
                                 "k: precision half", "k: precision extended", "k: precision double"});
}

TEST_CASE("a value that only some calls have is tried for all") {
  Kernel kernel = kernelNamed("k", 1);
  kernel.used.emplace_back("precision double");
  const std::vector<std::string> texts = textsOf(choicesOf(processWith({kernel})).others);
  CHECK(has(texts, "k: precision single"));
  CHECK(has(texts, "k: precision double"));
  std::erase(kernel.used, "precision default");
  CHECK_FALSE(has(textsOf(choicesOf(processWith({kernel})).others), "k: precision double"));
}

TEST_CASE("sums have accumulations in place of halves") {
  Kernel kernel = kernelNamed("sum", 1);
  kernel.isReduce = kernel.compensates = kernel.sumsExactly = true;
  const Choices choices = choicesOf(processWith({kernel}));
  const std::vector<std::string> texts = textsOf(choices.others);
  CHECK(has(texts, "sum: accumulate tree"));
  CHECK(has(texts, "sum: accumulate exact"));
  CHECK_FALSE(has(texts, "sum: accumulate compensated"));
  CHECK_FALSE(has(texts, "sum: precision half"));
  CHECK(has(choices.untried, "sum: precision half: it sums, and would lose the sum"));
  kernel.used = {"precision double"};  // which exact and compensated sums exclude
  CHECK_FALSE(has(textsOf(choicesOf(processWith({kernel})).others), "sum: accumulate exact"));
}

TEST_CASE("kernels without floats are not tried, which is said") {
  Kernel kernel = kernelNamed("doubles", 1);
  kernel.hasFloats = kernel.mayContract = false;
  const Choices choices = choicesOf(processWith({kernel}));
  CHECK(choices.others.empty());
  CHECK(has(choices.untried, "doubles: precision: it declares no floats, but doubles or integers"));
}

TEST_CASE("what a kernel lacks is left out with the reason") {
  Kernel kernel = kernelNamed("k", 1);
  kernel.whyNotHalf = "it shifts bits";
  kernel.whyNotWide = "it has matrices";
  const Choices choices = choicesOf(processWith({kernel}, false));
  CHECK(textsOf(choices.others) == std::vector<std::string>{"k: contraction fast"});
  CHECK(has(choices.untried, "k: precision half: it shifts bits"));
  CHECK(has(choices.untried, "k: precisions extended and double: it has matrices"));
  CHECK(choices.raised.empty());
}

TEST_CASE(
    "the costliest come first for speed, the cheapest for exactness, and what costs nothing is left alone "
    "for speed") {
  const Choices choices = choicesOf(
      processWith({kernelNamed("small", 0.001), kernelNamed("middle", 0.3), kernelNamed("large", 0.7)}));
  CHECK(choices.others.front().of == "large");
  CHECK(std::ranges::none_of(choices.others, [](const Step& step) { return step.of == "small"; }));
  CHECK(has(choices.untried, "small: takes 0.1 % of the kernels' time"));
  REQUIRE(choices.raised.size() == 3);
  CHECK(choices.raised.front().of == "small");
}

TEST_CASE("what is rarely faster is tried after all else") {
  const auto orderOn = [](bool isNative) {
    Process process = processWith({kernelNamed("middle", 0.3), kernelNamed("large", 0.7)}, isNative);
    process.streams = {{"u", "single", 1, 100}};
    const std::vector<std::string> texts = textsOf(choicesOf(process).others);
    return std::vector<std::string>(texts.begin(), texts.begin() + 4);
  };
  CHECK(orderOn(false) == std::vector<std::string>{"u: storage half", "large: contraction fast",
                                                   "middle: contraction fast", "large: precision half"});
  CHECK(orderOn(true) == std::vector<std::string>{"large: contraction fast", "middle: contraction fast",
                                                  "u: storage half", "large: precision half"});
}

TEST_CASE("kernels and streams of wide numbers become floats together") {
  Kernel wide = kernelNamed("wide", 1), narrow = kernelNamed("narrow", 1);
  wide.used.front() = "precision double";
  Process process = processWith({wide, narrow});
  process.streams = {{"u", "double", 1, 100}, {"v", "single", 1, 100}};
  CHECK(textsOf(choicesOf(process).lowered) ==
        std::vector<std::string>{"wide: precision single", "u: storage single"});
}

TEST_CASE("small streams are left alone for speed") {
  Process process = processWith({kernelNamed("k", 1)});
  process.streams = {{"", "single", 1, 9}, {"u", "single", 1, 991}};
  const Choices choices = choicesOf(process);
  CHECK_FALSE(has(textsOf(choices.others), "streams without a name: storage half"));
  CHECK(has(textsOf(choices.others), "u: storage half"));
  CHECK(has(choices.untried, "streams without a name: 0.9 % of the bytes of all streams"));
  CHECK(has(textsOf(choices.raised), "streams without a name: storage double"));
}

TEST_CASE("streams are stored in halves for speed, and in doubles for exactness") {
  Process process = processWith({kernelNamed("k", 1)});
  process.streams = {{"", "single", 2, 300}, {"u", "half", 1, 100}};
  const Choices choices = choicesOf(process);
  const std::vector<std::string> others = textsOf(choices.others), raised = textsOf(choices.raised);
  CHECK(has(others, "streams without a name: storage half"));
  CHECK(has(others, "u: storage single"));
  CHECK_FALSE(has(others, "u: storage half"));
  CHECK(has(raised, "streams without a name: storage double"));
  CHECK(has(raised, "u: storage double"));
  CHECK(choices.facts.streams == std::map<std::string, std::string>{{"u", "half"}});
}

TEST_CASE("sums that calls or declarations want exact give way to a precision") {
  Kernel kernel = kernelNamed("sum", 1);
  kernel.used = {"accumulate exact"};
  CHECK(choicesOf(processWith({kernel})).facts.called.at("sum") ==
        std::vector<std::string>{"precision of floats"});
}
