// SPDX-License-Identifier: MIT
//
// Two precisions from one first state: how fast they part, and what they agree on when they have parted.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lattice.hpp"
#include "limits.hpp"
#include "patterns.hpp"
#include "run.hpp"
#include "statistics.hpp"
#include "study.hpp"

namespace examples {
namespace {

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

struct Line {
  double slope = 0.0;
  double straight = 0.0;  ///< the square of the correlation: 1 for a straight line
};

/// Through ln(y) over x, from where y is first above `low` until it is above `high`; none of fewer than three points.
Line logarithmicLine(const std::vector<double>& x, const std::vector<double>& y, double low, double high) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(y[i] >= low)) continue;
    if (y[i] > high) break;
    const double l = std::log(y[i]);
    n += 1, sx += x[i], sy += l, sxx += x[i] * x[i], sxy += x[i] * l, syy += l * l;
  }
  if (n < 3) return {};
  const double covariance = n * sxy - sx * sy, varianceX = n * sxx - sx * sx, varianceY = n * syy - sy * sy;
  return {covariance / varianceX, covariance * covariance / (varianceX * varianceY)};
}

struct Sums {
  double mean = 0, wavelength = 0, nusselt = 0;
  int count = 0;
};

struct Pair {
  Lattice single, exact;
  Field shown;
  Sums sumsOfSingle, sumsOfExact;

  Pair(sk::Device& device, Model model, const Initial& initial, Field field)
      : single(device, model), exact(device, (model.precision = sk::Precision::Double, model)), shown(field) {
    writeInitial(model, initial, single);
    writeInitial(model, initial, exact);
    // Both from the floats.
    for (const Field f : fieldsOf(model)) exact.write(f, single.read(f));
  }
  void advance(std::int64_t steps) {
    single.advance(steps);
    exact.advance(steps);
  }
  double apart() { return rms(single.read(shown), exact.read(shown)); }
  void gather() {
    const auto add = [&](Lattice& lattice, Sums& sums) {
      const std::vector<double> values = lattice.read(shown);
      const Grid& g = lattice.model().grid;
      sums.mean += lattice.observe(shown).mean;
      sums.wavelength += wavelengthOf({g.width, g.height, values});
      if (lattice.model().flow) sums.nusselt += lattice.nusselt();
      ++sums.count;
    };
    add(single, sumsOfSingle);
    add(exact, sumsOfExact);
  }
  Kind kind(Lattice& lattice) {
    const std::vector<double> values = lattice.read(shown);
    return kindOf({lattice.model().grid.width, lattice.model().grid.height, values});
  }
};

struct Course {
  const char* name;
  Pair& pair;
  std::int64_t steps, every;  ///< in all, and from one look to the next
  std::int64_t from;  ///< statistics are gathered from here on
  double unit;  ///< of time, a step
};

void follow(const Course& c, Table& table, Verification& verification) {
  std::vector<double> times, apart;
  for (std::int64_t step = 0; step < c.steps;) {
    c.pair.advance(c.every);
    step += c.every;
    times.push_back(static_cast<double>(step) * c.unit);
    apart.push_back(c.pair.apart());
    if (step >= c.from && step % (8 * c.every) == 0) c.pair.gather();
  }
  const Line line = logarithmicLine(times, apart, 1e-6, 1e-2);
  const auto at = [&](double part) {
    return apart[static_cast<std::size_t>(part * static_cast<double>(apart.size() - 1))];
  };
  const auto row = [&](const char* precision, Sums& s, Lattice& lattice) {
    const double n = std::max(s.count, 1);
    table.add({c.name, precision, fmt::format("{:.1e}, {:.1e}, {:.1e}", at(0.1), at(0.4), at(1.0)),
               line.slope > 0 ? fmt::format("{:.3g} ({:.3f})", line.slope, line.straight) : "none",
               fmt::format("{:.5f}", s.mean / n), fmt::format("{:.1f}", s.wavelength / n),
               lattice.model().flow ? fmt::format("{:.2f}", s.nusselt / n) : "-",
               lattice.model().reaction ? std::string(nameOf(c.pair.kind(lattice))) : "-"});
  };
  row("single", c.pair.sumsOfSingle, c.pair.single);
  row("double", c.pair.sumsOfExact, c.pair.exact);
  const auto& a = c.pair.sumsOfSingle;
  const auto& b = c.pair.sumsOfExact;
  verification.compare(0, a.mean / b.mean, 1.0);
  verification.compare(1, a.wavelength / b.wavelength, 1.0);
  if (c.pair.single.model().flow) verification.compare(2, a.nusselt / b.nusselt, 1.0);
}

}  // namespace

Findings studyGrowth(sk::Device& device, bool small) {
  Table table({"scene", "precision", "apart after 10 %, 40 % and all of the run (rms)",
               "rate of growth (r^2)", "mean", "wavelength, cells", "Nusselt number", "kind"});
  Verification verification("statistics in single against double, relative", small ? 0.2 : 0.1,
                            "what averages over so few wavelengths and times vary by");
  for (const char* name : {"epsilon", "mu"}) {
    const Pattern& pattern = findPattern(name);
    Model m;
    const std::int64_t n = small ? 96 : 192;
    m.grid = {n, n};
    m.reaction = Reaction{pattern.feed, pattern.kill};
    Initial initial;
    initial.seeds = static_cast<int>(n * n / 2500);
    Pair pair(device, m, initial, Field::V);
    const std::int64_t steps = small ? 4000 : 32'000;
    follow({name, pair, steps, 100, steps / 2, 1.0}, table, verification);
    if (small) break;
  }
  if (!small) {
    Model m;
    m.grid = {256, 64};
    m.boundary.edges = {Edge::Wrap, Edge::Wrap, Edge::Wall, Edge::Wall};
    m.boundary.temperatures = {0.0, 0.0, 1.0, 0.0};
    setConvection(m, 1e6, 0.71, 3.0, false);
    for (const Limit& limit : limitsOf(m)) m.timeStep = std::min(m.timeStep, 0.8 * limit.largest);
    Initial initial;
    initial.profile = Profile::Conduction;
    initial.noise = 0.01;
    Pair pair(device, m, initial, Field::Temperature);
    follow({"convection, Ra = 10^6", pair, 60'000, 200, 20'000, m.timeStep}, table, verification);
  }
  return {table.markdown(), {verification}};
}

}  // namespace examples
