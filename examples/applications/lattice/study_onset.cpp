// SPDX-License-Identifier: MIT
//
// Where convection begins on a lattice: a small wave shrinks below a Rayleigh number and grows above, and where its rate is 0
// neither the step of time nor the speed of sound matters.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "lattice.hpp"
#include "limits.hpp"
#include "run.hpp"
#include "study.hpp"

namespace examples {
namespace {

/// Precisions of the device, the best that it has.
sk::Precision bestOf(sk::Device& device) {
  return device.profile() == "essl300" ? sk::Precision::Single : sk::Precision::Double;
}

/// How fast the velocities grow, in units of the diffusion of heat over the height.
double growthRate(sk::Device& device, std::int64_t height, std::int64_t width, bool slip, double rayleigh) {
  Model m;
  m.grid = {width, height};
  m.boundary.edges = {Edge::Wrap, Edge::Wrap, Edge::Wall, Edge::Wall};
  m.boundary.temperatures = {0.0, 0.0, 1.0, 0.0};
  m.precision = bestOf(device);
  setConvection(m, rayleigh, 1.0, 1.0, slip);
  m.timeStep = 1.0;
  for (const Limit& limit : limitsOf(m)) m.timeStep = std::min(m.timeStep, 0.7 * limit.largest);
  Lattice lattice(device, m);
  Initial initial;
  initial.profile = Profile::Conduction;
  initial.noise = 1e-4;
  initial.rolls = 1.0;
  writeInitial(m, initial, lattice);
  // What the wave holds of other modes is gone after one time of diffusion.
  const double unit = std::sqrt(rayleigh);
  const auto steps = static_cast<std::int64_t>(unit / m.timeStep);
  lattice.advance(steps);
  const double before = lattice.kineticEnergy();
  lattice.advance(steps / 2);
  const double after = lattice.kineticEnergy();
  return 0.5 * std::log(after / before) / (static_cast<double>(steps / 2) * m.timeStep / unit);
}

struct Crossing {
  double below, above;  ///< Rayleigh numbers
  double rateBelow, rateAbove;
  double at() const { return below - rateBelow * (above - below) / (rateAbove - rateBelow); }
};

Crossing measure(sk::Device& device, std::int64_t height, std::int64_t width, bool slip, double below,
                 double above) {
  return {below, above, growthRate(device, height, width, slip, below),
          growthRate(device, height, width, slip, above)};
}

}  // namespace

Findings studyOnset(sk::Device& device, bool small) {
  Table table({"plates", "cells of the height", "k", "rate below", "rate above", "begins at Ra", "theory",
               "off by", "order"});
  std::vector<Verification> verifications;
  for (const bool slip : {false, true}) {
    const int widthOverHeight = slip ? 3 : 2;
    const double k = 2.0 * std::numbers::pi / widthOverHeight;
    const double theory = slip ? criticalBetweenFreePlates(k) : criticalBetweenRigidPlates(k);
    double last = 0.0, order = 0.0;
    double extrapolated = 0.0, previous = 0.0;
    for (std::int64_t height = 8; height <= (small ? 16 : 64); height *= 2) {
      const std::int64_t width = widthOverHeight * height;
      const double about = measure(device, height, width, slip, 0.97 * theory, 1.03 * theory).at();
      const Crossing c = measure(device, height, width, slip, 0.995 * about, 1.005 * about);
      const double error = c.at() / theory - 1.0;
      order = last != 0.0 ? std::log2(std::abs(last / error)) : 0.0;
      table.add({slip ? "free" : "rigid", fmt::format("{}", height), fmt::format("{:.4f}", k),
                 fmt::format("{:.4f} at {:.1f}", c.rateBelow, c.below),
                 fmt::format("+{:.4f} at {:.1f}", c.rateAbove, c.above), fmt::format("{:.2f}", c.at()),
                 fmt::format("{:.2f}", theory), fmt::format("{:+.3f} %", 100.0 * error),
                 last != 0.0 ? fmt::format("{:.2f}", order) : "-"});
      extrapolated = (4.0 * c.at() - previous) / 3.0;
      previous = c.at();
      last = error;
    }
    table.add({slip ? "free" : "rigid", "extrapolated", fmt::format("{:.4f}", k), "", "",
               fmt::format("{:.2f}", extrapolated), fmt::format("{:.2f}", theory),
               fmt::format("{:+.4f} %", 100.0 * (extrapolated / theory - 1.0)), ""});
    Verification off(fmt::format("onset between {} plates, extrapolated, relative", slip ? "free" : "rigid"),
                     small ? 5e-3 : 1e-4, "what second order leaves after one extrapolation");
    off.compare(0, extrapolated / theory, 1.0);
    Verification converges(fmt::format("order between {} plates", slip ? "free" : "rigid"), small ? 0.3 : 0.1,
                           "central differences have 2");
    converges.compare(0, order, 2.0);
    verifications.push_back(off);
    verifications.push_back(converges);
  }
  return {table.markdown(), verifications};
}

Findings studyCavity(sk::Device& device, bool small) {
  struct Case {
    double rayleigh, known;
  };
  // G. de Vahl Davis, "Natural convection of air in a square cavity: a bench mark numerical solution", Int. J. Numerical
  // Methods in Fluids 3 (1983); he gives an error below 0.1 % for the smallest, and below 1 % for 10^6.
  constexpr Case known[] = {{1e3, 1.118}, {1e4, 2.243}, {1e5, 4.519}, {1e6, 8.800}};
  Table table({"Ra", "cells", "steps", "Nusselt number", "extrapolated", "de Vahl Davis", "off by"});
  Verification verification("Nusselt numbers, extrapolated, against de Vahl Davis, relative",
                            small ? 2e-2 : 1e-2, "1 % is what he gives for the largest");
  for (const Case& c : known) {
    if (small && c.rayleigh > 1e4) break;
    double last = 0.0;
    for (std::int64_t n = small              ? 16
                          : c.rayleigh > 2e5 ? 48
                                             : 24;
         n <= (small              ? 32
               : c.rayleigh > 2e5 ? 96
                                  : 48);
         n *= 2) {
      Model m;
      m.grid = {n, n};
      m.boundary.edges = {Edge::Wall, Edge::Wall, Edge::Insulated, Edge::Insulated};
      m.boundary.temperatures = {1.0, 0.0, 0.0, 0.0};
      m.precision = bestOf(device);
      setConvection(m, c.rayleigh, 0.71, 2.0, false);
      m.timeStep = 1.0;
      for (const Limit& limit : limitsOf(m)) m.timeStep = std::min(m.timeStep, 0.8 * limit.largest);
      Lattice lattice(device, m);
      Initial initial;
      initial.profile = Profile::Conduction;
      writeInitial(m, initial, lattice);
      std::int64_t steps = 0;
      double change = 1.0;
      while (change > 1e-8 && steps < 400'000) {
        lattice.advance(255);
        change = lattice.advanceAndMeasure() / m.timeStep;
        steps += 256;
      }
      const double nusselt = lattice.nusselt();
      const double extrapolated = last > 0.0 ? (4.0 * nusselt - last) / 3.0 : 0.0;
      table.add({fmt::format("{:g}", c.rayleigh), fmt::format("{0} x {0}", n), fmt::format("{}", steps),
                 fmt::format("{:.4f}", nusselt), last > 0.0 ? fmt::format("{:.4f}", extrapolated) : "-",
                 fmt::format("{:.3f}", c.known),
                 fmt::format("{:+.2f} %", 100.0 * ((last > 0.0 ? extrapolated : nusselt) / c.known - 1.0))});
      if (last > 0.0) verification.compare(0, extrapolated / c.known, 1.0);
      last = nusselt;
    }
  }
  return {table.markdown(), {verification}};
}

}  // namespace examples
