// SPDX-License-Identifier: MIT
#include "toml/read_toml.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include <catch2/catch.hpp>

using namespace sk;

namespace {

namespace fs = std::filesystem;

/// "LINE: message", or the number of top-level keys.
std::string read(const std::string& text) {
  const fs::path file = fs::temp_directory_path() / ("sk_toml_" + std::to_string(::getpid()));
  std::ofstream(file, std::ios::binary) << text;
  std::string found;
  try {
    found = std::to_string(readToml(file).size());
  } catch (const toml::parse_error& error) {
    found = std::to_string(error.source().begin.line) + ": " + std::string(error.description());
  }
  fs::remove(file);
  return found;
}

std::string repeated(const std::string& piece, int count) {
  std::string text;
  while (count-- > 0) text += piece;
  return text;
}

}  // namespace

TEST_CASE("a header that begins with no key is an error with a line") {
  for (const std::string header : {"[[[a]]]", "[=]", "[[=", "[[[", "[[", "[", "[\x01]", "[#]"}) {
    CHECK_THAT(read("x = 1\n" + header), Catch::StartsWith("2: "));
  }
}

TEST_CASE("keys have 32 parts at most, wherever they are") {
  const std::string most = repeated("a.", 31) + "a", more = "b." + most;
  CHECK(read(most + " = 1\n") == "1");
  CHECK(read("[" + most + "]\n") == "1");
  const std::string message = "3: a key has more than 32 parts";
  CHECK(read("x = 1\n\n" + more + " = 1\n") == message);
  CHECK(read("\n\n[[" + more + "]]\n") == message);
  CHECK(read("y = '''\n'''\nx = {a = 1, " + more + " = 1}\n") == message);
  CHECK(read("y = \"\"\"\n\n\\\"\"\"\"\", " + more + "\n") == message);
  CHECK(read("y = [\n'#',\n{a = \"\\\"\", " + more + " = 1}]\n") == message);
  CHECK(read("y = 'it\n\n" + more) == message);
  CHECK_THAT(read(repeated("a.", 500'000) + "a = 1\n"), Catch::StartsWith("1: a key"));
}

TEST_CASE("dots outside of keys count for nothing") {
  const std::string dots = repeated("a.", 100);
  CHECK(read("# " + dots + "\nx = 1\n") == "1");
  CHECK(read("x = \"" + dots + "\"\ny = '" + dots + "'\nz = '''\n" + dots + "'''''\n") == "3");
  CHECK(read("x = [" + repeated("0.5, ", 100) + "]\n") == "1");
  CHECK(read("\"" + dots + "\" = 1\n") == "1");
}

TEST_CASE("a file that is none, or too large, is an error without a line") {
  CHECK_THAT(read(std::string(std::size_t{17} << 20, '\n')), Catch::StartsWith("0: File is larger"));
  CHECK_THROWS_AS(readToml("/none"), toml::parse_error);
  CHECK_THROWS_AS(readToml("/"), toml::parse_error);
  CHECK_THROWS_AS(readToml("/dev/zero"), toml::parse_error);
}
