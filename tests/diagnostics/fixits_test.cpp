// SPDX-License-Identifier: MIT
//
// Applies what `skc --fixits` proposes for each file of the folder fixits, and compiles the result, which must
// have no mistake left.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status;
  std::string messages;
};

Outcome compile(const fs::path& file) {
  const std::string command =
      std::string(SKC_PATH) + " --fixits --emit=glsl '" + file.string() + "' 2>&1 >/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe);
  std::string output;
  std::array<char, 4096> buffer;
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe))
    output.append(buffer.data(), count);
  const int closed = pclose(pipe);
  return {WIFEXITED(closed) ? WEXITSTATUS(closed) : -1, output};
}

std::string textOf(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Change {
  std::size_t begin, end;  ///< bytes of the file
  std::string text;
};

std::size_t offsetOf(const std::string& text, int line, int column) {
  std::size_t at = 0;
  for (int i = 1; i < line; ++i) at = text.find('\n', at) + 1;
  return at + static_cast<std::size_t>(column) - 1;
}

/// fix-it:"file":{2:1-2:1}:"stream "
std::vector<Change> changesIn(const std::string& messages, const std::string& text) {
  static const std::regex pattern(R"re(fix-it:"[^"]*":\{(\d+):(\d+)-(\d+):(\d+)\}:"([^"]*)")re");
  std::vector<Change> changes;
  for (std::sregex_iterator it(messages.begin(), messages.end(), pattern), end; it != end; ++it) {
    const std::smatch& m = *it;
    changes.push_back({offsetOf(text, std::stoi(m[1]), std::stoi(m[2])),
                       offsetOf(text, std::stoi(m[3]), std::stoi(m[4])), m[5]});
  }
  return changes;
}

std::string changed(std::string text, std::vector<Change> changes) {
  std::sort(changes.begin(), changes.end(),
            [](const Change& a, const Change& b) { return a.begin > b.begin; });
  for (const Change& change : changes) text.replace(change.begin, change.end - change.begin, change.text);
  return text;
}

std::size_t errorsIn(const std::string& messages) {
  static const std::regex pattern(R"re(: error: )re");
  return static_cast<std::size_t>(
      std::distance(std::sregex_iterator(messages.begin(), messages.end(), pattern), std::sregex_iterator()));
}

}  // namespace

TEST_CASE("every fix-it that is proposed fixes its mistake", "[fixits]") {
  const fs::path folder = fs::path(FIXITS_OUTPUT);
  fs::create_directories(folder);
  int files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(FIXITS_DIR)) {
    if (entry.path().extension() != ".sk") continue;
    ++files;
    DYNAMIC_SECTION(entry.path().filename().string()) {
      const std::string text = textOf(entry.path());
      const Outcome before = compile(entry.path());
      const std::vector<Change> changes = changesIn(before.messages, text);
      INFO(before.messages);
      CHECK(before.status == 1);
      CHECK(changes.size() == errorsIn(before.messages));
      const fs::path fixed = folder / entry.path().filename();
      std::ofstream(fixed) << changed(text, changes);
      const Outcome after = compile(fixed);
      INFO(after.messages);
      CHECK(after.status == 0);
    }
  }
  CHECK(files > 0);
}
