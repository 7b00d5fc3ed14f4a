// SPDX-License-Identifier: MIT
#include "sk/options.hpp"

#include <catch2/catch.hpp>

#include "sk/call.hpp"

using namespace sk;

namespace {

struct Callable : WithOptions<Callable> {};

}  // namespace

TEST_CASE("choices add up, and the last one of a kind holds") {
  constexpr Callable first = Callable{}.with({.accumulate = Accumulate::Exact, .target = Target::Native});
  constexpr Callable both = first.with({.precision = Precision::Extended, .target = Target::Compute});
  STATIC_REQUIRE(both.options == CallOptions{.accumulate = Accumulate::Exact,
                                             .precision = Precision::Extended,
                                             .target = Target::Compute});
  STATIC_REQUIRE(both.with({}).options == both.options);
  constexpr CallOptions all{Accumulate::Tree, Precision::Half,   Intrinsics::Fast, Tables::Off,
                            Target::Fragment, Contraction::Fast, Order::Any};
  STATIC_REQUIRE(CallOptions{}.with(all) == all);
  STATIC_REQUIRE(all.with({}) == all);
  constexpr CallOptions boxed = all.with({.box = {{1, 2}, {3, 4}}});
  STATIC_REQUIRE(boxed.box == Box{{1, 2}, {3, 4}});
  STATIC_REQUIRE(boxed.with({.order = Order::Kept}).box == boxed.box);
  STATIC_REQUIRE(all.box.isWhole());
  constexpr Callable over = first.over({3, 4}).with({.order = Order::Any});
  STATIC_REQUIRE(over.options.over == GivenDomain{.shape = {3, 4}});
  STATIC_REQUIRE(over.options.accumulate == Accumulate::Exact);
  STATIC_REQUIRE(over.over({5}).options.over->shape == Shape{5});
  STATIC_REQUIRE(!all.over);
}
