// SPDX-License-Identifier: MIT
//
// gray_scott: patterns of a reaction with diffusion, in pictures.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "checks.hpp"
#include "model.hpp"
#include "simulation.hpp"
#include "support/application.hpp"
#include "support/colormap.hpp"
#include "support/progress.hpp"

namespace {

struct Settings {
  std::string pattern = "theta";
  std::optional<double> feed;
  std::optional<double> kill;
  double dt = 1.0;
  double dx = 2.5 / 256;
  int size = 512;
  int steps = 6000;
  int frames = 1;
  int seeds = 0;
  std::uint32_t randomSeed = 1;
  int checkedSteps = 500;
  std::string colours = "ember";
  double relief = 3.0;
  std::filesystem::path folder = ".";
};

void addOptions(CLI::App& cli, Settings& s) {
  std::string classes = "class of patterns, which sets F and k:";
  for (const examples::Pattern& p : examples::patterns()) {
    classes += fmt::format("\n  {:<8} F = {:<6} k = {:<7} {}", p.name, p.feed, p.kill, p.looks);
  }
  cli.add_option("--pattern", s.pattern, classes + "\n(default: theta)");
  cli.add_option("--feed", s.feed, "F, in place of the pattern's")->check(CLI::Range(0.0, 1.0));
  cli.add_option("--kill", s.kill, "k, in place of the pattern's")->check(CLI::Range(0.0, 1.0));
  cli.add_option("--dt", s.dt, "time step (default: 1)")->check(CLI::Range(0.0, 1000.0));
  cli.add_option("--dx", s.dx, "distance of two points (default: Pearson's 2.5 / 256)")
      ->check(CLI::Range(1e-4, 1.0));
  cli.add_option("--size", s.size, "points on each side (default: 512)")->check(CLI::Range(1, 8192));
  cli.add_option("--steps", s.steps, "time steps (default: 6000)")->check(CLI::Range(1, 100'000'000));
  cli.add_option("--frames", s.frames,
                 "pictures, evenly spaced in time, the last one at the end (default: 1)")
      ->check(CLI::Range(1, 9999));
  cli.add_option("--seeds", s.seeds,
                 "squares to start from; 1 for Pearson's in the middle (default: by size)")
      ->check(CLI::Range(0, 100'000));
  cli.add_option("--seed", s.randomSeed, "of the random numbers (default: 1)");
  cli.add_option("--check", s.checkedSteps, "steps to compare with double loops (default: 500)")
      ->check(CLI::Range(1, 100'000'000));
  cli.add_option("--colours", s.colours, "lagoon, ember or dusk (default: ember)");
  cli.add_option("--relief", s.relief, "height of the landscape in the picture; 0 for none (default: 3)")
      ->check(CLI::Range(0.0, 100.0));
  cli.add_option("-o,--output", s.folder, "folder for the pictures (default: the current one)");
}

examples::Parameters parametersOf(const Settings& s) {
  constexpr double diffusionU = 2e-5, diffusionV = 1e-5;  // Pearson's
  const examples::Pattern& pattern = examples::findPattern(s.pattern);
  return {static_cast<float>(s.feed.value_or(pattern.feed)),
          static_cast<float>(s.kill.value_or(pattern.kill)), static_cast<float>(diffusionU / (s.dx * s.dx)),
          static_cast<float>(diffusionV / (s.dx * s.dx)), static_cast<float>(s.dt)};
}

void warnOfInstability(const examples::Parameters& p) {
  const double limit = examples::largestTimeStep(p);
  if (p.dt > limit) {
    fmt::print(stderr,
               "gray_scott: warning: time step {:g} is above {:.4g}, where explicit steps become unstable; "
               "take --dt below it\n",
               p.dt, limit);
  } else if (p.dt > 0.9 * limit) {
    fmt::print(stderr,
               "gray_scott: warning: time step {:g} is within 10 % of {:.4g}, where explicit steps become "
               "unstable; the pattern may not be the true one\n",
               p.dt, limit);
  }
}

std::filesystem::path pictureFile(const Settings& s, int frame) {
  if (s.frames == 1) return s.folder / fmt::format("gray_scott_{}.png", s.pattern);
  return s.folder / fmt::format("gray_scott_{}_{:04}.png", s.pattern, frame);
}

/// States that the checks need.
struct Record {
  std::vector<sk::float2> checked;      ///< after checkedSteps
  std::vector<sk::float2> beforeLast;
};

/// All steps, in pieces that end where a picture or a state is due.
Record run(examples::Simulation& simulation, const Settings& s, int checkedSteps) {
  constexpr int piece = 64;
  Record record;
  examples::Progress progress(fmt::format("{} {} x {}", s.pattern, s.size, s.size), s.steps);
  int frame = 1;
  for (int step = 0; step < s.steps;) {
    const int nextFrame = static_cast<int>(static_cast<std::int64_t>(s.steps) * frame / s.frames);
    int end = std::min(step + piece, std::max(nextFrame, step + 1));
    for (int stop : {checkedSteps, s.steps - 1, s.steps}) {
      if (stop > step) end = std::min(end, stop);
    }
    simulation.advance(end - step);
    step = end;
    if (step == checkedSteps) record.checked = simulation.state();
    if (step == s.steps - 1) record.beforeLast = simulation.state();
    while (frame <= s.frames && step >= static_cast<std::int64_t>(s.steps) * frame / s.frames) {
      progress.clear();
      simulation.savePicture(pictureFile(s, frame++));
    }
    progress.update(step);
  }
  return record;
}

void simulate(examples::Application& app, Settings s) {
  const examples::Parameters p = parametersOf(s);
  warnOfInstability(p);
  if (s.seeds == 0) s.seeds = std::max(1, s.size * s.size / 6000);
  const int checkedSteps = std::min(s.checkedSteps, s.steps);
  const std::vector<sk::float2> first = examples::firstState(s.size, s.seeds, s.randomSeed);

  sk::Device device(app.device());
  examples::Simulation simulation(device, s.size, p, first);
  simulation.paintWith(examples::colormap(s.colours, 256), static_cast<float>(s.relief));
  Record record = run(simulation, s, checkedSteps);
  if (s.steps == 1) record.beforeLast = first;

  const std::vector<sk::float2> last = simulation.state();
  const examples::FieldBounds b = simulation.bounds();
  const examples::Means means = examples::meansOf(last);
  if (!std::isfinite(means.u + means.v)) {
    throw std::runtime_error(fmt::format("the field is not finite any more; take --dt below {:.4g}",
                                         examples::largestTimeStep(p)));
  }
  app.report(fmt::format("{} (F = {:.4g}, k = {:.4g}), {} x {}, {} steps", s.pattern, p.feed, p.kill, s.size,
                         s.size, s.steps),
             device.name(), simulation.milliseconds());
  fmt::print("{:.3g} ms a step; wrote {}\n", simulation.milliseconds() / s.steps,
             pictureFile(s, s.frames).string());
  fmt::print("at the end: u in [{:.4f}, {:.4f}], mean {:.6f}; v in [{:.4f}, {:.4f}], mean {:.6f}\n", b.low.x,
             b.high.x, means.u, b.low.y, b.high.y, means.v);
  app.verified(examples::checkSteps(s.size, checkedSteps, p, first, record.checked));
  app.verified(examples::checkBalance(p, record.beforeLast, last));
  app.verified(examples::checkMeans(last, simulation.sum()));
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app(
      "gray_scott", "Spots, stripes, mazes and chaos: the Gray-Scott reaction with diffusion on a torus.");
  addOptions(app.options(), settings);
  return app.run(argc, argv, [&] { simulate(app, settings); });
}
