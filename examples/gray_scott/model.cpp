// SPDX-License-Identifier: MIT
#include "model.hpp"

#include <array>
#include <random>

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

std::span<const Pattern> patterns() { return table; }

const Pattern& findPattern(std::string_view name) { return rowNamed(table, name, "pattern"); }

double largestTimeStep(const Parameters& p) { return 2.0 / (8.0 * p.spreadU + p.feed); }

std::vector<sk::float2> firstState(int size, int seeds, std::uint32_t randomSeed) {
  constexpr int side = 20;
  std::mt19937 random(randomSeed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint32_t>(n)); };
  const auto disturbed = [&](double value) {
    return static_cast<float>(value * (1.0 + 0.01 * (2.0 * (random() / 4294967296.0) - 1.0)));
  };
  std::vector<sk::float2> state(static_cast<std::size_t>(size) * static_cast<std::size_t>(size),
                                {1.0f, 0.0f});
  for (int seed = 0; seed < seeds; ++seed) {
    const int left = seeds == 1 ? size / 2 - side / 2 + size : below(size);
    const int top = seeds == 1 ? left : below(size);
    for (int y = top; y < top + side; ++y) {
      for (int x = left; x < left + side; ++x) {
        const auto place = static_cast<std::size_t>(y % size) * static_cast<std::size_t>(size);
        state[place + static_cast<std::size_t>(x % size)] = {disturbed(0.5), disturbed(0.25)};
      }
    }
  }
  return state;
}

template <class Real>
HostField<Real>::HostField(int size, std::span<const sk::float2> state)
    : size_(size), nextU_(state.size()), nextV_(state.size()) {
  u_.reserve(state.size());
  v_.reserve(state.size());
  for (const sk::float2& c : state) {
    u_.push_back(c.x);
    v_.push_back(c.y);
  }
}

template <class Real>
void HostField<Real>::advance(const Parameters& p) {
  const Real feed = p.feed, kill = p.kill, spreadU = p.spreadU, spreadV = p.spreadV, dt = p.dt;
  for (std::int64_t y = 0; y < size_; ++y) {
    const std::int64_t row = y * size_;
    const std::int64_t above = (y == 0 ? size_ - 1 : y - 1) * size_;
    const std::int64_t below = (y == size_ - 1 ? 0 : y + 1) * size_;
    const Real* u = u_.data();
    const Real* v = v_.data();
    Real* nextU = nextU_.data();
    Real* nextV = nextV_.data();
    const auto cell = [=](std::int64_t x, std::int64_t left, std::int64_t right) {
      const Real a = u[row + x], b = v[row + x];
      const Real lapU = u[row + left] + u[row + right] + u[above + x] + u[below + x] - 4 * a;
      const Real lapV = v[row + left] + v[row + right] + v[above + x] + v[below + x] - 4 * b;
      const Real reaction = a * b * b;
      nextU[row + x] = a + dt * (spreadU * lapU - reaction + feed * (1 - a));
      nextV[row + x] = b + dt * (spreadV * lapV + reaction - (feed + kill) * b);
    };
    cell(0, size_ - 1, size_ == 1 ? 0 : 1);
    for (std::int64_t x = 1; x < size_ - 1; ++x) cell(x, x - 1, x + 1);
    if (size_ > 1) cell(size_ - 1, size_ - 2, 0);
  }
  u_.swap(nextU_);
  v_.swap(nextV_);
}

template class HostField<float>;
template class HostField<double>;

}  // namespace examples
