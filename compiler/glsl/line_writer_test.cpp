// SPDX-License-Identifier: MIT
//
// Promise: lines keep their numbers, and #line corrects them where they cannot.
#include "glsl/line_writer.hpp"

#include <catch2/catch.hpp>

namespace skc::emit {
namespace {

Loc at(std::uint32_t line, std::uint32_t file = 0) { return {.token = 1, .line = line, .file = file}; }

TEST_CASE("what follows on the next line needs nothing") {
  LineWriter writer;
  writer.restart(at(3));
  writer.put(0, at(3), "a;");
  writer.put(1, at(4), "b;");
  CHECK(writer.take() == "#line 3 1\na;\n  b;\n");
}

TEST_CASE("what stood on one line stays on one line, as far as it fits") {
  LineWriter writer;
  writer.restart(at(3));
  writer.put(0, at(3), "a;");
  writer.put(0, at(3), "b;");
  writer.put(0, at(3), std::string(98, 'c') + ";");
  writer.put(0, at(4), "d;");
  CHECK(writer.take() == "#line 3 1\na; b;\n" + std::string(98, 'c') + ";\n#line 4 1\nd;\n");
}

TEST_CASE("small gaps are left blank, larger ones and steps back are told") {
  LineWriter writer;
  writer.restart(at(3));
  writer.put(0, at(3), "a;");
  writer.put(0, at(7), "b;");
  writer.put(0, at(12), "c;");
  writer.put(0, at(11), "d;");
  writer.put(0, at(12, 1), "e;");
  CHECK(writer.take() == "#line 3 1\na;\n\n\n\nb;\n#line 12 1\nc;\n#line 11 1\nd;\n#line 12 2\ne;\n");
}

TEST_CASE("a bracket closes on its line while that goes on") {
  LineWriter writer;
  writer.restart(at(3));
  writer.put(0, at(3), "if (a) {");
  std::uint32_t openedAt = writer.row();
  writer.put(1, at(3), "b;");
  writer.close(0, openedAt, "}");
  writer.put(0, at(4), "if (c) {");
  openedAt = writer.row();
  writer.put(1, at(5), "d;");
  writer.close(0, openedAt, "}");
  CHECK(writer.take() == "#line 3 1\nif (a) { b; }\nif (c) {\n  d;\n}\n");
}

TEST_CASE("things without a place go to the next line") {
  LineWriter writer;
  writer.restart(at(3));
  writer.put(0, at(3), "a;");
  writer.put(0, {}, "b;");
  writer.put(0, at(5), "c;");
  CHECK(writer.take() == "#line 3 1\na;\nb;\nc;\n");
}

}  // namespace
}  // namespace skc::emit
