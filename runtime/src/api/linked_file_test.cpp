// SPDX-License-Identifier: MIT
#include "sk/linked_file.hpp"

#include <array>
#include <optional>
#include <string_view>

#include <catch2/catch.hpp>

using sk::program::LinkedFile;

TEST_CASE("a program has the code that each of its files has") {
  CHECK(LinkedFile::ofAll().glsl);
  CHECK_FALSE(LinkedFile::ofAll().native);
  const LinkedFile both({.glsl = true, .native = true});
  CHECK(LinkedFile::ofAll().glsl);
  CHECK(LinkedFile::ofAll().native);
  std::optional<LinkedFile> loaded(std::in_place, LinkedFile::Code{.glsl = true, .native = false});
  CHECK(LinkedFile::ofAll().glsl);
  CHECK_FALSE(LinkedFile::ofAll().native);
  loaded.reset();
  CHECK(LinkedFile::ofAll().native);
  const LinkedFile nativeAlone({.glsl = false, .native = true});
  CHECK_FALSE(LinkedFile::ofAll().glsl);
  CHECK(LinkedFile::ofAll().native);
}

TEST_CASE("a program knows the names of each of its files") {
  constexpr std::array<std::string_view, 2> kernels = {"heat::diffuse", "heat::total"};
  constexpr std::array<std::string_view, 1> tables = {"heat::response"};
  {
    const LinkedFile unnamed({.glsl = true, .native = true});
    const LinkedFile heat({.glsl = true, .native = true}, kernels, tables);
    CHECK(LinkedFile::namesOfAll().kernels == std::vector<std::string>{"heat::diffuse", "heat::total"});
    CHECK(LinkedFile::namesOfAll().tables == std::vector<std::string>{"heat::response"});
  }
  CHECK(LinkedFile::namesOfAll().kernels.empty());
}
