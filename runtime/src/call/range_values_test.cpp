// SPDX-License-Identifier: MIT
//
// Promises: the ends of a range belong to it, as the type and the storage round them; NaN does not; the first number outside is named.
#include "call/range_values.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "sk/narrow.hpp"
#include "sk/types.hpp"

namespace sk {
namespace {

using program::ValueRange;
constexpr double infinity = ValueRange::infinity;

/// "ok", or the component and the value that are outside.
template <class T>
std::string judged(const T& element, const ValueRange& range, Storage storage = Storage::Single) {
  const auto found =
      outOfRange(ElementTraits<T>::element(), storage, range, reinterpret_cast<const std::byte*>(&element));
  return found ? found->component + "=" + found->value : "ok";
}

TEST_CASE("the ends belong to a range") {
  CHECK(judged(0.1f, {0, 0.1}) == "ok");
  CHECK(judged(0.1f, {0.1, 1}) == "ok");
  CHECK(judged(std::nextafter(0.1f, 1.0f), {0, 0.1}) == "=0.10000001");
  CHECK(judged(std::nextafter(0.1f, 0.0f), {0.1, 1}) == "=0.099999994");
  CHECK(judged(-0.0f, {0, 1}) == "ok");
  CHECK(judged(0.1, {0, 0.1}) == "ok");
  CHECK(judged(0.1 + 1e-16, {0, 0.1}) == "=0.1000000000000001");
  CHECK(judged(half(0.1f), {0.1, 0.1}) == "ok");
  CHECK(judged(half(0.2f), {0, 0.1}) == "=0.19995117");
  CHECK(judged(unorm8(1.0f), {0, 0.5}) == "=1");
  CHECK(judged(unorm8(0.5f), {0, 0.5}) == "ok");
}

TEST_CASE("NaN is in no range, and infinity in some") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  CHECK(judged(nan, {-infinity, infinity}) == "=nan");
  CHECK(judged(inf, {-infinity, infinity}) == "ok");
  CHECK(judged(inf, {0, 1e300}) == "ok");  // 1e300 is infinite as a float
  CHECK(judged(inf, {0, 1e30}) == "=inf");
}

TEST_CASE("integers of all widths are compared exactly") {
  CHECK(judged(std::int32_t{-11}, {-10, 10}) == "=-11");
  CHECK(judged(std::uint32_t{4294967295u}, {0, 4294967295.0}) == "ok");
  CHECK(judged(std::uint32_t{4294967295u}, {0, 4294967294.0}) == "=4294967295");
  CHECK(judged(std::int64_t{9007199254740993}, {0, 9007199254740992.0}) == "=9007199254740993");
  CHECK(judged(std::numeric_limits<std::int64_t>::max(), {0, infinity}) == "ok");
  CHECK(judged(std::numeric_limits<std::int64_t>::min(), {-infinity, 0}) == "ok");
  CHECK(judged(std::uint8_t{200}, {0, 199}) == "=200");
  CHECK(judged(std::int8_t{-128}, {-127, 127}) == "=-128");
}

TEST_CASE("components are named") {
  CHECK(judged(float3{0, 2, 5}, {0, 1}) == ".y=2");
  CHECK(judged(double4{0, 1, 0, -1}, {0, 1}) == ".w=-1");
  CHECK(judged(int2{1, 0}, {0, 1}) == "ok");
}

TEST_CASE("storage rounds the ends, too") {
  CHECK(judged(static_cast<float>(half(0.1f)), {0.1, 1}) == "=0.099975586");
  CHECK(judged(static_cast<float>(half(0.1f)), {0.1, 1}, Storage::Half) == "ok");
  const double third = 1.0 / 3, pair = static_cast<double>(1.0f / 3) +
                                       static_cast<float>(third - static_cast<double>(1.0f / 3));
  const auto ofReal = [](double real, Storage storage) {
    return outOfRange(ElementTraits<float>::element(), storage, {0, 1.0 / 3}, &real).has_value();
  };
  CHECK_FALSE(ofReal(third, Storage::Double));
  CHECK_FALSE(ofReal(pair, Storage::Extended));
  CHECK(ofReal(third + 1e-9, Storage::Extended));
  CHECK(ofReal(std::nextafter(third, 1.0), Storage::Double));
}

}  // namespace
}  // namespace sk
