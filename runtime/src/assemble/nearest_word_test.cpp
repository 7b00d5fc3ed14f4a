// SPDX-License-Identifier: MIT
#include "assemble/nearest_word.hpp"

#include <string>
#include <vector>

#include <catch2/catch.hpp>

using sk::assemble::nearestWord;

TEST_CASE("the nearest word is the one that was meant", "[assemble]") {
  const std::vector<std::string> known = {"--emit", "--kernel", "--version", "-o", "info", "accuracy"};
  CHECK(nearestWord("--emti", known) == "--emit");
  CHECK(nearestWord("--verson", known) == "--version");
  CHECK(nearestWord("inof", known) == "info");
  CHECK(nearestWord("acuracy", known) == "accuracy");
  CHECK(nearestWord("emit", known).empty());
  CHECK(nearestWord("frobnicate", known).empty());
  CHECK(nearestWord("", known).empty());
  CHECK(nearestWord("info", {}).empty());
}
