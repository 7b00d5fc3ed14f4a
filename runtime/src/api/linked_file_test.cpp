// SPDX-License-Identifier: MIT
#include "sk/linked_file.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

TEST_CASE("what is kept for a descriptor ends with its library") {
  static const int descriptor = 0, inSameObject[1] = {};
  static std::optional<LinkedFile> file;  // in the object that has the descriptor
  const auto onHeap = std::make_unique<int>();
  CHECK(LinkedFile::objectOf(&descriptor) == 0);
  CHECK(LinkedFile::isLoaded(0));

  file.emplace(LinkedFile::Code{.glsl = true, .native = true});
  const std::uint64_t first = LinkedFile::objectOf(&descriptor);
  CHECK(first != 0);
  CHECK(LinkedFile::objectOf(inSameObject) == first);
  CHECK(LinkedFile::objectOf(onHeap.get()) == 0);
  CHECK(LinkedFile::isLoaded(first));

  const std::uint64_t unloads = LinkedFile::unloads();
  file.reset();
  CHECK(LinkedFile::unloads() == unloads + 1);
  CHECK_FALSE(LinkedFile::isLoaded(first));
  file.emplace(LinkedFile::Code{.glsl = true, .native = true});
  CHECK(LinkedFile::objectOf(&descriptor) > first);
  CHECK_FALSE(LinkedFile::isLoaded(first));
  file.reset();
  CHECK(LinkedFile::objectOf(&descriptor) == 0);
}
