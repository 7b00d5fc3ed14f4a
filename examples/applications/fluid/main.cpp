// SPDX-License-Identifier: MIT
//
// fluid: incompressible flows from scene files, and the studies of their accuracy.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sk/sk.hpp>

#include "run.hpp"
#include "scene.hpp"
#include "study.hpp"
#include "support/application.hpp"
#include "support/host_memory.hpp"
#include "support/options.hpp"
#include "support/ranks.hpp"

namespace {

/// What a scene does without, and is therefore neither compiled nor stored.
std::string leftOut(const fluid::Model& m) {
  std::vector<std::string> names;
  if (!m.isSpace()) names.emplace_back("the third dimension");
  if (m.bounds() != fluid::Anywhere) names.emplace_back("obstacles");
  if (m.bounds() == fluid::Nowhere) names.emplace_back("sides");
  if (!m.viscosity) names.emplace_back("viscosity");
  if (!m.hasSmoke) names.emplace_back("smoke");
  if (!m.hasHeat) names.emplace_back("heat");
  if (!m.buoyancy) names.emplace_back("buoyancy");
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, ", "));
}

void simulate(examples::Application& app, const fluid::Scene& scene) {
  const fluid::Model& m = scene.model;
  const examples::OwnedSpace space(app.ranks(), app.device(), m.shape(), examples::Ends::Joined);
  examples::requireMemoryForGrid(space.get().device(), fluid::sizeText(m), m.shape().size(),
                                 fluid::memoryFor(m), app.ranks().count());
  const fluid::Outcome o = fluid::run(space.get(), scene);
  app.report(fmt::format("{}, {}, {} steps", scene.name, fluid::sizeText(m), o.steps),
             examples::placeOf(app.ranks(), space.get().device().name()), o.milliseconds);
  fmt::print("computed: {}\nleft out: {}\n", fluid::operatorsOf(m), leftOut(m));
  fmt::print("a step: {} streams, {:.0f} passes, {:.1f} MB\n", o.streams, o.passes, o.bytes / 1e6);
  fmt::print("time {:.4g}, steps of {:.3g} to {:.3g} ({}), CFL number at most {:.2f}\n", o.time, o.shortest,
             o.longest, m.timeStep ? "as the scene says" : "chosen for the CFL number", o.largestCfl);
  const fluid::Projection& p = o.last.projection;
  fmt::print(
      "max |div u| {:.3g} before the last projection, {:.3g} after it; residual {:.2g} true, {:.2g} "
      "recurred; {:.1f} "
      "iterations a step\n",
      p.before, p.after, p.residual, p.recurred,
      static_cast<double>(o.iterations) / static_cast<double>(std::max<std::int64_t>(o.steps, 1)));
  if (o.missed > 0)
    fmt::print(
        "{} steps did not reach the tolerance {:.1g} in {} iterations; take a larger one, or more of them\n",
        o.missed, m.tolerance, m.mostIterations);
  examples::printWritten(scene.record, o.pictures);
  app.verified(o.verifications);
}

}  // namespace

int main(int argc, char** argv) {
  fluid::Overrides overrides;
  examples::Application app(
      "fluid", "Incompressible flows in planes and in space: Navier and Stokes' equations from scene files.",
      examples::joinRanks());
  CLI::App& cli = app.options();
  const examples::SceneOptions options(
      cli, "what flows: a TOML file, as in examples/applications/fluid/scenes",
      "cells, WxH or WxHxD, in place of the scene's; the width of what is simulated stays", {2, 16384, 3},
      "examples/applications/fluid/scenes/plume.toml");
  examples::addChoice(cli, "--scheme", overrides.scheme, fluid::schemeNames,
                      "semi-lagrangian, maccormack, bfecc or central, in place of the scene's");
  examples::addChoice(cli, "--projection", overrides.projector, fluid::projectorNames,
                      "chebyshev or multigrid, what preconditions the projection, in place of the scene's");
  examples::addChoice(cli, "--precision", overrides.precision, examples::commonPrecisions,
                      "single or double, in place of the scene's");
  const examples::StudyOptions study(app, "compare with solutions that are known", fluid::studies);
  const examples::RecordOptions record(cli,
                                       "time step, speed, divergence, iterations and energy of each step");
  return app.run(argc, argv, [&] {
    if (study.isGiven()) return study.run();
    const std::filesystem::path& file = options.apply(overrides);
    fluid::Scene scene = fluid::readScene(file, overrides);
    record.apply(scene.record);
    simulate(app, scene);
  });
}
