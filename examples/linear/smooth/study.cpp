// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <array>

namespace smooth {

namespace {

constexpr std::array<Study, 2> all = {{
    {"sphere", "the radius of a sphere that shrinks, against sqrt(r^2 - 4 t), and the order of convergence",
     studySphere},
    {"layouts", "iterations, residual and time of a step with each layout of the matrix", studyLayouts},
}};

}  // namespace

std::span<const Study> studies() { return all; }

}  // namespace smooth
