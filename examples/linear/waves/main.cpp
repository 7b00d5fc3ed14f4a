// SPDX-License-Identifier: MIT
//
// waves: the surface of water in a pool from scene files, and the studies of its accuracy.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
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
#include "support/record.hpp"

namespace {

struct Settings {
  std::filesystem::path scene;
  std::string size, pixels, scheme, precision;
  std::optional<std::int64_t> steps;
};

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("scene", s.scene, "a pool and its drops: a TOML file, as in examples/linear/waves/scenes");
  cli.add_option("--size", s.size, "cells, WxH, in place of the scene's; the pool's width stays");
  cli.add_option("--steps", s.steps, "steps, in place of the scene's")->check(CLI::Range(1, 1'000'000'000));
  cli.add_option("--scheme", s.scheme, "crank-nicolson or backward-euler, in place of the scene's")
      ->check(CLI::IsMember({"crank-nicolson", "backward-euler"}));
  cli.add_option("--precision", s.precision, "single or double, in place of the scene's")
      ->check(CLI::IsMember({"single", "double"}));
  cli.add_option("--pixels", s.pixels, "of a picture without its title, WxH, in place of the scene's");
}

waves::Scene sceneOf(const Settings& s, const examples::RecordOptions& record) {
  waves::Overrides overrides;
  if (!s.size.empty()) overrides.size = examples::extentsOf("--size", s.size, {2, 16384});
  overrides.steps = s.steps;
  const auto names = waves::schemeNames();
  if (!s.scheme.empty())
    overrides.scheme = static_cast<waves::Scheme>(std::ranges::find(names, s.scheme) - names.begin());
  if (s.precision == "single") overrides.precision = sk::Precision::Single;
  if (s.precision == "double") overrides.precision = sk::Precision::Double;
  waves::Scene scene = waves::readScene(s.scene, overrides);
  if (!s.pixels.empty()) {
    const std::vector<std::int64_t> pixels = examples::extentsOf("--pixels", s.pixels, {16, 8192});
    scene.view.width = static_cast<int>(pixels[0]);
    scene.view.height = static_cast<int>(pixels[1]);
  }
  record.apply(scene.record);
  return scene;
}

void simulate(examples::Application& app, const waves::Scene& scene) {
  const waves::Model& m = scene.model;
  const examples::OwnedSpace space(app.ranks(), app.device(), {m.height, m.width}, examples::Ends::Open);
  examples::requireMemoryForGrid(space.get().device(), fmt::format("{} x {}", m.width, m.height),
                                 m.width * m.height, waves::memoryFor(m), app.ranks().count());
  const waves::Outcome o = waves::run(space.get(), scene);
  app.report(fmt::format("{}, {} x {}, {} steps", scene.name, m.width, m.height, o.steps),
             examples::placeOf(app.ranks(), space.get().device().name()), o.milliseconds);
  fmt::print("{}, time {:.4g}, Courant number {:.3g}\n",
             waves::schemeNames()[static_cast<std::size_t>(m.scheme)], o.time, std::sqrt(m.lambdaSquared()));
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
  for (const examples::Verification& verification : o.verifications) app.verified(verification);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app("waves", "Waves of a water surface: an implicit wave equation from scene files.",
                            examples::joinRanks());
  addOptions(app.options(), settings);
  const examples::StudyOptions study(app, "compare with what is known", waves::studies());
  const examples::RecordOptions record(app.options(), "time, iterations, residual and energy of each step");
  return app.run(argc, argv, [&] {
    if (study.isGiven()) return study.run();
    if (settings.scene.empty())
      throw std::runtime_error("no scene is named; try examples/linear/waves/scenes/drops.toml");
    simulate(app, sceneOf(settings, record));
  });
}
