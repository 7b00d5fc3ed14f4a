// SPDX-License-Identifier: MIT
//
// Promises: no size overflows, and exhausted host memory is an sk::Error that reports the requested size.
#include "support/checked_size.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"

using namespace sk;
using Catch::Matchers::Contains;

namespace {

constexpr std::int64_t largest = std::numeric_limits<std::int64_t>::max();

std::string errorOf(auto&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("products of sizes do not overflow") {
  CHECK(checkedProduct(3, 5) == 15);
  CHECK(checkedProduct(0, largest) == 0);
  CHECK(checkedProduct(largest, 0) == 0);
  CHECK(checkedProduct(largest, 1) == largest);
  CHECK(checkedProduct(largest / 7, 7) == largest - largest % 7);
  CHECK_FALSE(checkedProduct(largest / 7 + 1, 7).has_value());
  CHECK_FALSE(checkedProduct(std::int64_t{1} << 62, 4).has_value());
  CHECK(bytesOf(12, 4) == 48);
  CHECK_THROWS_AS(bytesOf(std::int64_t{1} << 62, 4), NoMemory);
}

TEST_CASE("streams of more bytes than there are addresses are refused") {
  Device native = Device::native();
  Device reference = Device::reference();
  for (Device* device : {&native, &reference}) {
    for (const Shape& shape :
         {Shape(std::int64_t{1} << 62), Shape(std::int64_t{1} << 61, 2), Shape(largest)}) {
      CHECK_THAT(errorOf([&] { device->stream<float>(shape); }),
                 Contains("too large") && Contains(toString(shape)));
      CHECK_THAT(errorOf([&] { device->stream<std::int8_t>(shape); }),
                 Contains("too large") || Contains("an extent above"));
    }
    // small enough that no size overflows, but more than any machine has
    CHECK_THAT(errorOf([&] { device->stream<float>({1 << 28, 1 << 28}); }),
               Contains("no memory") && Contains(" bytes"));
    CHECK_THAT(errorOf([&] { device->stream<float>({mostExtent + 1}); }),
               Contains("an extent above 1073741823"));
  }
}

TEST_CASE("want of memory for what a call returns says how much it was") {
  CHECK_THAT(errorOf([] { detail::hostVector<double>(std::size_t{1} << 60); }),
             Contains("1152921504606846976 element(s) of 8 byte(s)"));
  CHECK_THAT(errorOf([] { withHostMemory("blur", [] { throw NoMemory(4096); }); }),
             Contains("blur") && Contains("4096 bytes"));
  CHECK_THAT(errorOf([] { withHostMemory("blur", [] { throw std::bad_alloc(); }); }),
             Contains("blur") && Contains("host memory"));
  CHECK(withHostMemory("blur", [] { return 7; }) == 7);
  const auto failing = [](const char* text, Error::Kind kind) {
    return [=] { withHostMemory("blur", [&] { throw Error(text, kind); }); };
  };
  CHECK(errorOf(failing("no memory", Error::Kind::Memory)) == "blur: no memory");
  CHECK(errorOf(failing("blur: no memory", Error::Kind::Memory)) == "blur: no memory");
  CHECK(errorOf(failing("blurred: no memory", Error::Kind::Memory)) == "blur: blurred: no memory");
  CHECK(errorOf(failing("no shape", Error::Kind::Shape)) == "no shape");
  std::vector<std::byte> bytes;
  CHECK_THAT(errorOf([&] { withHostMemory("blur", [&] { resizeChecked(bytes, std::size_t{1} << 60); }); }),
             Contains("blur: there is no host memory for 1152921504606846976 bytes"));
  CHECK(bytesText(12) == "12 bytes");
  CHECK(bytesText(48 << 10) == "48 KiB");
  CHECK(bytesText(std::int64_t{3} << 30) == "3072 MiB");
}
