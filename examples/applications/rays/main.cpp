// SPDX-License-Identifier: MIT
//
// rays: pictures and hits of scene files, by the engine that the scene asks for.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "account.hpp"
#include "camera.hpp"
#include "engine.hpp"
#include "exposure.hpp"
#include "hits_file.hpp"
#include "layers.hpp"
#include "light_table.hpp"
#include "reference.hpp"
#include "render.hpp"
#include "scene.hpp"
#include "study.hpp"
#include "support/application.hpp"
#include "support/named.hpp"
#include "support/options.hpp"
#include "support/ranks.hpp"
#include "support/stopwatch.hpp"
#include "text/real_option.hpp"

namespace {

struct Settings {
  std::filesystem::path scene;
  std::string size;
  std::string engine;
  std::filesystem::path hits;
  std::filesystem::path rays;
  std::optional<std::filesystem::path> output;
  std::optional<std::int64_t> samples;
  std::optional<double> seconds;
  std::optional<double> error;
  std::filesystem::path resume;
  std::string layers;
  bool strict = false;
  bool window = false;
  bool account = false;
};

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("scene", s.scene, "what to see: a TOML file, as in examples/applications/rays/scenes");
  cli.add_option("--engine", s.engine, examples::listed("in place of the scene's:", rays::engineKinds(), 11));
  cli.add_option("--size", s.size, "pixels, WxH, in place of the scene's");
  cli.add_option("--samples", s.samples, "for each pixel, in place of the scene's")
      ->check(CLI::Range(1, 1'000'000));
  cli.add_option("--seconds", s.seconds, "end after this time, whatever samples there are")
      ->check(sk::text::realFrom(0, 1e7), "0 to 1e7");
  cli.add_option("--error", s.error,
                 "stop pixels whose 95 % interval is within this part of their brightness; 0: none; in place "
                 "of the scene's")
      ->check(sk::text::realFrom(0, 1), "0 to 1");
  cli.add_option(
      "--resume", s.resume,
      "go on from this file where it exists, and keep it up to date; to the bit as without a break");
  cli.add_option("--output", s.output, "the picture, .png, .pfm or .exr, in place of the scene's");
  cli.add_option("--hits", s.hits,
                 "no picture: write x,y,id,t,u,v of the rays through the pixels' centres to this file");
  cli.add_option("--trace", s.rays,
                 "with --hits: the rays of this file, lines of ox oy oz dx dy dz [tmin tmax]; hits count "
                 "from tmin on, and before "
                 "tmax");
  cli.add_option("--layers", s.layers,
                 "write FILE_depth.pfm, _normal.pfm, _albedo.pfm, _id.pfm, _variance.pfm and _samples.pfm "
                 "beside the picture");
  cli.add_flag(
      "--window", s.window,
      "show it in a window while it becomes better: the mouse turns it, the wheel; space, r, +, -, q");
  cli.add_flag("--account", s.account,
               "measure what it saves that kernels have nothing that the scene does not name");
  cli.add_flag("--strict", s.strict, "vertices that are not finite are an error");
}

/// Prints what all ranks have to say once.
void warn(const examples::Ranks& ranks, std::string_view warning) {
  if (ranks.isFirst()) fmt::print(stderr, "rays: warning: {}\n", warning);
}

rays::Scene sceneOf(const Settings& s, const examples::Ranks& ranks) {
  rays::Overrides overrides{
      .samples = s.samples, .seconds = s.seconds, .engine = s.engine, .strict = s.strict, .error = s.error};
  if (!s.size.empty()) {
    const std::vector<std::int64_t> size = examples::extentsOf("--size", s.size, {0, 32768});
    overrides.width = static_cast<int>(size[0]);
    overrides.height = static_cast<int>(size[1]);
  }
  rays::Scene scene = rays::readScene(s.scene, overrides);
  if (s.output) scene.output.picture = *s.output;
  for (const std::string& warning : scene.warnings) warn(ranks, warning);
  return scene;
}

std::unique_ptr<rays::Engine> engineOf(sk::Device& device, const rays::Scene& scene,
                                       const examples::Ranks& ranks) {
  std::unique_ptr<rays::Engine> engine = scene.engines.at(scene.engine)(device, scene.model);
  for (const std::string& warning : engine->warnings()) warn(ranks, warning);
  return engine;
}

void writeHits(examples::Application& app, const Settings& s, const rays::Scene& scene) {
  app.ranks().refuseSeveral("--hits", "start it without mpirun");
  sk::Device device(app.device());
  const std::unique_ptr<rays::Engine> engine = engineOf(device, scene, app.ranks());
  const bool fromFile = !s.rays.empty();
  const rays::Picture& picture = scene.picture;
  const examples::Stopwatch stopwatch;
  std::vector<rays::Hit> hits;
  if (fromFile) {
    hits = rays::traceRays(*engine, scene.model, rays::loadRays(s.rays));
  } else {
    hits = rays::hitsOf(*engine, rays::primaryRays(scene.model.camera, picture.width, picture.height));
    rays::toSceneLengths(scene.model, hits);
  }
  rays::saveHits(s.hits, hits, fromFile ? 0 : std::max(picture.width, 1));
  app.report(fmt::format("{}, {} rays", scene.name, hits.size()), device.name(), stopwatch.milliseconds());
  for (const std::string& line : engine->account()) fmt::print("{}\n", line);
  fmt::print("wrote {}\n", s.hits.string());
  if (!fromFile && !hits.empty())
    app.verified(rays::checkEngine(*engine, engine->model(), picture.width, picture.height));
}

/// How many samples pixels took, and what stopping early saved.
std::string samplesText(const rays::Rendering& rendering, const rays::Scene& scene) {
  std::string text;
  if (rendering.resumed > 0) text += fmt::format("went on from sample {}; ", rendering.resumed);
  if (scene.output.error == 0.0) return text + fmt::format("{} samples in each pixel", rendering.samples);
  const auto pixels = double(scene.picture.width) * scene.picture.height;
  return text + fmt::format(
                    "{:.1f} samples a pixel on average and {} at most, {:.0f} % fewer than {} everywhere; "
                    "{:.1f} % of the pixels "
                    "may be off by more than {}",
                    rendering.perPixel, rendering.samples,
                    100 * (1 - rendering.perPixel / double(rendering.samples)), rendering.samples,
                    100 * double(rendering.unfinished) / pixels, scene.output.error);
}

/// What ranks cannot decide together: each has its own clock, and pixels that stop are in a list of all of them.
void refuseForRanks(const examples::Ranks& ranks, const Settings& s, const rays::Output& output) {
  if (output.seconds > 0) ranks.refuseSeveral("'seconds'", "give --seconds 0, and --samples");
  if (output.error > 0) ranks.refuseSeveral("'error'", "give --error 0");
  if (!s.resume.empty()) ranks.refuseSeveral("--resume", "leave it out, or start it without mpirun");
  if (s.account) ranks.refuseSeveral("--account", "leave it out, or start it without mpirun");
}

void makePicture(examples::Application& app, const Settings& s, rays::Scene& scene) {
  rays::checkOutput(scene);
  examples::Ranks& ranks = app.ranks();
  refuseForRanks(ranks, s, scene.output);
  std::unique_ptr<examples::DividedGrid> grid;
  if (ranks.count() > 1)
    grid = ranks.divide(app.device(), {scene.picture.height, scene.picture.width}, examples::Ends::Open);
  scene.picture.grid = grid.get();
  std::optional<sk::Device> own;
  sk::Device& device = grid ? grid->device() : own.emplace(app.device());
  const std::unique_ptr<rays::Engine> engine = engineOf(device, scene, ranks);
  const rays::Picture& picture = scene.picture;
  const std::unique_ptr<rays::Renderer> renderer = engine->renderer(picture);
  const rays::Rendering rendering = rays::render(*renderer, scene, {s.resume, device.name()});
  const bool isExr = scene.output.picture.extension() == ".exr";
  const bool hasLayers = isExr || !s.layers.empty();
  std::vector<rays::Layer> gathered;
  if (hasLayers) gathered = rays::layersOf(renderer->exposure());
  if (!ranks.isFirst()) return;
  const bool isBlack = std::ranges::all_of(
      rendering.radiance, [](const sk::float3& r) { return r.x == 0 && r.y == 0 && r.z == 0; });
  if (isBlack && !rays::hasLight(scene.model))
    fmt::print(stderr,
               "rays: warning: the picture is black, because the scene has no light; add a [[light]], an "
               "[environment] or a material with 'emission'\n");
  else if (isBlack && rays::seesBacksAlone(*engine, engine->model()))
    fmt::print(stderr,
               "rays: warning: the picture is black, and the camera sees nothing but the backs of surfaces; "
               "is it inside of a wall?\n");
  std::vector<rays::Layer> layers;
  if (hasLayers) layers = rays::layersOf(*engine, engine->model(), picture);
  for (rays::Layer& layer : gathered) layers.push_back(std::move(layer));
  rays::saveRendering(rendering, scene, layers);
  app.report(
      fmt::format("{}, {} x {}, {} samples", scene.name, picture.width, picture.height, rendering.samples),
      examples::placeOf(ranks, device.name()), rendering.milliseconds);
  for (const std::string& line : engine->account()) fmt::print("{}\n", line);
  for (const std::string& line : renderer->account()) fmt::print("{}\n", line);
  fmt::print("{}\n", samplesText(rendering, scene));
  fmt::print("wrote {}{}\n", scene.output.picture.string(),
             isExr ? fmt::format(" with {} layers", layers.size()) : "");
  if (!s.resume.empty()) fmt::print("wrote {}, from which more samples can go on\n", s.resume.string());
  if (!s.layers.empty()) {
    rays::saveLayers(s.layers, layers, picture);
    fmt::print("wrote {} layers, {}_*.pfm\n", layers.size(), s.layers);
  }
  app.verified(rays::checkEngine(*engine, engine->model(), picture.width, picture.height));
  if (!s.account) return;
  const rays::Account account = rays::accountFor(*engine, scene);
  fmt::print("{}\n", account.text);
  app.verified(account.agreement);
}

void showPicture(examples::Application& app, const Settings& s, rays::Scene& scene) {
  app.ranks().refuseSeveral("--window", "start it without mpirun");
  if (!s.resume.empty())
    throw std::runtime_error("--window and --resume exclude each other: a window is not resumed");
  rays::checkOutput(scene);
  rays::runLive(scene, app.device());
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app("rays", "Pictures and hits of scene files by tracing rays.",
                            examples::joinRanks());
  addOptions(app.options(), settings);
  const examples::StudyOptions study(app, "measure what choices are worth", rays::studies);
  return app.run(argc, argv, [&] {
    if (study.isGiven()) return study.run();
    if (settings.scene.empty())
      throw std::runtime_error("no scene is named; try examples/applications/rays/scenes/cornell.toml");
    if (!settings.rays.empty() && settings.hits.empty())
      throw std::runtime_error("--trace needs --hits, where its hits go");
    try {
      rays::Scene scene = sceneOf(settings, app.ranks());
      if (!settings.hits.empty()) return writeHits(app, settings, scene);
      if (settings.window) return showPicture(app, settings, scene);
      makePicture(app, settings, scene);
    } catch (const std::bad_alloc&) {
      throw std::runtime_error("the scene does not fit in memory; take smaller meshes or fewer instances");
    }
  });
}
