// SPDX-License-Identifier: MIT
//
// Compiles every .sk file of this folder and compares skc's messages with what its comments expect:
//
//   // expected-error {{text}}        on this line, containing the text
//   // expected-warning@-1 {{text}}   on the line before; @+1 on the next; @* on any line or none
//
// A first line `// options: -W...` gives skc these.
//
// Every expectation must be met, and no error or warning may come that is not expected.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

namespace {

namespace fs = std::filesystem;

struct Message {
  int line;              ///< 0: any
  std::string severity;
  std::string text;
  std::string show() const { return std::to_string(line) + ": " + severity + ": " + text; }
};

std::vector<Message> expectations(const fs::path& file) {
  static const std::regex pattern(
      R"re(expected-(error|warning|note)(?:@([-+*])(\d*))? \{\{(.*?)\}\}(?!\}))re");
  std::vector<Message> found;
  std::ifstream in(file);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    for (std::sregex_iterator it(line.begin(), line.end(), pattern), end; it != end; ++it) {
      int at = number;
      if ((*it)[2] == "-") at -= std::stoi((*it)[3]);
      if ((*it)[2] == "+") at += std::stoi((*it)[3]);
      if ((*it)[2] == "*") at = 0;
      found.push_back({at, (*it)[1], (*it)[4]});
    }
  }
  return found;
}

struct Outcome {
  int status;
  std::vector<Message> messages;
};

std::string optionsOf(const fs::path& file) {
  constexpr std::string_view start = "// options: ";
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line.starts_with(start) ? line.substr(start.size()) : "";
}

Outcome compile(const fs::path& file) {
  static const std::regex pattern(R"re(^(?:[^:]+:(\d+):\d+: )?(?:fatal )?(error|warning|note): (.*)$)re");
  const std::string command =
      std::string(SKC_PATH) + " --emit=glsl " + optionsOf(file) + " '" + file.string() + "' 2>&1 >/dev/null";
  Outcome outcome{-1, {}};
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe);
  std::string output;
  std::array<char, 4096> buffer;
  while (std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe))
    output.append(buffer.data(), count);
  const int closed = pclose(pipe);
  outcome.status = WIFEXITED(closed) ? WEXITSTATUS(closed) : -1;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    std::smatch parts;
    if (std::regex_match(line, parts, pattern)) {
      outcome.messages.push_back({parts[1].matched ? std::stoi(parts[1]) : 0, parts[2], parts[3]});
    }
  }
  return outcome;
}

bool meets(const Message& expected, const Message& message) {
  return expected.severity == message.severity && (expected.line == 0 || expected.line == message.line) &&
         message.text.find(expected.text) != std::string::npos;
}

}  // namespace

TEST_CASE("every message is the one that the file expects", "[diagnostics]") {
  int files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(DIAGNOSTICS_DIR)) {
    if (entry.path().extension() != ".sk") continue;
    ++files;
    DYNAMIC_SECTION(entry.path().filename().string()) {
      const std::vector<Message> expected = expectations(entry.path());
      REQUIRE(!expected.empty());
      const Outcome outcome = compile(entry.path());
      bool errors = false;
      std::vector<bool> used(outcome.messages.size(), false);
      for (const Message& one : expected) {
        errors = errors || one.severity == "error";
        bool met = false;
        for (std::size_t i = 0; i < outcome.messages.size() && !met; ++i) {
          if (!used[i] && meets(one, outcome.messages[i])) used[i] = met = true;
        }
        INFO("expected " << one.show());
        CHECK(met);
      }
      for (std::size_t i = 0; i < outcome.messages.size(); ++i) {
        INFO("came unexpected: " << outcome.messages[i].show());
        CHECK((used[i] || outcome.messages[i].severity == "note"));
      }
      CHECK(outcome.status == (errors ? 1 : 0));
    }
  }
  CHECK(files > 10);
}
