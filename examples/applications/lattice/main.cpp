// SPDX-License-Identifier: MIT
//
// lattice: coupled map lattices from scene files, and the studies of their numerics.
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "account.hpp"
#include "lattice.hpp"
#include "limits.hpp"
#include "run.hpp"
#include "scene.hpp"
#include "study.hpp"
#include "support/application.hpp"
#include "support/host_memory.hpp"
#include "support/options.hpp"
#include "support/ranks.hpp"
#include "text/real_option.hpp"

namespace {

struct Settings {
  examples::Overrides overrides;
  bool account = true;
  bool window = false;
};

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("--until-settled", s.overrides.settle,
                 "end when no field changes by more than this in a step")
      ->check(sk::text::realFrom(0, 1e12), "0 to 1e12");
  examples::addChoice(cli, "--precision", s.overrides.precision, examples::precisionNames,
                      "half, single, extended or double, in place of the scene's");
  cli.add_flag("--window", s.window, "show it in a window while it runs: space, s, f, +, -, r, q");
  cli.add_flag("!--no-account", s.account, "leave out what the full model would have cost");
}

std::string sizeText(const examples::Grid& g) {
  return g.isSpace() ? fmt::format("{} x {} x {}", g.width, g.height, g.depth)
                     : fmt::format("{} x {}", g.width, g.height);
}

void simulate(examples::Application& app, const examples::Scene& scene, const Settings& s) {
  const examples::Ranks& ranks = app.ranks();
  if (s.window) {
    ranks.refuseSeveral("--window", "start it without mpirun, or make a film with --output");
    return examples::runLive(scene, app.device());
  }
  const examples::OwnedSpace owned(app.ranks(), app.device(), examples::shapeOf(scene.model.grid),
                                   examples::Ends::Joined);
  const examples::Space& space = owned.get();
  sk::Device& device = space.device();
  const bool hasAccount = s.account && ranks.count() == 1;  // the account is of one device
  examples::requireMemoryForGrid(device, sizeText(scene.model.grid), scene.model.grid.cells(),
                                 examples::memoryFor(scene, hasAccount), ranks.count());
  examples::Lattice lattice(space, scene.model);
  examples::writeInitial(scene.model, scene.initial, lattice);
  const examples::Outcome outcome = examples::runScene(scene, lattice);

  app.report(fmt::format("{}, {}, {} steps", scene.name, sizeText(scene.model.grid), outcome.steps),
             examples::placeOf(ranks, device.name()), outcome.milliseconds);
  if (scene.settling) {
    fmt::print("{} after {} steps: the last change was {:.2g} a step, asked {} times\n",
               outcome.settled ? "settled" : "not settled", outcome.steps, outcome.change, outcome.checks);
  }
  for (const examples::Limit& limit : examples::limitsOf(scene.model)) {
    fmt::print("time step {:.4g}: {:.0f} % of what {} allows, {:.4g} ({})\n", limit.chosen,
               100.0 * limit.chosen / limit.largest, limit.of, limit.largest, limit.formula);
  }
  if (const auto& flow = scene.model.flow) {
    const double wind = examples::fastestOf(lattice);
    fmt::print("wind {:.3g}: u^2 dt is {:.0f} % of the 2 nu that it may be, u / c is {:.2f}\n", wind,
               50.0 * wind * wind * scene.model.timeStep / flow->viscosity, wind / flow->sound);
  }
  double tableError = 0.0;
  for (const sk::TableReport& table : examples::tablesOf(scene.model, device)) {
    fmt::print("table of {}: error {:.2g} predicted, {:.2g} measured\n", table.function, table.predicted,
               table.measured);
    tableError = std::max(tableError, table.predicted);
  }
  examples::printWritten(scene.record, outcome.frames);
  if (space.isFirst())
    app.verified(examples::checkStep(scene.model, outcome.beforeLast, outcome.last, tableError));
  if (!hasAccount) return;
  const examples::Account account = examples::accountFor(device, scene, outcome.beforeLast);
  fmt::print("\n{}\n", account.text());
  app.verified(account.agreement);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app(
      "lattice", "Boiling, convection, reaction with diffusion: coupled map lattices from scene files.",
      examples::joinRanks());
  const examples::SceneOptions options(app.options(),
                                       "what to run: a TOML file, as in examples/applications/lattice/scenes",
                                       "cells, WxH or WxHxD, in place of the scene's", {1, 32768, 3},
                                       "examples/applications/lattice/scenes/boiling.toml");
  addOptions(app.options(), settings);
  const examples::StudyOptions study(app, "measure the numerics", examples::studies);
  const examples::RecordOptions record(app.options(), "means, extremes, Nusselt number ... while it runs");
  return app.run(argc, argv, [&] {
    if (study.isGiven()) return study.run();
    const std::filesystem::path& file = options.apply(settings.overrides);
    examples::Scene scene = examples::readScene(file, settings.overrides);
    record.apply(scene.record);
    simulate(app, scene, settings);
  });
}
