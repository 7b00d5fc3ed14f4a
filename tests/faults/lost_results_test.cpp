// SPDX-License-Identifier: MIT
//
// Faults while a call writes streams whose elements are lost already: they stay lost, or have what the call gives.
#include <optional>
#include <vector>

#include <catch2/catch.hpp>

#include "faults.hpp"
#include "faults.sk.hpp"
#include "sk/sk.hpp"

using namespace faults;
using ErrorKind = sk::Error::Kind;

namespace {

constexpr std::int64_t rows = 9, columns = 8;

/// Makes the elements of a stream be lost.
void lose(sk::Device& device, sk::Stream<float>& stream) {
  {
    const Fault fault(Kind::Command, 1, true);
    try {
      stream.fill(1);
      device.finish();
    } catch (const sk::Error&) {
    }
  }
  try {
    stream.read();
    FAIL("the stream is not lost");
  } catch (const sk::Error& error) {
    REQUIRE(error.kind() == ErrorKind::Lost);
  }
}

std::optional<std::vector<float>> elementsOf(const sk::Stream<float>& stream) {
  try {
    return stream.read();
  } catch (const sk::Error& error) {
    CHECK(error.kind() == ErrorKind::Lost);
    return std::nullopt;
  }
}

}  // namespace

TEST_CASE("a lost result of an exact reduce stays lost if its sums cannot be stored", "[gl][lost]") {
  sk::Device device({.device = "gl", .profile = "glsl330"});
  auto x = device.stream<float>({rows, columns}), r = device.stream<float>({rows, 1});
  x.fill(1.5F);
  const auto reduce = [&] { faulty::sum.with({.accumulate = sk::Accumulate::Exact})(x, r); };
  const std::vector<float> right(rows, 12);
  reduce();
  REQUIRE(r.read() == right);
  for (const Kind kind : {Kind::Host, Kind::Command}) {
    int failures = 0;
    bool hasFired = true;
    for (long number = 1; hasFired; ++number) {
      INFO(nameOf(kind) << " " << number);
      REQUIRE(number < 2000);
      lose(device, r);
      bool hasThrown = false;
      {
        const Fault fault(kind, number);
        try {
          reduce();
          device.finish();
        } catch (const sk::Error& error) {
          CHECK(error.kind() == ErrorKind::Memory);
          hasThrown = true;
        }
        hasFired = fault.hasFired();
      }
      failures += hasThrown ? 1 : 0;
      const std::optional<std::vector<float>> found = elementsOf(r);
      CHECK((found ? found == right : hasThrown));
    }
    CHECK(failures > 0);
  }
}
