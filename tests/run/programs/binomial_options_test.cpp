// SPDX-License-Identifier: MIT
//
// binomial_options.sk against the same lattice in double, whose factors and weights are not rounded to float.
//
// A node's price is a product of at most 2 n factors: n times `up` or `down`, with 2 roundings each (the factor's and the
// product's), and n times `ratio`, with 4 each. Each step back adds 3 roundings: of a weight, of the product and of the sum. All
// terms are positive, and under the weights' measure the discounted price is a martingale: the error is below that of
// (spot + strike) after 9 n + 1 roundings; the last one rounds the difference of spot and strike.
#include "programs/binomial_options.sk.hpp"

#include "programs/bounds.hpp"
#include "support/devices.hpp"

using namespace run_tests;
using binomial_options::Lattice;
using binomial_options::Option;

namespace {

struct Market {
  double rate, volatility, years;
  int steps;
};

struct Factors {
  double up, down, weightUp, weightDown;
};

/// Cox, Ross and Rubinstein (1979), section 5.
Factors factors(const Market& m) {
  const double dt = m.years / m.steps;
  const double up = std::exp(m.volatility * std::sqrt(dt)), down = 1 / up;
  const double p = (std::exp(m.rate * dt) - down) / (up - down), discount = std::exp(-m.rate * dt);
  return {up, down, discount * p, discount * (1 - p)};
}

Lattice lattice(const Market& m) {
  const Factors f = factors(m);
  return {static_cast<float>(f.up), static_cast<float>(f.down), static_cast<float>(f.weightUp),
          static_cast<float>(f.weightDown), m.steps};
}

double priced(const Market& m, const Option& o) {
  const Factors f = factors(m);
  const auto exercised = [&](int step, int ups) {
    const double spot = o.spot * std::pow(f.up, 2 * ups - step);
    return std::max(o.isCall ? spot - o.strike : o.strike - spot, 0.0);
  };
  std::vector<double> worth;
  for (int i = 0; i <= m.steps; ++i) worth.push_back(exercised(m.steps, i));
  for (int step = m.steps - 1; step >= 0; --step) {
    for (int i = 0; i <= step; ++i) {
      const auto at = static_cast<std::size_t>(i);
      worth[at] = f.weightDown * worth[at] + f.weightUp * worth[at + 1];
      if (o.isAmerican) worth[at] = std::max(worth[at], exercised(step, i));
    }
  }
  return worth[0];
}

std::vector<Option> options(std::int64_t count) {
  std::vector<Option> result;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    result.push_back({50 + 40 * noise(i, 1), 50 + 40 * noise(i, 2), i % 2 == 0, i / 2 % 2 == 0});
  }
  return result;
}

}  // namespace

TEST_CASE("binomial options: calls and puts, European and American") {
  onDrawnLayouts([](sk::Device& device) {
    for (const auto& [count, steps] : {std::pair{0, 4}, {1, 1}, {67, 16}, {101, 128}}) {
      INFO(count << " options, " << steps << " steps");
      const Market market{0.06, 0.3, 0.75, steps};
      const auto given = options(count);
      auto worth = device.stream<float>({count});
      binomial_options::price(lattice(market), streamOf<Option>(device, given), worth);
      CHECK(outside(worth.read(), [&](std::size_t i) {
              const double error = roundings(9 * steps + 1) * (given[i].spot + given[i].strike);
              return Bounded{priced(market, given[i]), error};
            }) == "");
    }
  });
}

TEST_CASE("binomial options: a table of spots and strikes") {
  onGlAndNative([](sk::Device& device) {
    const Market market{0.03, 0.2, 1, 32};
    const auto given = options(7 * 13);
    auto worth = device.stream<float>({7, 13});
    binomial_options::price(lattice(market), streamOf<Option>(device, {7, 13}, given), worth);
    CHECK(outside(worth.read(), [&](std::size_t i) {
            return Bounded{priced(market, given[i]),
                           roundings(9 * 32 + 1) * (given[i].spot + given[i].strike)};
          }) == "");
  });
}

// J. C. Hull, "Options, futures, and other derivatives": spot and strike 50, 10% interest, 40% volatility, five months, five
// steps of one month. The book gives 4.49.
TEST_CASE("binomial options: a textbook's American put") {
  onGlAndNative([](sk::Device& device) {
    const Market market{0.1, 0.4, 5.0 / 12, 5};
    auto worth = device.stream<float>({1});
    binomial_options::price(lattice(market), streamOf<Option>(device, {{50, 50, false, true}}), worth);
    CHECK(std::fabs(worth.read()[0] - 4.49) < 0.005);
  });
}
