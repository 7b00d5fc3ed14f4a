// SPDX-License-Identifier: MIT
//
// lattice: coupled map lattices from scene files, and the studies of their numerics.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "account.hpp"
#include "initial.hpp"
#include "lattice.hpp"
#include "limits.hpp"
#include "live.hpp"
#include "run.hpp"
#include "scene.hpp"
#include "study.hpp"
#include "support/application.hpp"
#include "support/stopwatch.hpp"

namespace {

struct Settings {
  std::filesystem::path scene;
  std::string study;
  std::string size;
  std::optional<std::int64_t> steps;
  std::optional<double> settle;
  std::string precision;
  std::optional<std::filesystem::path> output;
  std::filesystem::path csv;
  std::optional<int> frames;
  bool account = true;
  bool small = false;
  bool window = false;
};

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("scene", s.scene, "what to run: a TOML file, as in examples/lattice/scenes");
  std::string studies = "measure the numerics, and print a table:";
  for (const examples::Study& study : examples::studies())
    studies += fmt::format("\n  {:<13} {}", study.name, study.asks);
  cli.add_option("--study", s.study, studies);
  cli.add_flag("--small", s.small, "a study in seconds, coarser");
  cli.add_option("--size", s.size, "cells, WxH or WxHxD, in place of the scene's");
  cli.add_option("--steps", s.steps, "steps, in place of the scene's")->check(CLI::Range(1, 1'000'000'000));
  cli.add_option("--until-settled", s.settle, "end when no field changes by more than this in a step")
      ->check(CLI::Range(0.0, 1e12));
  cli.add_option("--precision", s.precision, "half, single, extended or double, in place of the scene's")
      ->check(CLI::IsMember({"half", "single", "extended", "double"}));
  cli.add_option("--output", s.output,
                 "a picture (.png), an animation (.apng) or a film (.gif, .mp4, .webm)");
  cli.add_option("--frames", s.frames, "pictures, evenly spaced in time")->check(CLI::Range(1, 99999));
  cli.add_option("--csv", s.csv, "a file for means, extremes, Nusselt number ... while it runs");
  cli.add_flag("--window", s.window, "show it in a window while it runs: space, s, f, +, -, r, q");
  cli.add_flag("!--no-account", s.account, "leave out what the full model would have cost");
}

/// "256x128" and "64x64x64".
std::vector<std::int64_t> sizeOf(const std::string& text) {
  std::vector<std::int64_t> size;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t end = std::min(text.find('x', at), text.size());
    const std::string number = text.substr(at, end - at);
    const bool isNumber =
        !number.empty() && number.size() <= 5 && number.find_first_not_of("0123456789") == std::string::npos;
    const std::int64_t n = isNumber ? std::stoll(number) : 0;
    if (n < 1 || n > 32768)
      throw std::runtime_error(
          fmt::format("--size: '{}' is no size; write WxH or WxHxD, each from 1 to 32768", text));
    size.push_back(n);
    at = end + 1;
  }
  if (size.size() < 2 || size.size() > 3)
    throw std::runtime_error(fmt::format("--size: '{}' is no size; write WxH or WxHxD", text));
  return size;
}

examples::Scene sceneOf(const Settings& s) {
  examples::Overrides overrides;
  if (!s.size.empty()) overrides.size = sizeOf(s.size);
  overrides.steps = s.steps;
  overrides.settle = s.settle;
  if (s.precision == "half") overrides.precision = sk::Precision::Half;
  if (s.precision == "single") overrides.precision = sk::Precision::Single;
  if (s.precision == "extended") overrides.precision = sk::Precision::Extended;
  if (s.precision == "double") overrides.precision = sk::Precision::Double;
  examples::Scene scene = examples::readScene(s.scene, overrides);
  if (s.output) scene.record.output = *s.output;
  if (s.frames) scene.record.frames = *s.frames;
  if (!s.csv.empty()) scene.record.csv = s.csv;
  return scene;
}

std::string sizeText(const examples::Grid& g) {
  return g.isSpace() ? fmt::format("{} x {} x {}", g.width, g.height, g.depth)
                     : fmt::format("{} x {}", g.width, g.height);
}

void study(examples::Application& app, const Settings& s) {
  std::string names;
  for (const examples::Study& study : examples::studies()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", study.name);
    if (study.name != s.study) continue;
    sk::Device device(app.device());
    const examples::Stopwatch stopwatch;
    const examples::Findings findings = study.run(device, s.small);
    app.report(fmt::format("{}: {}", study.name, study.asks), device.name(), stopwatch.milliseconds());
    fmt::print("\n{}\n", findings.table);
    for (const examples::Verification& verification : findings.verifications) app.verified(verification);
    return;
  }
  throw std::runtime_error(fmt::format("no study is called '{}'; there are {}", s.study, names));
}

void simulate(examples::Application& app, const Settings& s) {
  const examples::Scene scene = sceneOf(s);
  if (s.window) return examples::runLive(scene, app.device());
  sk::Device device(app.device());
  examples::Lattice lattice(device, scene.model);
  examples::writeInitial(scene.model, scene.initial, lattice);
  const examples::Outcome outcome = examples::runScene(device, scene, lattice);

  app.report(fmt::format("{}, {}, {} steps", scene.name, sizeText(scene.model.grid), outcome.steps),
             device.name(), outcome.milliseconds);
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
  if (outcome.frames > 0) fmt::print("wrote {}\n", scene.record.output.string());
  if (!scene.record.csv.empty()) fmt::print("wrote {}\n", scene.record.csv.string());
  app.verified(examples::checkStep(scene.model, outcome.beforeLast, outcome.last, tableError));
  if (!s.account) return;
  const examples::Account account = examples::accountFor(device, scene, outcome.beforeLast);
  fmt::print("\n{}\n", account.text());
  app.verified(account.agreement);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app(
      "lattice", "Boiling, convection, reaction with diffusion: coupled map lattices from scene files.");
  addOptions(app.options(), settings);
  return app.run(argc, argv, [&] {
    if (!settings.study.empty()) return study(app, settings);
    if (settings.scene.empty())
      throw std::runtime_error("no scene is named; try examples/lattice/scenes/boiling.toml");
    simulate(app, settings);
  });
}
