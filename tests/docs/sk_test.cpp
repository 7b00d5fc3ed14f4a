// SPDX-License-Identifier: MIT
//
// The .sk blocks: what compiles, what does not and with which message, and what comes out of it.
#include <regex>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "command.hpp"
#include "glslang.hpp"
#include "listings.hpp"
#include "markdown.hpp"

namespace {

namespace fs = std::filesystem;
using docs::Block;

bool isWrong(const Block& block) { return block.has("error") || block.has("warning"); }

/// The first error or warning of skc's about `file`.
std::string firstMessage(const std::string& output, const std::string& file) {
  for (const std::string& line : docs::linesOf(output)) {
    static const std::regex pattern(
        R"re(^([^:]+):\d+:\d+: (?:fatal )?(?:error|warning): (.*?)(?: \[-W[^\]]*\])?$)re");
    std::smatch parts;
    if (std::regex_match(line, parts, pattern) && parts[1] == file) return parts[2];
  }
  return {};
}

}  // namespace

TEST_CASE("every .sk block compiles, for every profile, to GLSL that glslang accepts", "[sk]") {
  const fs::path folder = docs::workFolder("compiled");
  docs::writeNamedFiles(folder);
  std::string files;
  for (const Block* block : docs::blocksOf("sk")) {
    if (isWrong(*block)) continue;
    docs::writeFile(folder / docs::fileName(*block), docs::wholeFile(*block));
    files += fmt::format(" '{}'", docs::fileName(*block));
  }
  for (const std::string profile : {"glsl330", "glsl430", "essl300", "essl310"}) {
    const docs::Outcome outcome = docs::run(
        fmt::format("skc -Werror --emit=glsl --profile={}{} >{}.txt", profile, files, profile), folder);
    INFO(outcome.output);
    REQUIRE(outcome.status == 0);
    for (const auto& complaints :
         glslang::complaintsOf(glslang::programsOf(docs::readFile(folder / (profile + ".txt"))))) {
      for (const glslang::Complaint& complaint : complaints) FAIL_CHECK(profile + ": " + complaint.text);
    }
  }
}

TEST_CASE("every block that is shown as wrong gives the message that is quoted above it", "[sk]") {
  const fs::path folder = docs::workFolder("wrong");
  std::string command;
  for (const Block* block : docs::blocksOf("sk")) {
    if (!isWrong(*block)) continue;
    const std::string name = docs::fileName(*block);
    docs::writeFile(folder / name, docs::wholeFile(*block));
    const std::string warning = block->value("W");
    command += fmt::format("skc --emit=glsl {} {} >/dev/null; echo 'status' {} $?\n",
                           warning.empty() ? "" : "-W" + warning, name, name);
  }
  const std::string output = docs::run(command, folder).output;
  for (const Block* block : docs::blocksOf("sk")) {
    if (!isWrong(*block)) continue;
    const std::string name = docs::fileName(*block);
    INFO(block->place() << ": " << block->section);
    CHECK(output.find(fmt::format("status {} {}\n", name, block->has("error") ? 1 : 0)) != std::string::npos);
    CHECK(firstMessage(output, name) == block->quote);
  }
}

TEST_CASE("quoted GLSL and IR are what skc prints", "[sk]") {
  const fs::path folder = docs::workFolder("quoted");
  docs::writeNamedFiles(folder);
  const auto check = [&](const Block& block, const std::string& options) {
    const std::string kernel = block.value("kernel");
    const docs::Outcome outcome = docs::run(
        fmt::format("skc {}{} {}", options, kernel.empty() ? "" : " --kernel=" + kernel, block.value("of")),
        folder);
    INFO(block.place() << " is not what skc " << options << " prints:\n" << outcome.output);
    CHECK(outcome.status == 0);
    CHECK(docs::quotes(block.text, outcome.output));
  };
  for (const Block* block : docs::blocksOf("glsl")) {
    const std::string profile = block->value("profile");
    check(*block, "--emit=glsl --profile=" + (profile.empty() ? "glsl330" : profile));
  }
  for (const Block* block : docs::blocksOf("ir")) {
    const std::string after = block->value("after");
    check(*block, after.empty() ? "--emit=ir" : "--emit=stubs --print-after=" + after);
  }
}

TEST_CASE("sessions at the console go as they are shown", "[sk]") {
  const fs::path folder = docs::workFolder("console");
  docs::writeNamedFiles(folder);
  for (const Block* block : docs::blocksOf("console")) {
    std::string really;
    for (const std::string& line : docs::linesOf(block->text)) {
      if (line.starts_with("$ ")) really += line + "\n" + docs::run(line.substr(2), folder).output;
    }
    INFO(block->place() << ": what happens is\n" << really);
    CHECK(docs::quotes(block->text, really));
    CHECK(docs::linesOf(block->text).size() == docs::linesOf(really).size());
  }
}
