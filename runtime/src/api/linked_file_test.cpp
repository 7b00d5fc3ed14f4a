// SPDX-License-Identifier: MIT
#include "sk/linked_file.hpp"

#include <optional>

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
