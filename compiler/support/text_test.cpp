// SPDX-License-Identifier: MIT
#include "support/text.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>
#include <vector>

#include <catch2/catch.hpp>

namespace skc {
namespace {

TEST_CASE("a double reads back as the same double") {
  CHECK(shortestDouble(0.1) == "0.1");
  CHECK(shortestDouble(1) == "1.0");
  CHECK(shortestDouble(1e300) == "1e+300");
  CHECK(shortestDouble(-1.0 / 0.0) == "-inf");
}

TEST_CASE("floats are short and always read as floats") {
  CHECK(shortestFloat(1.0F) == "1.0");
  CHECK(shortestFloat(0.1F) == "0.1");
  CHECK(shortestFloat(-0.0F) == "-0.0");
  CHECK(shortestFloat(1e30F) == "1e+30");
  CHECK(shortestFloat(16777216.0F) == "16777216.0");
}

TEST_CASE("floats read back as the same bits") {
  std::mt19937 random(1);
  for (int i = 0; i < 10000; ++i) {
    const float value = std::ldexp(static_cast<float>(random()), static_cast<int>(random() % 240) - 150);
    CHECK(std::strtof(shortestFloat(value).c_str(), nullptr) == value);
  }
}

TEST_CASE("a line that fits is left alone") { CHECK(wrapLine("  v = f(a, b);", 20) == "  v = f(a, b);"); }

TEST_CASE("a long line is broken where brackets are shallow") {
  CHECK(wrapLine("  v = alpha(one, two) + beta(three, four);", 34) ==
        "  v = alpha(one, two) +\n"
        "      beta(three, four);");
}

TEST_CASE("a sum is broken between its terms, not inside one") {
  CHECK(wrapLine("  g = 0.21 * r + 0.71 * g + 0.07 * b;", 33) ==
        "  g = 0.21 * r + 0.71 * g +\n"
        "      0.07 * b;");
}

TEST_CASE("continuation lines begin where the caller says") {
  CHECK(wrapLine("void function(int one, int two)", 24, 14) ==
        "void function(int one,\n"
        "              int two)");
}

TEST_CASE("string literals are not broken") {
  const std::string line = "f(\"a, b, c, d, e, f, g, h\");";
  CHECK(wrapLine(line, 10) == line);
}

TEST_CASE("no line passes the limit where breaks exist") {
  std::string line = "  total = ";
  for (int i = 0; i < 20000; ++i) line += "f(x, " + std::to_string(i) + ") + ";
  line += "1;";
  std::istringstream lines(wrapLine(line, 80));
  for (std::string one; std::getline(lines, one);) CHECK(one.size() <= 80);
}

TEST_CASE("join puts the separator between items only") {
  CHECK(join(std::vector<std::string>{}, ", ").empty());
  CHECK(join(std::vector<std::string>{"a", "b"}, ", ") == "a, b");
}

}  // namespace
}  // namespace skc
