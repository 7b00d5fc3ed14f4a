// SPDX-License-Identifier: MIT
//
// waves: the surface of water in a pool from scene files, and the studies of its accuracy.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "run.hpp"
#include "scene.hpp"
#include "study.hpp"
#include "support/application.hpp"
#include "support/host_memory.hpp"
#include "support/options.hpp"
#include "support/ranks.hpp"

namespace {

void simulate(examples::Application& app, const waves::Scene& scene) {
  const waves::Model& m = scene.model;
  const examples::OwnedSpace space(app.ranks(), app.device(), {m.height, m.width}, examples::Ends::Open);
  examples::requireMemoryForGrid(space.get().device(), fmt::format("{} x {}", m.width, m.height),
                                 m.width * m.height, waves::memoryFor(m), app.ranks().count());
  const waves::Outcome o = waves::run(space.get(), scene);
  app.report(fmt::format("{}, {} x {}, {} steps", scene.name, m.width, m.height, o.steps),
             examples::placeOf(app.ranks(), space.get().device().name()), o.milliseconds);
  fmt::print("{}, time {:.4g}, Courant number {:.3g}\n",
             waves::schemeNames[static_cast<std::size_t>(m.scheme)], o.time, std::sqrt(m.lambdaSquared()));
  fmt::print(
      "{:.1f} iterations a step, {} at most; residual at most {:.2g}, of the last step {:.2g} in double "
      "precision\n",
      static_cast<double>(o.iterations) / static_cast<double>(o.steps), o.mostIterations, o.residual,
      o.residualLast);
  fmt::print("energy {:.6g}, changed by {:+.2g} of it, besides what drops brought\n", o.energy, o.drift);
  if (o.missed > 0)
    fmt::print(
        "{} steps did not reach the tolerance {:.1g} in {} iterations; take a larger one, or more of them\n",
        o.missed, m.tolerance, m.mostIterations);
  examples::printWritten(scene.record, o.pictures);
  app.verified(o.verifications);
}

}  // namespace

int main(int argc, char** argv) {
  waves::Overrides overrides;
  std::string pixels;
  examples::Application app("waves", "Waves of a water surface: an implicit wave equation from scene files.",
                            examples::joinRanks());
  CLI::App& cli = app.options();
  const examples::SceneOptions options(
      cli, "a pool and its drops: a TOML file, as in examples/applications/waves/scenes",
      "cells, WxH, in place of the scene's; the pool's width stays", {2, 16384},
      "examples/applications/waves/scenes/drops.toml");
  examples::addChoice(cli, "--scheme", overrides.scheme, waves::schemeNames,
                      "crank-nicolson or backward-euler, in place of the scene's");
  examples::addChoice(cli, "--precision", overrides.precision, examples::commonPrecisions,
                      "single or double, in place of the scene's");
  cli.add_option("--pixels", pixels, "of a picture without its title, WxH, in place of the scene's");
  const examples::StudyOptions study(app, "compare with what is known", waves::studies);
  const examples::RecordOptions record(cli, "time, iterations, residual and energy of each step");
  return app.run(argc, argv, [&] {
    if (study.isGiven()) return study.run();
    const std::filesystem::path& file = options.apply(overrides);
    waves::Scene scene = waves::readScene(file, overrides);
    if (!pixels.empty()) {
      const std::vector<std::int64_t> extents = examples::extentsOf("--pixels", pixels, {16, 8192});
      scene.view.width = static_cast<int>(extents[0]);
      scene.view.height = static_cast<int>(extents[1]);
    }
    record.apply(scene.record);
    simulate(app, scene);
  });
}
