// SPDX-License-Identifier: MIT
//
// fluid: incompressible flows from scene files, and the studies of their accuracy.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
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
#include "support/record.hpp"

namespace {

struct Settings {
  std::filesystem::path scene;
  std::string size, scheme, projection, precision;
  std::optional<std::int64_t> steps;
};

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("scene", s.scene, "what flows: a TOML file, as in examples/linear/fluid/scenes");
  cli.add_option("--size", s.size,
                 "cells, WxH or WxHxD, in place of the scene's; the width of what is simulated stays");
  cli.add_option("--steps", s.steps, "steps, in place of the scene's")->check(CLI::Range(1, 1'000'000'000));
  cli.add_option("--scheme", s.scheme,
                 "semi-lagrangian, maccormack, bfecc or central, in place of the scene's")
      ->check(CLI::IsMember({"semi-lagrangian", "maccormack", "bfecc", "central"}));
  cli.add_option("--projection", s.projection,
                 "chebyshev or multigrid, what preconditions the projection, in place of the scene's")
      ->check(CLI::IsMember({"chebyshev", "multigrid"}));
  cli.add_option("--precision", s.precision, "single or double, in place of the scene's")
      ->check(CLI::IsMember({"single", "double"}));
}

fluid::Scene sceneOf(const Settings& s, const examples::RecordOptions& record) {
  fluid::Overrides overrides;
  if (!s.size.empty()) overrides.size = examples::extentsOf("--size", s.size, {2, 16384, 3});
  overrides.steps = s.steps;
  const auto names = fluid::schemeNames();
  if (!s.scheme.empty())
    overrides.scheme = static_cast<fluid::Scheme>(std::ranges::find(names, s.scheme) - names.begin());
  const auto projectors = fluid::projectorNames();
  if (!s.projection.empty())
    overrides.projector =
        static_cast<fluid::Projector>(std::ranges::find(projectors, s.projection) - projectors.begin());
  if (s.precision == "single") overrides.precision = sk::Precision::Single;
  if (s.precision == "double") overrides.precision = sk::Precision::Double;
  fluid::Scene scene = fluid::readScene(s.scene, overrides);
  record.apply(scene.record);
  return scene;
}

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
  for (const examples::Verification& verification : o.verifications) app.verified(verification);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app(
      "fluid", "Incompressible flows in planes and in space: Navier and Stokes' equations from scene files.",
      examples::joinRanks());
  addOptions(app.options(), settings);
  const examples::StudyOptions study(app, "compare with solutions that are known", fluid::studies());
  const examples::RecordOptions record(app.options(),
                                       "time step, speed, divergence, iterations and energy of each step");
  return app.run(argc, argv, [&] {
    if (study.isGiven()) return study.run();
    if (settings.scene.empty())
      throw std::runtime_error("no scene is named; try examples/linear/fluid/scenes/plume.toml");
    simulate(app, sceneOf(settings, record));
  });
}
