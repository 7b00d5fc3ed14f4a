// SPDX-License-Identifier: MIT
//
// Steps of one noisy torus with each layout of the library. A torus is a grid that is wrapped around twice, so that its matrix suits every layout, the one of
// diagonals included.
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "equations.hpp"
#include "flow.hpp"
#include "layout.hpp"
#include "study.hpp"
#include "support/stopwatch.hpp"
#include "support/table.hpp"

namespace smooth {

namespace {

struct Measured {
  std::string layout;
  Flow flow;
  std::int64_t stored;  ///< entries, those that only fill included
  std::int64_t bytes;  ///< that a product reads of the matrix
  StepReport first = {};
  double residual = 0.0;
  double milliseconds = std::numeric_limits<double>::infinity();
  double solving = std::numeric_limits<double>::infinity();
};

}  // namespace

Findings studyLayouts(sk::Device& device, bool small) {
  Surface surface = small ? torus(16, 8, 1.0, 0.4) : torus(96, 40, 1.0, 0.4);
  addNoise(surface, small ? 0.01 : 0.005, 3);
  FlowSettings settings{.timeStep = 0.002};
  Equations equations(surface);
  equations.update(surface, inspect(surface), settings.timeStep, settings.fixesBoundary);

  std::vector<Measured> all;
  for (const linear::LayoutKind& kind : linear::layoutKinds()) {
    settings.layout = kind.name;
    const auto matrix = kind.make(device, equations.matrix(), linear::Arithmetic());
    all.push_back({settings.layout, Flow(device, surface, settings), matrix->stored(), matrix->bytes()});
  }
  // In turns, since a machine is not always equally fast. The first steps build programs.
  for (int i = 0; i < (small ? 1 : 8); ++i) {
    for (Measured& m : all) {
      const examples::Stopwatch watch;
      const StepReport report = m.flow.step();
      const double milliseconds = watch.milliseconds();
      m.residual = std::max(m.residual, report.residual);
      if (i == 0) m.first = report;
      if (i == 0 && !small) continue;
      m.milliseconds = std::min(m.milliseconds, milliseconds);
      m.solving = std::min(m.solving, 1000.0 * report.secondsSolving);
    }
  }

  examples::Verification solved("||b - A x|| / ||b||, in double precision", settings.tolerance,
                                "the tolerance");
  // Changes of positions are a few edges at most, and the surface's size is about 1.
  examples::Verification same("distance of a vertex from where the first layout has it", small ? 1e-7 : 1e-6,
                              "each step solves to 1e-8 of the largest change");
  examples::Table table({"layout", "entries stored", "of the matrix' own", "KB a product", "CG iterations",
                         "true residual", "ms a step", "of it solving"});
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Measured& m = all[k];
    table.add({m.layout, fmt::format("{}", m.stored),
               fmt::format("{:.2f}",
                           static_cast<double>(m.stored) / static_cast<double>(equations.matrix().entries())),
               fmt::format("{:.0f}", static_cast<double>(m.bytes) / 1e3),
               fmt::format("{}", m.first.iterations), fmt::format("{:.1e}", m.residual),
               fmt::format("{:.1f}", m.milliseconds), fmt::format("{:.1f}", m.solving)});
    solved.note(static_cast<std::int64_t>(k), m.residual);
    for (std::size_t i = 0; i < surface.points.size(); ++i)
      same.note(static_cast<std::int64_t>(i),
                length(m.flow.surface().points[i] - all[0].flow.surface().points[i]));
  }
  return {table.markdown(), {solved, same}};
}

}  // namespace smooth
