// SPDX-License-Identifier: MIT
//
// Extents on a command line: what is read, and what each mistake says.
#include "support/options.hpp"

#include <string>

#include <catch2/catch.hpp>

namespace {

using namespace examples;
using Extents = std::vector<std::int64_t>;

}  // namespace

TEST_CASE("extents are numbers with an x between them") {
  CHECK(extentsOf("--size", "64x48", {2, 100}) == Extents{64, 48});
  CHECK(extentsOf("--size", "2x100x7", {2, 100, 3}) == Extents{2, 100, 7});
  CHECK(extentsOf("--size", "0x0", {0, 9}) == Extents{0, 0});
}

TEST_CASE("a text that is no size is refused with what to write") {
  const std::string plane = " is no size; write WxH, each from 2 to 100";
  for (const std::string text : {"", "x", "64", "64x", "x64", "64x4x4", "1x64", "64x101", "64x-4", "+4x4",
                                 "4 x4", "4x4.5", "4X4", "000004x4", "99999999999999999999x4"})
    CHECK_THROWS_WITH(extentsOf("--size", text, {2, 100}), "--size: '" + text + "'" + plane);
  CHECK_THROWS_WITH(extentsOf("--size", "4x4x4x4", {2, 100, 3}),
                    "--size: '4x4x4x4' is no size; write WxH or WxHxD, each from 2 to 100");
}
