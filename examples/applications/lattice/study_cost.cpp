// SPDX-License-Identifier: MIT
//
// What asking costs, and what looking up saves: ratios of times, in turns on the same device.
#include <vector>

#include <fmt/format.h>

#include "lattice.hpp"
#include "limits.hpp"
#include "run.hpp"
#include "study.hpp"
#include "support/stopwatch.hpp"

namespace examples {
namespace {

/// The median of the ratios of times to others that were measured in turns with them.
double medianRatio(const std::vector<double>& times, const std::vector<double>& others) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < times.size(); ++i) ratios.push_back(times[i] / others[i]);
  return median(ratios);
}

Model boiling(std::int64_t width, std::int64_t height, Density density) {
  Model m;
  m.grid = {width, height};
  m.boundary.edges = {Edge::Wrap, Edge::Wrap, Edge::Wall, Edge::Wall};
  m.boundary.temperatures = {0.0, 0.0, 11.0, 9.9};
  m.boilingPoint = 10.0;
  m.diffusion = Diffusion{0.125};
  m.buoyancy = Buoyancy{0.015, 30.0, density};
  m.latentHeat = LatentHeat{0.1};
  return m;
}

Initial lukewarm() {
  Initial initial;
  initial.temperature = 9.9;
  initial.noise = 0.05;
  return initial;
}

}  // namespace

Findings studyStopping(sk::Device& device, bool small) {
  const std::int64_t n = small ? 64 : 512;
  const int steps = small ? 64 : 256, rounds = small ? 3 : 9;
  Model m;
  m.grid = {n, n};
  m.diffusion = Diffusion{0.2};
  const std::vector<int> everies = {1, 2, 8, 32, 128};
  std::vector<Lattice> lattices;
  for (std::size_t i = 0; i <= everies.size(); ++i) lattices.emplace_back(device, m);
  std::vector<std::vector<double>> times(lattices.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t i = 0; i < lattices.size(); ++i) {
      const double milliseconds = millisecondsOf(device, [&] {
        for (int step = 0; step < steps;) {
          const int every = i == 0 ? steps : everies[i - 1];
          lattices[i].advance(i == 0 ? every : every - 1);
          if (i > 0) lattices[i].advanceAndMeasure();
          step += every;
        }
      });
      if (round > 0) times[i].push_back(milliseconds);
    }
  }
  Table table({"asked", "time over never asking"});
  for (std::size_t i = 1; i < lattices.size(); ++i) {
    table.add({everies[i - 1] == 1 ? "every step" : fmt::format("every {} steps", everies[i - 1]),
               fmt::format("{:.2f}", medianRatio(times[i], times[0]))});
  }
  return {table.markdown(), {}};
}

Findings studyTables(sk::Device& device, bool small) {
  const int steps = small ? 10 : 40, rounds = small ? 3 : 9;
  struct Way {
    const char* name;
    Density density;
  };
  constexpr Way ways[] = {{"computed", Density::Computed},
                          {"linear, 512 intervals", Density::Linear},
                          {"cubic, 128 intervals", Density::Cubic}};
  std::vector<Lattice> lattices;
  for (const Way& way : ways) {
    const Model m = boiling(small ? 64 : 512, small ? 32 : 256, way.density);
    lattices.emplace_back(device, m);
    writeInitial(m, lukewarm(), lattices.back());
  }
  std::vector<std::vector<double>> times(lattices.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t i = 0; i < lattices.size(); ++i) {
      const double milliseconds = millisecondsOf(device, [&] { lattices[i].advance(steps); });
      if (round > 0) times[i].push_back(milliseconds);
    }
  }
  Table table({"tanh", "error predicted", "error measured", "time of a step over computing"});
  Verification verification("measured errors of tables over predicted ones", 1.0,
                            "the prediction is a bound");
  for (std::size_t i = 0; i < lattices.size(); ++i) {
    const auto reports = tablesOf(lattices[i].model(), device);
    if (!reports.empty()) verification.note(0, reports.front().measured / reports.front().predicted);
    table.add({ways[i].name, reports.empty() ? "-" : fmt::format("{:.1e}", reports.front().predicted),
               reports.empty() ? "-" : fmt::format("{:.1e}", reports.front().measured),
               fmt::format("{:.2f}", medianRatio(times[i], times[0]))});
  }
  return {table.markdown(), {verification}};
}

}  // namespace examples
