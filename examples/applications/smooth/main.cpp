// SPDX-License-Identifier: MIT
//
// smooth: implicit mean-curvature flow of a mesh or of a scene's surface, and studies of it.
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "flow.hpp"
#include "study.hpp"
#include "support/application.hpp"
#include "support/figure.hpp"
#include "support/image.hpp"
#include "support/options.hpp"
#include "support/progress.hpp"
#include "support/scene_file.hpp"
#include "support/stopwatch.hpp"
#include "text/real_option.hpp"

namespace {

struct Settings {
  std::filesystem::path input, obj, picture;
  std::optional<std::int64_t> steps;
  std::optional<double> timeStep;
  std::optional<std::string> layout, precision;
};

struct Scene {
  std::string name;
  smooth::Surface surface;
  smooth::FlowSettings flow;
  std::int64_t steps = 10;
};

constexpr std::array<std::string_view, 2> shapes = {"sphere", "torus"};
constexpr std::array<std::string_view, 2> boundaries = {"fixed", "free"};
constexpr examples::Range positive{1e-12, 1e12};

smooth::Surface readSurface(const examples::SceneTable& table, const std::filesystem::path& folder) {
  smooth::Surface surface;
  if (const auto file = table.text("file")) {
    if (table.has("shape")) table.fail("shape", "a surface has a file or a shape, and this one has both");
    surface = smooth::loadObj(folder / *file);
  } else {
    const auto shape = table.choice("shape", shapes);
    if (!shape) table.fail("shape", "a surface has a file or a shape, \"sphere\" or \"torus\"");
    const double radius = table.number("radius", positive).value_or(1.0);
    if (*shape == 0) {
      surface = smooth::sphere(static_cast<int>(table.integer("level", {0, 8}).value_or(4)), radius);
    } else {
      surface = smooth::torus(static_cast<int>(table.integer("around", {3, 4096}).value_or(96)),
                              static_cast<int>(table.integer("across", {3, 4096}).value_or(48)), radius,
                              table.number("tube", positive).value_or(0.4 * radius));
    }
  }
  const double noise = table.number("noise", {0.0, 1e12}).value_or(0.0);
  smooth::addNoise(surface, noise,
                   static_cast<std::uint32_t>(table.integer("seed", {0, 4294967295.0}).value_or(1)));
  return surface;
}

Scene readScene(const std::filesystem::path& file) {
  const examples::SceneTable table = examples::loadScene(file);
  Scene scene;
  scene.name = table.text("title").value_or(file.stem().string());
  const auto surface = table.table("surface");
  if (!surface) table.fail("surface", "a scene has a table [surface]");
  scene.surface = readSurface(*surface, file.parent_path());
  if (const auto flow = table.table("flow")) {
    smooth::FlowSettings& f = scene.flow;
    flow->read("time_step", f.timeStep, positive);
    flow->read("keep_volume", f.keepsVolume);
    f.fixesBoundary = flow->choice("boundary", boundaries).value_or(0) == 0;
    flow->read("tolerance", f.tolerance, {1e-14, 0.1});
    flow->read("layout", f.layout);
    f.precision = smooth::precisionNames()[flow->choice("precision", smooth::precisionNames()).value_or(0)];
    flow->read("steps", scene.steps, {1, 1e9});
  }
  table.finish();
  return scene;
}

void run(examples::Application& app, const Settings& s) {
  Scene scene;
  if (!s.picture.empty()) examples::checkPngName(s.picture);
  if (s.input.extension() == ".obj") {
    scene.name = s.input.filename().string();
    scene.surface = smooth::loadObj(s.input);
  } else if (s.input.extension() == ".toml") {
    scene = readScene(s.input);
  } else {
    throw std::runtime_error(fmt::format(
        "'{}' is neither a mesh, .obj, nor a scene, .toml; convert other meshes to OBJ", s.input.string()));
  }
  if (s.steps) scene.steps = *s.steps;
  if (s.timeStep) scene.flow.timeStep = *s.timeStep;
  if (s.layout) scene.flow.layout = *s.layout;
  if (s.precision) scene.flow.precision = *s.precision;

  sk::Device device(app.device());
  smooth::Flow flow(device, scene.surface, scene.flow);
  const std::string faults = smooth::textOf(flow.faults());
  examples::Verification verification("||b - A x|| / ||b|| of each step, rows scaled by the diagonal",
                                      scene.flow.tolerance, "the tolerance");
  examples::Verification backward("||b - A x|| / (||A|| ||x|| + ||b||) of the other steps",
                                  smooth::mostBackwardError,
                                  "512 roundings of doubles, as entries of thin triangles have them");
  fmt::print("{:>6} {:>12} {:>12} {:>10} {:>10}\n", "step", "volume", "area", "iterations", "residual");
  fmt::print("{:>6} {:>12.6g} {:>12.6g}\n", 0, smooth::volumeOf(scene.surface),
             smooth::areaOf(scene.surface));
  std::int64_t limited = 0;  // steps whose residual stays above the tolerance
  const examples::Stopwatch watch;
  examples::Progress progress("smooth", scene.steps);
  for (std::int64_t i = 1; i <= scene.steps; ++i) {
    const smooth::StepReport report = flow.step();
    progress.clear();
    fmt::print("{:>6} {:>12.6g} {:>12.6g} {:>10} {:>10.2g}\n", i, report.volume, report.area,
               report.iterations, report.residual);
    progress.update(i);
    if (report.backwardError > 0.0) {
      backward.note(i, report.backwardError);
      ++limited;
    } else {
      verification.note(i, report.residual);
    }
  }
  progress.clear();
  app.report(
      fmt::format("{}, {} vertices, {} steps of {:.3g}, layout {}, in {} precision, preconditioned by {}",
                  scene.name, scene.surface.points.size(), scene.steps, scene.flow.timeStep, flow.layout(),
                  flow.precision(), flow.preconditioner()),
      device.name(), watch.milliseconds());
  fmt::print("{}", faults);
  if (!s.obj.empty()) smooth::saveObj(s.obj, flow.surface());
  if (!s.picture.empty()) {
    constexpr int size = 400;
    examples::Image both = examples::plainImage(2 * size, size, {0, 0, 0});
    examples::paste(both, smooth::pictureOf(scene.surface, scene.surface, size), 0, 0);
    examples::paste(both, smooth::pictureOf(flow.surface(), scene.surface, size), size, 0);
    examples::savePng(
        s.picture, examples::figure(both, {.title = scene.name,
                                           .subtitle = "before and after mean-curvature flow",
                                           .footnote = fmt::format("{} vertices, {} steps of {:.3g}",
                                                                   scene.surface.points.size(), scene.steps,
                                                                   scene.flow.timeStep)}));
  }
  if (limited < scene.steps) app.verified(verification);
  if (limited > 0) app.verified(backward);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app("smooth", "Smooths surfaces by implicit mean-curvature flow.");
  CLI::App& cli = app.options();
  cli.add_option("input", settings.input,
                 "a mesh, .obj, or a scene, .toml, as in examples/applications/smooth/scenes");
  cli.add_option("--steps", settings.steps, "in place of the scene's; 10 of a mesh")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}));
  cli.add_option("--time-step", settings.timeStep,
                 "a squared length, in place of the scene's; 0.001 of a mesh")
      ->check(sk::text::realFrom(1e-12, 1e12), "1e-12 to 1e12");
  cli.add_option("--layout", settings.layout, "of the matrix, as solve --layout takes it");
  cli.add_option("--precision", settings.precision,
                 "of the iterations: single, extended, double, or auto for what the matrix needs (default)");
  cli.add_option("--obj", settings.obj, "file for the surface at the end");
  cli.add_option("-o,--output", settings.picture, "picture of the surface before and after, .png");
  const examples::StudyOptions study(app, "measure flows whose solution is known", smooth::studies);
  return app.run(argc, argv, [&] {
    if (study.isGiven()) return study.run();
    if (settings.input.empty())
      throw std::runtime_error("no surface is named; try examples/applications/smooth/scenes/sphere.toml");
    run(app, settings);
  });
}
