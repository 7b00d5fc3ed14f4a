// SPDX-License-Identifier: MIT
//
// A GLSL compiler's error names the line of the .sk file. Every number of lines.sk and of the file
// that it includes is made an unknown name in turn, in the GLSL alone; glslang must then report the
// number's own line, or one since its statement began, in the right file.
#include <regex>
#include <sstream>

#include <catch2/catch.hpp>

#include "glslang.hpp"
#include "skc.hpp"

using namespace golden;

namespace {

const std::regex number(R"(\b9[01]\d\d\b(\.5)?)");

struct Place {
  std::string number;
  int firstLine;   ///< where its statement begins
  int line;
};

/// The numbers of a .sk file. A statement begins after a line that ends in ; { } : or nothing.
std::vector<Place> placesOf(const fs::path& file) {
  std::vector<Place> places;
  std::istringstream lines(readFile(file));
  int first = 1, current = 0;
  for (std::string line; std::getline(lines, line);) {
    ++current;
    const bool isComment = line.starts_with("//");
    for (std::sregex_iterator it(line.begin(), line.end(), number), end; !isComment && it != end; ++it) {
      places.push_back({it->str(), first, current});
    }
    if (line.empty() || std::string(";{}:)").find(line.back()) != std::string::npos) first = current + 1;
  }
  return places;
}

}  // namespace

TEST_CASE("an error in GLSL is told at its line of the .sk file") {
  const fs::path folder = SK_GOLDEN_FOLDER;
  const fs::path files[] = {folder / "lines.sk", folder / "lines_included.sk"};  // sources 1 and 2 of #line
  for (const std::string profile : {"glsl330", "essl300"}) {
    const std::vector<std::string> programs =
        glslang::programsOf(skc("--emit=glsl --profile=" + profile, files[0]).output);
    REQUIRE(!programs.empty());
    std::vector<std::string> broken;
    std::vector<Place> places;
    std::vector<int> sources;
    for (int source = 1; source <= 2; ++source) {
      for (const Place& place : placesOf(files[source - 1])) {
        INFO(profile << ": " << place.number);
        std::size_t found = 0, at = 0;
        while (found < programs.size() && (at = programs[found].find(place.number)) == std::string::npos)
          ++found;
        REQUIRE(found < programs.size());
        std::string program = programs[found];
        broken.push_back(program.replace(at, place.number.size(), "no_such_name"));
        places.push_back(place);
        sources.push_back(source);
      }
    }
    REQUIRE(places.size() == 35);
    const auto complaints = glslang::complaintsOf(broken);
    for (std::size_t i = 0; i < places.size(); ++i) {
      INFO(profile << ": " << places[i].number << " of line " << places[i].line << " of source "
                   << sources[i]);
      REQUIRE(!complaints[i].empty());
      INFO("glslang says " << complaints[i][0].source << ":" << complaints[i][0].line << ": "
                           << complaints[i][0].text);
      CHECK(complaints[i][0].text.find("no_such_name") != std::string::npos);
      CHECK(complaints[i][0].source == sources[i]);
      CHECK(complaints[i][0].line >= places[i].firstLine);
      CHECK(complaints[i][0].line <= places[i].line);
    }
  }
}
