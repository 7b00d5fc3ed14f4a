// SPDX-License-Identifier: MIT
#include "call/test_values.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include <catch2/catch.hpp>

namespace sk {
namespace {

using program::ScatterOp;
using ElementBytes = std::array<std::byte, 8>;

/// An element of one scalar.
struct OneScalar {
  explicit OneScalar(program::Scalar scalar) : field{{"", scalar, 1, 0}} {}

  std::array<program::Field, 1> field;
  program::Element element{"T", "T", 8, field};
};

ElementBytes testValueOf(const program::Element& element, int number, Storage storage = Storage::Single) {
  ElementBytes bytes{};
  setTestValue(element, storage, number, bytes.data());
  return bytes;
}

template <class T>
T scalarIn(const ElementBytes& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

TEST_CASE("the test values of each type begin with 0, differ from it, and are no NaN", "[test values]") {
  for (int scalar = 0; scalar <= static_cast<int>(program::Scalar::Snorm16); ++scalar) {
    const OneScalar one(static_cast<program::Scalar>(scalar));
    CAPTURE(scalar);
    const ElementBytes zero = testValueOf(one.element, 0);
    CHECK(zero == ElementBytes{});
    for (int number = 1; number < testValueCount; ++number) {
      const ElementBytes value = testValueOf(one.element, number);
      CHECK_FALSE(hasNaN(one.element, value.data()));
      if (one.field[0].scalar == program::Scalar::Bool) continue;
      CHECK_FALSE(haveSameValues(one.element, zero.data(), value.data()));
      CHECK_FALSE(haveSameValues(one.element, testValueOf(one.element, number - 1).data(), value.data()));
    }
  }
  const OneScalar number(program::Scalar::Float), small(program::Scalar::Half), flag(program::Scalar::Bool);
  CHECK(scalarIn<float>(testValueOf(number.element, 2)) == -7.5F);
  CHECK(scalarIn<float>(testValueOf(number.element, 4)) == -1e9F);
  CHECK(scalarIn<float>(testValueOf(number.element, 4, Storage::Half)) == -30000);  // a half can hold it
  CHECK(scalarIn<std::uint16_t>(testValueOf(small.element, 1)) == 0x4280);  // 3.25
  CHECK(scalarIn<std::uint8_t>(testValueOf(flag.element, 1)) == 1);
}

TEST_CASE("zeros of both signs are the same value, and so are NaNs", "[test values]") {
  const OneScalar number(program::Scalar::Float);
  const auto same = [&](float a, float b) {
    const auto x = std::bit_cast<std::array<std::byte, 4>>(a), y = std::bit_cast<std::array<std::byte, 4>>(b);
    return haveSameValues(number.element, x.data(), y.data());
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(same(0, -0.0F));
  CHECK(same(nan, -nan));
  CHECK_FALSE(same(0, nan));
  CHECK_FALSE(same(1, -1));
  CHECK_FALSE(same(0, std::numeric_limits<float>::denorm_min()));
}

TEST_CASE("a value that a scatter output combines with anything gives that", "[test values]") {
  const auto neutral = [](program::Scalar scalar, ScatterOp op) {
    const OneScalar one(scalar);
    ElementBytes bytes{};
    setNeutral(one.element, op, bytes.data());
    return bytes;
  };
  CHECK(scalarIn<float>(neutral(program::Scalar::Float, ScatterOp::Min)) ==
        std::numeric_limits<float>::infinity());
  CHECK(scalarIn<float>(neutral(program::Scalar::Float, ScatterOp::Max)) ==
        -std::numeric_limits<float>::infinity());
  CHECK(scalarIn<float>(neutral(program::Scalar::Float, ScatterOp::Add)) == 0);
  CHECK(scalarIn<std::int32_t>(neutral(program::Scalar::Int, ScatterOp::Max)) ==
        std::numeric_limits<std::int32_t>::min());
  CHECK(scalarIn<std::uint32_t>(neutral(program::Scalar::Uint, ScatterOp::Max)) == 0);
  CHECK(scalarIn<std::uint32_t>(neutral(program::Scalar::Uint, ScatterOp::Min)) ==
        std::numeric_limits<std::uint32_t>::max());
}

}  // namespace
}  // namespace sk
