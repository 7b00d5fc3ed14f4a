// SPDX-License-Identifier: MIT
#include "patterns.hpp"

#include <array>

#include "support/named.hpp"

namespace examples {
namespace {

// Classes after Pearson's figure 3 and, from nu on, R. Munafo's extension of it ("Pearson's classification
// (extended)", mrob.com/pub/comp/xmorphia); the points are among those that Munafo shows for each class.
constexpr std::array<Pattern, 13> table = {{
    {"alpha", 0.010, 0.047, "wavelets and short spirals that run into each other and vanish"},
    {"beta", 0.026, 0.051, "a restless sea where holes open and close"},
    {"gamma", 0.022, 0.051, "worms that branch and break, never at rest"},
    {"delta", 0.030, 0.055, "holes in a hexagonal lattice: Turing's pattern"},
    {"epsilon", 0.018, 0.055, "rings and cells that divide and die of crowding"},
    {"zeta", 0.026, 0.059, "cells that divide, with slow waves of death"},
    {"eta", 0.034, 0.063, "short worms among spots"},
    {"theta", 0.030, 0.057, "labyrinths that grow as rings"},
    {"iota", 0.046, 0.0594, "lone holes that keep their distance"},
    {"kappa", 0.050, 0.063, "corals and hedgerow mazes"},
    {"lambda", 0.034, 0.065, "cells that divide until a lattice is full"},
    {"mu", 0.046, 0.065, "worms that grow from both ends and lie down in parallel"},
    {"pi", 0.062, 0.0609, "the U-skate world: soliton-like bodies that travel"},
}};

}  // namespace

const Pattern& findPattern(std::string_view name) { return rowNamed(table, name, "pattern"); }

}  // namespace examples
