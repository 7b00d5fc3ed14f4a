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
#include "support/stopwatch.hpp"

namespace {

struct Settings {
  std::filesystem::path scene, csv;
  std::string study, size, pixels, scheme, precision;
  std::optional<std::int64_t> steps;
  std::optional<std::filesystem::path> output;
  std::optional<int> frames;
  bool small = false;
};

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("scene", s.scene, "a pool and its drops: a TOML file, as in examples/linear/waves/scenes");
  std::string studies = "compare with what is known, and print a table:";
  for (const waves::Study& study : waves::studies())
    studies += fmt::format("\n  {:<11} {}", study.name, study.asks);
  cli.add_option("--study", s.study, studies);
  cli.add_flag("--small", s.small, "a study in seconds, coarser");
  cli.add_option("--size", s.size, "cells, WxH, in place of the scene's; the pool's width stays");
  cli.add_option("--steps", s.steps, "steps, in place of the scene's")->check(CLI::Range(1, 1'000'000'000));
  cli.add_option("--scheme", s.scheme, "crank-nicolson or backward-euler, in place of the scene's")
      ->check(CLI::IsMember({"crank-nicolson", "backward-euler"}));
  cli.add_option("--precision", s.precision, "single or double, in place of the scene's")
      ->check(CLI::IsMember({"single", "double"}));
  cli.add_option("--output", s.output,
                 "a picture (.png), an animation (.apng) or a film (.gif, .mp4, .webm)");
  cli.add_option("--pixels", s.pixels, "of a picture without its title, WxH, in place of the scene's");
  cli.add_option("--frames", s.frames, "pictures, evenly spaced in steps")->check(CLI::Range(1, 99999));
  cli.add_option("--csv", s.csv, "a file for time, iterations, residual and energy of each step");
}

std::vector<std::int64_t> sizeOf(const char* option, const std::string& text, std::int64_t least,
                                 std::int64_t most) {
  const std::size_t x = text.find('x');
  std::vector<std::int64_t> size;
  for (const std::string& number : {text.substr(0, x), x == std::string::npos ? "" : text.substr(x + 1)}) {
    const bool isNumber =
        !number.empty() && number.size() <= 5 && number.find_first_not_of("0123456789") == std::string::npos;
    size.push_back(isNumber ? std::stoll(number) : 0);
  }
  if (std::ranges::any_of(size, [&](auto n) { return n < least || n > most; }))
    throw std::runtime_error(
        fmt::format("{}: '{}' is no size; write WxH, each from {} to {}", option, text, least, most));
  return size;
}

waves::Scene sceneOf(const Settings& s) {
  waves::Overrides overrides;
  if (!s.size.empty()) overrides.size = sizeOf("--size", s.size, 2, 16384);
  overrides.steps = s.steps;
  const auto names = waves::schemeNames();
  if (!s.scheme.empty())
    overrides.scheme = static_cast<waves::Scheme>(std::ranges::find(names, s.scheme) - names.begin());
  if (s.precision == "single") overrides.precision = sk::Precision::Single;
  if (s.precision == "double") overrides.precision = sk::Precision::Double;
  waves::Scene scene = waves::readScene(s.scene, overrides);
  if (!s.pixels.empty()) {
    const std::vector<std::int64_t> pixels = sizeOf("--pixels", s.pixels, 16, 8192);
    scene.view.width = static_cast<int>(pixels[0]);
    scene.view.height = static_cast<int>(pixels[1]);
  }
  if (s.output) scene.record.output = *s.output;
  if (s.frames) scene.record.frames = *s.frames;
  if (!s.csv.empty()) scene.record.csv = s.csv;
  return scene;
}

void study(examples::Application& app, const Settings& s) {
  std::string names;
  for (const waves::Study& study : waves::studies()) {
    names += fmt::format("{}{}", names.empty() ? "" : ", ", study.name);
    if (study.name != s.study) continue;
    sk::Device device(app.device());
    const examples::Stopwatch watch;
    const waves::Findings findings = study.run(device, s.small);
    app.report(fmt::format("{}: {}", study.name, study.asks), device.name(), watch.milliseconds());
    fmt::print("\n{}\n", findings.table);
    for (const examples::Verification& verification : findings.verifications) app.verified(verification);
    return;
  }
  throw std::runtime_error(fmt::format("no study is called '{}'; there are {}", s.study, names));
}

void simulate(examples::Application& app, const Settings& s) {
  const waves::Scene scene = sceneOf(s);
  const waves::Model& m = scene.model;
  sk::Device device(app.device());
  const waves::Outcome o = waves::run(device, scene);
  app.report(fmt::format("{}, {} x {}, {} steps", scene.name, m.width, m.height, o.steps), device.name(),
             o.milliseconds);
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
  if (o.pictures > 0) fmt::print("wrote {}\n", scene.record.output.string());
  if (!scene.record.csv.empty()) fmt::print("wrote {}\n", scene.record.csv.string());
  for (const examples::Verification& verification : o.verifications) app.verified(verification);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app("waves", "Waves of a water surface: an implicit wave equation from scene files.");
  addOptions(app.options(), settings);
  return app.run(argc, argv, [&] {
    if (!settings.study.empty()) return study(app, settings);
    if (settings.scene.empty())
      throw std::runtime_error("no scene is named; try examples/linear/waves/scenes/drops.toml");
    simulate(app, settings);
  });
}
