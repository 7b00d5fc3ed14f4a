// SPDX-License-Identifier: MIT
#include "gl_device/memory/element_packing.hpp"

#include <array>
#include <cstring>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/types.hpp"

using namespace sk;

namespace {

struct Mixed {
  float3 position;
  bool alive;
  int2 cell;
};
constexpr program::Field mixedFields[] = {{"position", program::Scalar::Float, 3, offsetof(Mixed, position)},
                                          {"alive", program::Scalar::Bool, 1, offsetof(Mixed, alive)},
                                          {"cell", program::Scalar::Int, 2, offsetof(Mixed, cell)}};
constexpr program::Element mixed{"Mixed", "Mixed", sizeof(Mixed), mixedFields};

template <class T>
const std::byte* bytesOf(const T* values) {
  return reinterpret_cast<const std::byte*>(values);
}

}  // namespace

TEST_CASE("which elements are texels as they are") {
  CHECK(areTexels(ElementTraits<float>::element()));
  CHECK(areTexels(ElementTraits<int2>::element()));
  CHECK(areTexels(ElementTraits<uint4>::element()));
  CHECK_FALSE(areTexels(ElementTraits<float3>::element()));
  CHECK_FALSE(areTexels(ElementTraits<bool>::element()));
  CHECK_FALSE(areTexels(mixed));
}

TEST_CASE("three components go to four channels, the last 0") {
  const float3 values[] = {{1, 2, 3}, {4, 5, 6}};
  std::array<float, 8> texels{};
  texels.fill(9);
  const program::Element& element = ElementTraits<float3>::element();
  packTexels(element, element.fields[0], bytesOf(values), 2, reinterpret_cast<std::byte*>(texels.data()));
  CHECK(texels == std::array<float, 8>{1, 2, 3, 0, 4, 5, 6, 0});
  float3 back[2] = {};
  unpackTexels(element, element.fields[0], bytesOf(texels.data()), 2, reinterpret_cast<std::byte*>(back));
  CHECK(back[0] == values[0]);
  CHECK(back[1] == values[1]);
}

TEST_CASE("bools are 0 or 1 on both sides") {
  const program::Element& element = ElementTraits<bool3>::element();
  const std::array<std::uint8_t, 6> bytes{1, 0, 255, 0, 2, 0};
  std::array<std::uint8_t, 8> texels{};
  texels.fill(7);
  packTexels(element, element.fields[0], bytesOf(bytes.data()), 2,
             reinterpret_cast<std::byte*>(texels.data()));
  CHECK(texels == std::array<std::uint8_t, 8>{1, 0, 1, 0, 0, 1, 0, 0});
  texels = {9, 0, 1, 77, 0, 0, 3, 77};
  std::array<std::uint8_t, 6> back{};
  unpackTexels(element, element.fields[0], bytesOf(texels.data()), 2,
               reinterpret_cast<std::byte*>(back.data()));
  CHECK(back == std::array<std::uint8_t, 6>{1, 0, 1, 0, 0, 1});
}

TEST_CASE("planes of a struct touch their own members only") {
  std::vector<Mixed> elements{{{1, 2, 3}, true, {4, 5}}, {{6, 7, 8}, false, {9, 10}}};
  std::array<std::int32_t, 4> cells{};
  packTexels(mixed, mixedFields[2], bytesOf(elements.data()), 2, reinterpret_cast<std::byte*>(cells.data()));
  CHECK(cells == std::array<std::int32_t, 4>{4, 5, 9, 10});
  cells = {-1, -2, -3, -4};
  unpackTexels(mixed, mixedFields[2], bytesOf(cells.data()), 2,
               reinterpret_cast<std::byte*>(elements.data()));
  CHECK(elements[0].cell == int2{-1, -2});
  CHECK(elements[1].cell == int2{-3, -4});
  CHECK(elements[0].position == float3{1, 2, 3});
  CHECK(elements[0].alive);
}

TEST_CASE("wide texels narrow without a change of bits") {
  const std::array<std::uint32_t, 8> wide{0x7f800001, 1, 2, 3, 0xffffffff, 5, 6, 7};
  std::array<std::uint32_t, 4> two{};
  narrowTexels(gl::formatOf(program::Scalar::Float, 2), bytesOf(wide.data()), 2,
               reinterpret_cast<std::byte*>(two.data()));
  CHECK(two == std::array<std::uint32_t, 4>{0x7f800001, 1, 0xffffffff, 5});
  const std::array<std::uint32_t, 8> bools{1, 0, 0, 1, 0, 1, 0, 1};
  std::array<std::uint8_t, 2> one{};
  narrowTexels(gl::formatOf(program::Scalar::Bool, 1), bytesOf(bools.data()), 2,
               reinterpret_cast<std::byte*>(one.data()));
  CHECK(one == std::array<std::uint8_t, 2>{1, 0});
}
