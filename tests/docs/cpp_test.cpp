// SPDX-License-Identifier: MIT
//
// The C++ blocks: all of them compile, as one translation unit, with the headers that skc makes of the
// named .sk blocks. Programs that are marked so are linked and run as well, and so are the fragments that
// throw, whose messages must be those that are quoted above them.
#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "command.hpp"
#include "listings.hpp"
#include "markdown.hpp"

namespace {

namespace fs = std::filesystem;
using docs::Block;

std::string compilerCommand() {
  return SK_DOCS_COMPILER + fmt::format(
                                " -O0 -I '{0}/runtime/include' -I '{0}/runtime/linear/include' -I "
                                "'{0}/runtime/src' -I '{0}/compiler' -I .",
                                SK_DOCS_SOURCE);
}

/// compilerCommand() in kernelFolder(), with precompiled headers.
std::string quickCommand() { return compilerCommand() + " -include runtime.hpp"; }

/// Runs a command that must succeed.
void make(const std::string& command, const fs::path& folder) {
  const docs::Outcome outcome = docs::run(command, folder);
  INFO(outcome.output);
  REQUIRE(outcome.status == 0);
}

/// A folder with what skc makes of every named .sk block for this machine, FILE.sk.cpp compiled to FILE.sk.cpp.o, and runtime.hpp,
/// precompiled: reading its headers takes most of the time of small sources. Made once.
const fs::path& kernelFolder() {
  static const fs::path folder = [] {
    const fs::path made = docs::workFolder("kernels");
    docs::writeNamedFiles(made);
    make("skc --levels=native *.sk", made);
    docs::writeFile(made / "runtime.hpp", "#include <sk/sk.hpp>\n");
    make(compilerCommand() + " -x c++-header runtime.hpp -o runtime.hpp.gch", made);
    make(fmt::format("for file in *.sk.cpp; do {} -c $file -o $file.o || exit 1; done", quickCommand()),
         made);
    return made;
  }();
  return folder;
}

/// Takes `#include` lines out of a text, for the top of the file.
std::string withoutIncludes(const std::string& text, std::set<std::string>& includes) {
  std::string rest;
  for (const std::string& line : docs::linesOf(text)) {
    const bool isInclude = line.starts_with("#include");
    if (isInclude) includes.insert(line);
    rest += (isInclude || line.starts_with("#pragma once") ? "" : line) + "\n";
  }
  return rest;
}

/// Declarations as they are; a program in a namespace of its own; a fragment in a function there, behind
/// its document's prelude.
std::string wrapped(const docs::Document& document, const Block& block, std::set<std::string>& includes) {
  const std::string text = fmt::format("#line {} \"{}\"\n{}", block.line + 1, block.document,
                                       withoutIncludes(block.text, includes));
  if (block.has("file")) return text;
  if (block.has("run")) return fmt::format("namespace program{} {{\n{}}}\n", block.line, text);
  return fmt::format("namespace block{} {{\nvoid fragment() {{\n{}{{\n{}}}\n}}\n}}\n", block.line,
                     withoutIncludes(document.prelude, includes), text);
}

/// Rows of our tables, standing alone, are at least of the right shape.
constexpr const char* rowsOfTables =
    "#define SKC_INTRINSIC(Name, spelling, signatures, library, native, glsl, polyfill) "
    "static_assert(sizeof(spelling signatures #library #native glsl polyfill) > 1);\n"
    "#define SKC_DIAGNOSTIC(Name, severity, text) "
    "static_assert(skc::Severity::severity <= skc::Severity::Note && sizeof(text) > 1);\n";

/// Blocks about sk::mpi need an MPI.
bool isCompiled(const Block& block) { return !block.has("mpi") || !std::string_view(SK_DOCS_MPI).empty(); }

std::string includeLines(std::set<std::string> includes) {
  includes.insert({"#include <sk/sk.hpp>", "#include <cstddef>", "#include <cstdio>", "#include <vector>"});
  std::string lines;
  for (const std::string& include : includes) lines += include + "\n";
  return lines;
}

/// "domain: ... is no box" against a message; "..." stands for any text.
bool matches(const std::string& message, const std::string& quote) {
  std::size_t at = 0;
  for (std::size_t from = 0; from <= quote.size();) {
    const std::size_t gap = std::min(quote.find("...", from), quote.size());
    const std::string part = quote.substr(from, gap - from);
    const std::size_t found = message.find(part, at);
    if (found == std::string::npos || (from == 0 && found != 0)) return false;
    at = found + part.size();
    if (gap == quote.size()) return part.empty() || at == message.size();
    from = gap + 3;
  }
  return true;
}

/// A program that runs each fragment and prints its line and what it throws.
std::string throwingProgram(const docs::Document& document) {
  std::set<std::string> includes;
  std::string functions, calls;
  for (const Block& block : document.blocks) {
    if (block.language != "c++" || !block.has("throws")) continue;
    functions += wrapped(document, block, includes);
    calls += fmt::format("  run({0}, block{0}::fragment);\n", block.line);
  }
  return includeLines(includes) + functions +
         "void run(int line, void (*fragment)()) {\n"
         "  std::printf(\"\\f%d\\n\", line);\n"
         "  try { fragment(); } catch (const sk::Error& error) { std::fputs(error.what(), stdout); }\n"
         "}\n"
         "int main() {\n" +
         calls + "}\n";
}

/// Makes `program` of main.cpp and objects of kernels.
void build(const fs::path& folder, const std::string& kernels) {
  make(fmt::format("{} main.cpp {} {} -o program", quickCommand(), kernels, SK_DOCS_LIBRARIES), folder);
}

}  // namespace

TEST_CASE("every C++ block compiles", "[cpp]") {
  const fs::path& folder = kernelFolder();
  std::set<std::string> includes;
  std::string text;
  int number = 0;
  for (const docs::Document& document : docs::documents()) {
    // lines are the same in several documents
    text += fmt::format("#define fragment fragment{0}\n#define main main{0}\n", number++);
    for (const Block& block : document.blocks) {
      if (block.language == "c++" && isCompiled(block)) text += wrapped(document, block, includes);
    }
    text += "#undef fragment\n#undef main\n";
  }
  docs::writeFile(folder / "blocks.cpp", includeLines(includes) + rowsOfTables + text);
  const docs::Outcome outcome =
      docs::run(compilerCommand() + SK_DOCS_MPI + " -fsyntax-only blocks.cpp", folder);
  INFO(outcome.output);
  CHECK(outcome.status == 0);
}

TEST_CASE("the programs of the documentation run", "[cpp]") {
  const fs::path& folder = kernelFolder();
  int programs = 0;
  for (const Block* block : docs::blocksOf("c++")) {
    if (!block->has("run")) continue;
    ++programs;
    INFO(block->place());
    docs::writeFile(folder / "main.cpp", block->text);
    const std::string kernels = block->value("kernels");
    build(folder, kernels.empty() ? "" : fmt::format("{0}.cpp.o {0}.o", kernels));
    const docs::Outcome ran = docs::run("./program", folder);
    INFO(ran.output);
    CHECK(ran.status == 0);
    CHECK(ran.output == block->value("prints") + "\n");
  }
  CHECK(programs > 0);
}

TEST_CASE("what is said to throw throws the message that is quoted above it", "[cpp]") {
  const fs::path& folder = kernelFolder();
  for (const docs::Document& document : docs::documents()) {
    if (std::none_of(document.blocks.begin(), document.blocks.end(),
                     [](const Block& block) { return block.has("throws"); })) {
      continue;
    }
    docs::writeFile(folder / "main.cpp", throwingProgram(document));
    build(folder, "*.sk.cpp.o *.sk.o");
    const docs::Outcome ran = docs::run("./program", folder);
    INFO(ran.output);
    CHECK(ran.status == 0);
    for (const Block& block : document.blocks) {
      if (!block.has("throws")) continue;
      const std::string mark = fmt::format("\f{}\n", block.line);
      const std::size_t begin = ran.output.find(mark) + mark.size();
      const std::string message = ran.output.substr(begin, ran.output.find('\f', begin) - begin);
      INFO(block.place() << ": " << block.quote << "\ngives: " << message);
      CHECK(matches(message, block.quote));
    }
  }
}
