// SPDX-License-Identifier: MIT
//
// Promises: a function with a table is either looked up or called, under the same name. (glslang_test.cpp
// compiles both with glslang, tests/run checks their results.)
#include "assemble/glsl/tables.hpp"

#include <array>
#include <string>

#include <catch2/catch.hpp>

using namespace sk::assemble;
using sk::program::Table;
using sk::program::TableUse;

namespace {

constexpr Table line{"line", {0, 1, 16}, sk::Interpolation::Linear, nullptr};
constexpr Table curve{"curve", {0, 1, 16}, sk::Interpolation::Cubic, nullptr};

bool holds(const std::string& text, std::string_view what) { return text.find(what) != std::string::npos; }

TEST_CASE("functions that are computed are called") {
  const std::array uses = {TableUse{&line, "f"}};
  CHECK(tableDefinitions(uses, false) ==
        "\nfloat f(float);\nfloat sk_table_f(float sk_x) { return f(sk_x); }\n");
}

TEST_CASE("functions that are looked up have a texture and a range each") {
  const std::array uses = {TableUse{&line, "f"}, TableUse{&curve, "g"}};
  const std::string text = tableDefinitions(uses, true);
  for (const std::string function : {"f", "g"}) {
    CHECK(holds(text, "uniform sampler2D " + tableName(function) + ";"));
    CHECK(holds(text, "uniform vec3 " + rangeName(function) + ";"));
    CHECK(holds(text, "float sk_table_" + function + "(float sk_x) {"));
  }
  CHECK(holds(text, "vec2 sk_c = texelFetch(sk_values_f,"));
  CHECK(holds(text, "vec4 sk_c = texelFetch(sk_values_g,"));
}

TEST_CASE("a kernel without tables has no definitions") { CHECK(tableDefinitions({}, true).empty()); }

}  // namespace
