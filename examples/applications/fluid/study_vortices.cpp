// SPDX-License-Identifier: MIT
//
// Taylor and Green's vortices: convergence in space and time, and what becomes of the energy.
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "study.hpp"
#include "support/table.hpp"
#include "vortices.hpp"

namespace fluid {

namespace {

constexpr std::array<std::string_view, 4> schemeTitles = {"semi-Lagrangian", "MacCormack", "BFECC",
                                                          "central differences"};

Flow run(sk::Device& device, const Vortices& vortices, Model model, double time, int steps) {
  model.timeStep = time / steps;
  Flow flow = vortexFlow(device, vortices, model);
  for (int i = 0; i < steps; ++i) flow.step();
  return flow;
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace

Findings studyTaylorGreen(sk::Device& device, bool small) {
  const Vortices vortices;
  const std::vector<std::int64_t> sizes =
      small ? std::vector<std::int64_t>{16, 32} : std::vector<std::int64_t>{16, 32, 64, 128};
  examples::Table table({"convection", "cells", "steps", "error", "order"});
  examples::Verification reached(
      "order of central differences, below 2", 0.2,
      "both space and time are of second order; coarse grids are not yet asymptotic");
  examples::Verification corrected("errors of MacCormack and BFECC, as a part of the semi-Lagrangian one",
                                   0.65, "what is left after the correction is the splitting's error");
  std::map<std::int64_t, double> uncorrected;
  for (const Scheme scheme : {Scheme::SemiLagrangian, Scheme::MacCormack, Scheme::Bfecc, Scheme::Central}) {
    double before = 0.0;
    for (const std::int64_t n : sizes) {
      // The largest speed is 2: n / 4 steps in a time of 1 are a CFL number of 1.3; central differences take half of that.
      const int steps = static_cast<int>(scheme == Scheme::Central ? n / 2 : n / 4);
      const Flow flow =
          run(device, vortices, vortexModel(vortices, n, scheme, sk::Precision::Double), 1.0, steps);
      const double error = errorOf(vortices, flow);
      if (scheme == Scheme::SemiLagrangian) uncorrected[n] = error;
      if (scheme == Scheme::MacCormack || scheme == Scheme::Bfecc) corrected.note(n, error / uncorrected[n]);
      const bool isFirst = before == 0.0;
      table.add({std::string(schemeTitles[static_cast<std::size_t>(scheme)]), fmt::format("{0} x {0}", n),
                 fmt::format("{}", steps), fmt::format("{:.2e}", error),
                 isFirst ? "" : fmt::format("{:.2f}", order(before, error))});
      if (!isFirst && scheme == Scheme::Central) reached.note(n, std::max(0.0, 2.0 - order(before, error)));
      before = error;
    }
  }
  return {table.markdown(), {reached, corrected}};
}

Findings studyTime(sk::Device& device, bool small) {
  const Vortices vortices;
  const std::int64_t n = small ? 16 : 32;
  const Model model = vortexModel(vortices, n, Scheme::Central, sk::Precision::Double);
  const int finest = small ? 128 : 1024;
  const Flow exact = run(device, vortices, model, 1.0, finest);
  examples::Table table({"steps", "time step", "CFL number", "difference", "order"});
  examples::Verification reached("order in time, below 2", 0.2,
                                 "Heun's method; the finest step is taken for the limit");
  double before = 0.0;
  for (int steps = small ? 8 : 16; steps <= finest / 8; steps *= 2) {
    const Flow flow = run(device, vortices, model, 1.0, steps);
    double squares = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
      const std::vector<double> a = flow.velocity(axis), b = exact.velocity(axis);
      for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
    }
    const double difference = std::sqrt(squares / static_cast<double>(2 * n * n));
    table.add({fmt::format("{}", steps), fmt::format("{:.4g}", 1.0 / steps),
               fmt::format("{:.2f}", 2.0 / steps / model.spacing), fmt::format("{:.2e}", difference),
               before == 0.0 ? "" : fmt::format("{:.2f}", order(before, difference))});
    if (before != 0.0) reached.note(steps, std::max(0.0, 2.0 - order(before, difference)));
    before = difference;
  }
  return {table.markdown(), {reached}};
}

Findings studyEnergy(sk::Device& device, bool small) {
  Vortices vortices;
  vortices.viscosity = 0.0;
  const std::int64_t n = small ? 16 : 64;
  examples::Table table({"convection", "steps", "CFL number", "energy after a time of 1, change"});
  std::vector<examples::Verification> verifications;
  for (const Scheme scheme : {Scheme::SemiLagrangian, Scheme::MacCormack, Scheme::Bfecc, Scheme::Central}) {
    for (const int times : {1, 2, 4}) {
      const int steps = static_cast<int>(n) / 4 * times;
      const Model model = vortexModel(vortices, n, scheme, sk::Precision::Double);
      Flow begun = vortexFlow(device, vortices, model);
      const double before = begun.kineticEnergy();
      const double after = run(device, vortices, model, 1.0, steps).kineticEnergy();
      const double change = (after - before) / before;
      const double cfl = 2.0 / steps / model.spacing;
      table.add({std::string(schemeTitles[static_cast<std::size_t>(scheme)]), fmt::format("{}", steps),
                 fmt::format("{:.2f}", cfl), fmt::format("{:+.1e}", change)});
      if (scheme != Scheme::Central) continue;
      // Heun's method multiplies the energy of a wave of frequency f by 1 + (f dt)^4 / 4. The winds carry the vortices, whose wave number is 1 along both axes,
      // with f = 1.5, and they are 2 parts in 7 of the energy.
      const double angle = 1.5 / steps;
      examples::Verification v(
          fmt::format("energy after {} steps of central differences, change", steps),
          2.0 / 7.0 * steps * std::pow(angle, 4) / 4.0 + 1e-7,
          "space adds none; Heun's method adds (f dt)^4 / 4 a step, and the projection its tolerance");
      v.note(steps, std::abs(change));
      verifications.push_back(v);
    }
  }
  return {table.markdown(), verifications};
}

}  // namespace fluid
