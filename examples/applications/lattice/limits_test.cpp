// SPDX-License-Identifier: MIT
#include "limits.hpp"

#include <catch2/catch.hpp>
#include <cmath>


namespace examples {
namespace {

TEST_CASE("diffusion is stable up to h^2 / 2D for each dimension") {
  CHECK(diffusionLimit(1.0, 1.0, 1) == 0.5);
  CHECK(diffusionLimit(1.0, 1.0, 2) == 0.25);
  CHECK(diffusionLimit(0.5, 2.0, 3) == Approx(4.0 / 3.0));
  CHECK(std::isinf(diffusionLimit(0.0, 1.0, 2)));
  CHECK(dimensionsOf({64, 1, 1}) == 1);
  CHECK(dimensionsOf({1, 1, 1}) == 0);
}

TEST_CASE("sound, friction and damping limit a flow together") {
  Flow flow{.sound = 2.0};
  CHECK(soundLimit(flow, 0.1) == Approx(0.1 / (2.0 * std::sqrt(2.0))));
  flow.viscosity = 0.01;
  const double dt = soundLimit(flow, 0.1);
  CHECK(2.0 * 4.0 * dt * dt + 4.0 * 0.01 * dt == Approx(0.01));
  flow.sound = 0.0;
  CHECK(soundLimit(flow, 0.1) == Approx(0.25));
}

TEST_CASE("a model has the limits of its operators, each with its step") {
  Model m;
  m.diffusion = Diffusion{0.1};
  m.reaction = Reaction{0.03, 0.06};
  m.timeStep = 3.0;
  const auto limits = limitsOf(m);
  REQUIRE(limits.size() == 2);
  CHECK_FALSE(limits[0].holds());
  CHECK(limits[1].of == "reaction");
  CHECK(limits[1].largest == Approx(2.0 / (8.0 * 2e-5 * 256 * 256 / 6.25 + 0.03)));
  CHECK(limits[1].holds());
}

TEST_CASE("convection begins where linear theory says") {
  CHECK(criticalBetweenRigidPlates(3.117) == Approx(1707.762).epsilon(1e-6));  // Chandrasekhar, table III
  CHECK(criticalBetweenRigidPlates(2.0) == Approx(2177.41).epsilon(1e-5));
  CHECK(criticalBetweenRigidPlates(5.0) == Approx(2439.32).epsilon(1e-5));
  CHECK(criticalBetweenFreePlates(2.2214) == Approx(657.511).epsilon(1e-6));
}

}  // namespace
}  // namespace examples
