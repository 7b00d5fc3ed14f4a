// SPDX-License-Identifier: MIT
//
// What surrounds the code: links lead somewhere, commands exist, and blocks are of kinds that are checked.
#include <algorithm>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "command.hpp"
#include "markdown.hpp"

namespace {

namespace fs = std::filesystem;

bool hasAnchor(const docs::Document& document, const std::string& anchor) {
  return std::any_of(document.headings.begin(), document.headings.end(),
                     [&](const docs::Heading& heading) { return docs::anchorOf(heading.text) == anchor; });
}

const docs::Document* documentAt(const fs::path& path) {
  for (const docs::Document& document : docs::documents()) {
    if (document.name == path.string()) return &document;
  }
  return nullptr;
}

/// The first word of a command, behind assignments of variables.
std::string commandOf(const std::string& line) {
  std::istringstream words(line);
  std::string word;
  while (words >> word && word.find('=') != std::string::npos && word.front() != '-') {
  }
  return word;
}

}  // namespace

TEST_CASE("links lead to files and headings that there are", "[text]") {
  for (const docs::Document& document : docs::documents()) {
    for (const docs::Piece& link : document.links) {
      if (link.text.starts_with("http")) continue;
      INFO(document.name << ":" << link.line << ": " << link.text);
      const std::size_t hash = std::min(link.text.find('#'), link.text.size());
      const fs::path file =
          hash == 0 ? fs::path(document.name)
                    : (fs::path(document.name).parent_path() / link.text.substr(0, hash)).lexically_normal();
      CHECK(fs::exists(fs::path(SK_DOCS_SOURCE) / file));
      if (hash == link.text.size()) continue;
      const docs::Document* target = documentAt(file);
      CHECK((target && hasAnchor(*target, link.text.substr(hash + 1))));
    }
  }
}

TEST_CASE("sources that documents name are there", "[text]") {
  std::vector<std::string> sources;
  for (const char* folder : {"cmake", "compiler", "examples", "runtime", "tests"}) {
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(fs::path(SK_DOCS_SOURCE) / folder)) {
      if (entry.is_regular_file()) sources.push_back(entry.path().string());
    }
  }
  // by as much of the path as tells which it is
  static const std::regex named(R"re(`([a-z_/]+/[a-z_]+\.(?:hpp|cpp|def|cmake|sh))`)re");
  for (const docs::Document& document : docs::documents()) {
    const std::string text = docs::readFile(fs::path(SK_DOCS_SOURCE) / document.name);
    for (std::sregex_iterator it(text.begin(), text.end(), named), end; it != end; ++it) {
      const std::string tail = "/" + (*it)[1].str();
      INFO(document.name << ": " << tail);
      CHECK(std::ranges::any_of(sources, [&](const std::string& file) { return file.ends_with(tail); }));
    }
  }
}

TEST_CASE("tables of benchmarks say when they were measured", "[text]") {
  const std::string begin = "<!-- bench ", end = "<!-- /bench -->";
  const std::regex dated("Measured (on|by) 20[0-9]{2}-[01][0-9]-[0-3][0-9]\\.\n");
  int tables = 0;
  for (const docs::Document& document : docs::documents()) {
    const std::string text = docs::readFile(fs::path(SK_DOCS_SOURCE) / document.name);
    for (std::size_t at = text.find("\n" + begin); at != std::string::npos;
         at = text.find("\n" + begin, at + 1)) {
      const std::string mark = text.substr(at + 1, text.find("-->", at) - at - 1);
      if (mark.ends_with("machine ")) continue;
      const std::size_t last = text.find(end, at);
      INFO(document.name << ": " << mark);
      REQUIRE(last != std::string::npos);
      const std::size_t line = text.rfind('\n', last - 2) + 1;
      CHECK(std::regex_match(text.substr(line, last - line), dated));
      ++tables;
    }
  }
  CHECK(tables > 10);
}

TEST_CASE("docs/api.md lists what the public headers declare", "[text]") {
  const std::string index = docs::readFile(fs::path(SK_DOCS_SOURCE) / "docs/api.md");
  // Types, and members of the classes that programs use: at most two spaces in, and in no inner namespace.
  static const std::regex declared(
      R"re(^(?:(?:class|struct|enum class) (\w+)|  (?:[\w:<>&*]+ )+(\w+)\([^()]*\)(?: const| noexcept)*(?:;| \{.*)).*$)re");
  for (const char* header :
       {"algorithm", "arithmetic", "call", "device", "error", "future", "iter", "loop", "narrow", "options",
        "rows", "scalar", "shape", "stream", "table", "linear", "sparse_matrix"}) {
    const bool isLinear = header == std::string_view("linear") || header == std::string_view("sparse_matrix");
    const std::string file = fmt::format("runtime/{}include/sk/{}.hpp", isLinear ? "linear/" : "", header);
    std::string space = "sk";
    bool isPrivate = false;
    for (const std::string& line : docs::linesOf(docs::readFile(fs::path(SK_DOCS_SOURCE) / file))) {
      if (line.starts_with("namespace detail")) space = "detail";
      if (line.starts_with("}  // namespace detail")) space = "sk";
      if (line == " private:") isPrivate = true;
      if (line == "};") isPrivate = false;
      std::smatch match;
      if (space != "sk" || isPrivate || line.find("// the runtime's own") != std::string::npos) continue;
      if (!std::regex_match(line, match, declared)) continue;
      if (match[1].matched && line.ends_with(';')) continue;  // declared in another header
      const std::string name = match[1].matched ? match[1].str() : match[2].str();
      INFO(file << ": " << line);
      CHECK(std::regex_search(index, std::regex("\\b" + name + "\\b")));
    }
  }
}

TEST_CASE("headings of a document have anchors of their own", "[text]") {
  for (const docs::Document& document : docs::documents()) {
    std::set<std::string> anchors;
    for (const docs::Heading& heading : document.headings) {
      INFO(document.name << ":" << heading.line << ": " << heading.text);
      CHECK(anchors.insert(docs::anchorOf(heading.text)).second);
    }
  }
}

namespace {

/// What a comment <!-- test: FILE "NAME" "NAME" --> says: a file in the repository, and tests in it.
struct NamedTests {
  std::string file;
  std::vector<std::string> names;
};

std::vector<NamedTests> testsIn(const std::string& text) {
  static const std::regex comment(R"re(<!-- test: ([^ ]+)((?: "[^"]*")*) -->)re"), quoted(R"re("([^"]*)")re");
  std::vector<NamedTests> tests;
  for (std::sregex_iterator it(text.begin(), text.end(), comment), end; it != end; ++it) {
    NamedTests& test = tests.emplace_back(NamedTests{(*it)[1], {}});
    const std::string names = (*it)[2];
    for (std::sregex_iterator name(names.begin(), names.end(), quoted); name != end; ++name)
      test.names.push_back((*name)[1]);
  }
  return tests;
}

/// Paragraphs, lists and tables, with the comments behind them; nothing of code, quotes and headings.
std::vector<docs::Piece> paragraphsOf(const docs::Document& document) {
  std::vector<docs::Piece> paragraphs;
  bool isCode = false, isPrelude = false, isNew = true;
  int number = 0;
  for (const std::string& line : docs::linesOf(docs::readFile(fs::path(SK_DOCS_SOURCE) / document.name))) {
    ++number;
    if (line.starts_with("```")) isCode = !isCode;
    if (line.starts_with("<!-- prelude")) isPrelude = true;
    const bool isText = !isCode && !isPrelude && !line.starts_with("```") && !line.starts_with("#") &&
                        !line.starts_with("> ") && !line.starts_with("![");
    if (line == "-->") isPrelude = false;
    if (line.empty() || !isText) {
      // A comment of what an example shows belongs to the block below it, and one behind a blank line to no paragraph.
      isNew = true;
      continue;
    }
    if (isNew) paragraphs.push_back({"", "", number});
    isNew = false;
    paragraphs.back().text += line + "\n";
  }
  std::erase_if(paragraphs, [](const docs::Piece& piece) {
    return piece.text.starts_with("<!-- sk ") || piece.text == "-->\n";
  });
  return paragraphs;
}

}  // namespace

TEST_CASE("every paragraph of docs/accuracy.md names the tests of its promises", "[text]") {
  const docs::Document* accuracy = documentAt("docs/accuracy.md");
  REQUIRE(accuracy != nullptr);
  for (const docs::Piece& paragraph : paragraphsOf(*accuracy)) {
    INFO("docs/accuracy.md:" << paragraph.line << ": " << paragraph.text);
    const std::vector<NamedTests> tests = testsIn(paragraph.text);
    const bool promisesNothing = paragraph.text.find("<!-- no promise -->") != std::string::npos;
    CHECK((!tests.empty() || promisesNothing));
    for (const NamedTests& test : tests) {
      const fs::path file = fs::path(SK_DOCS_SOURCE) / test.file;
      INFO(test.file);
      REQUIRE(fs::exists(file));
      const std::string text = docs::readFile(file);
      for (const std::string& name : test.names) {
        INFO(name);
        CHECK(text.find('"' + name + '"') != std::string::npos);
      }
    }
  }
}

TEST_CASE("commands in sh blocks exist", "[text]") {
  const std::string help = docs::run("./dev help", SK_DOCS_SOURCE).output;
  const fs::path folder = docs::workFolder("commands");
  // what the reader builds, or what a machine without these tools would have
  const std::set<std::string> known = {"build/release/tests/docs/docs_figures",
                                       "build/fuzzer/bin/parse_picture",
                                       "./app",
                                       "./saxpy",
                                       "./edges",
                                       "./stats",
                                       "./drift",
                                       "apt-get",
                                       "cd",
                                       "git",
                                       "npm",
                                       "npx",
                                       "skc"};
  for (const docs::Block* block : docs::blocksOf("sh")) {
    for (const std::string& line : docs::linesOf(block->text)) {
      if (line.empty() || line.front() == '#') continue;
      const std::string command = commandOf(line);
      INFO(block->place() << ": " << line);
      if (command == "./dev") {
        std::istringstream words(line.substr(line.find("./dev") + 5));
        std::string which;
        words >> which;
        CHECK(help.find("\n  " + which + " ") != std::string::npos);
      } else if (!known.contains(command)) {
        CHECK(docs::run("command -v " + command, folder).status == 0);
      }
    }
  }
}

TEST_CASE("docs/language.md lists the options of skc", "[text]") {
  const std::string help = docs::run("skc --help", docs::workFolder("help")).output;
  std::set<std::string> listed, there;
  const auto take = [](const std::string& text, std::set<std::string>& options) {
    static const std::regex option(R"re((?:^|[ `,])(--?[A-Za-z][a-z-]*))re");
    for (std::sregex_iterator it(text.begin(), text.end(), option), end; it != end; ++it)
      options.insert((*it)[1]);
  };
  for (const docs::Document& document : docs::documents()) {
    if (document.name != "docs/language.md") continue;
    for (const docs::Piece& row : document.rows) {
      if (row.section == "Compiling") take(row.text.substr(0, row.text.find('|', 1)), listed);
    }
  }
  for (const std::string& line : docs::linesOf(help)) {
    if (line.starts_with("  -")) take(line.substr(0, 30), there);
  }
  there.erase("-h");
  CHECK(listed == there);
}

TEST_CASE("functions in CMake blocks exist", "[text]") {
  const std::string defined = docs::readFile(fs::path(SK_DOCS_SOURCE) / "compiler/SkKernels.cmake") +
                              docs::readFile(fs::path(SK_DOCS_SOURCE) / "cmake/SkTargets.cmake") +
                              docs::readFile(fs::path(SK_DOCS_SOURCE) / "examples/CMakeLists.txt");
  for (const docs::Block* block : docs::blocksOf("cmake")) {
    for (const std::string& line : docs::linesOf(block->text)) {
      const std::string bare = docs::trimmed(line);
      if (!bare.starts_with("sk_")) continue;
      INFO(block->place() << ": " << line);
      CHECK(defined.find("function(" + bare.substr(0, bare.find('(')) + " ") != std::string::npos);
    }
  }
}

namespace {

/// Blocks that tests/web checks: TypeScript, whose compiler is only there, and configuration for Vite.
bool isOfWeb(const std::string& language) { return language == "ts" || language == "js"; }

}  // namespace

TEST_CASE("blocks of code are of kinds that are checked", "[text]") {
  const std::set<std::string> checked = {"sk", "c++", "glsl", "ir", "sh", "console", "cmake"};
  for (const docs::Document& document : docs::documents()) {
    if (document.name.starts_with("examples/")) continue;  // usage lines, in words
    for (const docs::Block& block : document.blocks) {
      INFO(block.place() << ": '" << block.language << "'");
      CHECK((checked.contains(block.language) || block.language == "text" || isOfWeb(block.language)));
    }
  }
}
