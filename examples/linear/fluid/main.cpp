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
#include "support/stopwatch.hpp"

namespace {

struct Settings {
  std::filesystem::path scene, csv;
  std::string study, size, scheme, precision;
  std::optional<std::int64_t> steps;
  std::optional<std::filesystem::path> output;
  std::optional<int> frames;
  bool small = false;
};

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("scene", s.scene, "what flows: a TOML file, as in examples/linear/fluid/scenes");
  std::string studies = "compare with solutions that are known, and print a table:";
  for (const fluid::Study& study : fluid::studies())
    studies += fmt::format("\n  {:<13} {}", study.name, study.asks);
  cli.add_option("--study", s.study, studies);
  cli.add_flag("--small", s.small, "a study in seconds, coarser");
  cli.add_option("--size", s.size,
                 "cells, WxH or WxHxD, in place of the scene's; the width of what is simulated stays");
  cli.add_option("--steps", s.steps, "steps, in place of the scene's")->check(CLI::Range(1, 1'000'000'000));
  cli.add_option("--scheme", s.scheme,
                 "semi-lagrangian, maccormack, bfecc or central, in place of the scene's")
      ->check(CLI::IsMember({"semi-lagrangian", "maccormack", "bfecc", "central"}));
  cli.add_option("--precision", s.precision, "single or double, in place of the scene's")
      ->check(CLI::IsMember({"single", "double"}));
  cli.add_option("--output", s.output,
                 "a picture (.png), an animation (.apng) or a film (.gif, .mp4, .webm)");
  cli.add_option("--frames", s.frames, "pictures, evenly spaced in steps")->check(CLI::Range(1, 99999));
  cli.add_option("--csv", s.csv,
                 "a file for time step, speed, divergence, iterations and energy of each step");
}

std::vector<std::int64_t> sizeOf(const std::string& text) {
  std::vector<std::int64_t> size;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('x', at), text.size());
    const std::string number = text.substr(at, end - at);
    const bool isNumber =
        !number.empty() && number.size() <= 5 && number.find_first_not_of("0123456789") == std::string::npos;
    size.push_back(isNumber ? std::stoll(number) : 0);
    at = end + 1;
  }
  if (size.size() < 2 || size.size() > 3 ||
      std::ranges::any_of(size, [](auto n) { return n < 2 || n > 16384; }))
    throw std::runtime_error(
        fmt::format("--size: '{}' is no size; write WxH or WxHxD, each from 2 to 16384", text));
  return size;
}

fluid::Scene sceneOf(const Settings& s) {
  fluid::Overrides overrides;
  if (!s.size.empty()) overrides.size = sizeOf(s.size);
  overrides.steps = s.steps;
  const auto names = fluid::schemeNames();
  if (!s.scheme.empty())
    overrides.scheme = static_cast<fluid::Scheme>(std::ranges::find(names, s.scheme) - names.begin());
  if (s.precision == "single") overrides.precision = sk::Precision::Single;
  if (s.precision == "double") overrides.precision = sk::Precision::Double;
  fluid::Scene scene = fluid::readScene(s.scene, overrides);
  if (s.output) scene.record.output = *s.output;
  if (s.frames) scene.record.frames = *s.frames;
  if (!s.csv.empty()) scene.record.csv = s.csv;
  return scene;
}

void study(examples::Application& app, const Settings& s) {
  std::string names;
  for (const fluid::Study& study : fluid::studies()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", study.name);
    if (study.name != s.study) continue;
    sk::Device device(app.device());
    const examples::Stopwatch watch;
    const fluid::Findings findings = study.run(device, s.small);
    app.report(fmt::format("{}: {}", study.name, study.asks), device.name(), watch.milliseconds());
    fmt::print("\n{}\n", findings.table);
    for (const examples::Verification& verification : findings.verifications) app.verified(verification);
    return;
  }
  throw std::runtime_error(fmt::format("no study is called '{}'; there are {}", s.study, names));
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

void simulate(examples::Application& app, const Settings& s) {
  const fluid::Scene scene = sceneOf(s);
  const fluid::Model& m = scene.model;
  sk::Device device(app.device());
  const fluid::Outcome o = fluid::run(device, scene);
  const std::string size = m.isSpace() ? fmt::format("{} x {} x {}", m.cells[0], m.cells[1], m.cells[2])
                                       : fmt::format("{} x {}", m.cells[0], m.cells[1]);
  app.report(fmt::format("{}, {}, {} steps", scene.name, size, o.steps), device.name(), o.milliseconds);
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
  if (o.pictures > 0) fmt::print("wrote {}\n", scene.record.output.string());
  if (!scene.record.csv.empty()) fmt::print("wrote {}\n", scene.record.csv.string());
  for (const examples::Verification& verification : o.verifications) app.verified(verification);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app(
      "fluid", "Incompressible flows in planes and in space: Navier and Stokes' equations from scene files.");
  addOptions(app.options(), settings);
  return app.run(argc, argv, [&] {
    if (!settings.study.empty()) return study(app, settings);
    if (settings.scene.empty())
      throw std::runtime_error("no scene is named; try examples/linear/fluid/scenes/plume.toml");
    simulate(app, settings);
  });
}
