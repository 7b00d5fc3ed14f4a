// SPDX-License-Identifier: MIT
#include "text/text_cursor.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

namespace sk::text {
namespace {

using Lines = std::vector<std::vector<std::string>>;

/// The words of each line.
Lines split(std::string_view text, TextRules rules = {}) {
  TextCursor cursor("a.txt", text, rules);
  Lines lines;
  while (cursor.nextLine()) {
    lines.emplace_back();
    for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word())
      lines.back().emplace_back(word);
  }
  return lines;
}

double numberOf(std::string_view word) { return TextCursor("a.txt", {}).numberOf(word); }

TEST_CASE("lines end with LF, CR LF, CR or the text") {
  const Lines lines = {{"a", "b"}, {}, {"c"}};
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    CHECK(split(" a\tb " + end + end + "c") == lines);
    CHECK(split("\xEF\xBB\xBF"
                "a b" +
                end + end + "c" + end) == lines);
  }
  CHECK(split("a\r\n\rb\n\nc") == Lines{{"a"}, {}, {"b"}, {}, {"c"}});
  CHECK(split("").empty());
  CHECK_THROWS_WITH(split(std::string("\xFF\xFE"
                                      "a\0",
                                      4)),
                    "a.txt:1:1: the text is UTF-16; save it as UTF-8");
}

TEST_CASE("comments end lines, and backslashes continue them") {
  const TextRules rules{.comment = '#', .continues = true};
  CHECK(split("# a\nb # c\nd#e\n #\n", rules) == Lines{{}, {"b"}, {"d#e"}, {}});
  for (const std::string end : {"\n", "\r\n", "\r"})
    CHECK(split("a \\" + end + "b\\ " + end + " c" + end + "d", rules) == Lines{{"a", "b", "c"}, {"d"}});
  CHECK(split("# C:\\a\\\nb", rules) == Lines{{}, {"b"}});
  CHECK(split("a \\ # b\nc\\d", rules) == Lines{{"a", "\\"}, {"c\\d"}});
  CHECK(split("a \\", rules) == Lines{{"a"}});
  CHECK(split("a \\\n\n", rules) == Lines{{"a"}});
  CHECK(split("a \\\nb") == Lines{{"a", "\\"}, {"b"}});

  TextCursor cursor("a.txt", "a \\\n\\\nb c d\nwhole name # e\n", rules);
  REQUIRE(cursor.nextLine());
  cursor.word();
  cursor.word();
  CHECK_THROWS_WITH(cursor.fail("wrong"), "a.txt:3:1: wrong");
  REQUIRE(cursor.nextLine());  // past what was not read
  CHECK(cursor.rest() == "whole name");
  CHECK(cursor.rest().empty());
  CHECK_FALSE(cursor.nextLine());
}

TEST_CASE("numbers are written as in C and in Fortran") {
  const std::pair<const char*, double> numbers[] = {{"+2", 2},
                                                    {"-.5", -0.5},
                                                    {"4.", 4},
                                                    {"1e+00", 1},
                                                    {".8E01", 8},
                                                    {"2.0D+00", 2},
                                                    {"0.4d1", 4},
                                                    {"10D-1", 1},
                                                    {"1.5-100", 1e-100 * 1.5},
                                                    {"-1.5+100", -1.5e100},
                                                    {"1e400", HUGE_VAL},
                                                    {"-1e400", -HUGE_VAL},
                                                    {"1e-400", 0},
                                                    {"1d400", HUGE_VAL},
                                                    {"inf", HUGE_VAL},
                                                    {"+5e-324", 5e-324},
                                                    {"1e99999999999999999999", HUGE_VAL},
                                                    {"1e-99999999999999999999", 0},
                                                    {"0e999", 0}};
  for (const auto& [word, value] : numbers) {
    CAPTURE(word);
    CHECK(numberOf(word) == value);
  }
  CHECK(numberOf("0." + std::string(400, '0') + "1e10") == 0.0);
  CHECK(numberOf("0." + std::string(400, '0') + "1e402") == Approx(10.0));
  CHECK(numberOf("1" + std::string(400, '0') + "e-10") == HUGE_VAL);
  CHECK(std::isnan(numberOf("nan")));
  for (const char* word : {"", "+", "-", "+-5", "++5", "1x", "x", "1e", "d5", "1.0D", "1-2", "2020-01",
                           "1.5-10", "0x10", "1,5", "1 2"}) {
    CAPTURE(word);
    CHECK_THROWS_WITH(numberOf(word), Catch::EndsWith("' is no number"));
  }
  CHECK_FALSE(numberIn("12D5"));  // which need not be a number where other words may stand

  const TextCursor cursor("a.txt", {});
  CHECK(cursor.integerOf("+3") == 3);
  CHECK(cursor.integerOf("-3") == -3);
  for (const char* word : {"1.0", "1e3", "+-1", "9223372036854775808", "\\"})
    CHECK_THROWS_WITH(cursor.integerOf(word), Catch::EndsWith("' is no integer"));
}

TEST_CASE("errors name line and column") {
  TextCursor cursor("a.txt", "1 2\r3 x 4\r\n\n5");
  REQUIRE(cursor.nextLine());
  CHECK(cursor.needInteger("one") == 1);
  CHECK(cursor.needNumber("two") == 2);
  CHECK_THROWS_WITH(cursor.needNumber("three"), "a.txt:1:4: three is missing");
  REQUIRE(cursor.nextLine());
  CHECK(cursor.number() == 3.0);
  CHECK_THROWS_WITH(cursor.number(), "a.txt:2:3: 'x' is no number");
  CHECK_THROWS_WITH(cursor.endLine("a line is A B"), "a.txt:2:5: '4' is too much; a line is A B");
  CHECK(cursor.wordOnAnyLine() == "5");
  CHECK(cursor.wordOnAnyLine().empty());
  CHECK_THROWS_WITH(cursor.fail("it ends"), "a.txt:4:2: it ends");
}

TEST_CASE("bytes begin behind a line end like the first one") {
  const auto behind = [](std::string_view text) {
    TextCursor cursor("a.txt", text);
    cursor.nextLine();
    cursor.nextLine();
    return text.substr(cursor.bytesBehind());
  };
  CHECK(behind("a\nb\n\r\n") == "\r\n");
  CHECK(behind("a\r\nb\r\n\n") == "\n");
  CHECK(behind("a\rb\r\nc") == "\nc");
  CHECK(behind("a\nb\r\nc") == "c");
  CHECK(behind("a\nb").empty());
}

}  // namespace
}  // namespace sk::text
