// SPDX-License-Identifier: MIT
//
// Promises: names stay where they can, and no two names of a scope are equal.
#include "support/namer.hpp"

#include <catch2/catch.hpp>

namespace skc {
namespace {

TEST_CASE("a name stays unless it is reserved or given") {
  Namer names([](std::string_view name) { return name == "for" || name == "for_"; });
  names.reserve("Hit");
  CHECK(names.take("x") == "x");
  CHECK(names.take("x") == "x_2");
  CHECK(names.take("x_2") == "x_2_2");
  CHECK(names.take("x_") == "x_");
  CHECK(names.take("x_") == "x_3");
  CHECK(names.take("for") == "for__");
  CHECK(names.take("for") == "for__2");
  CHECK(names.take("Hit") == "Hit_");
}

}  // namespace
}  // namespace skc
