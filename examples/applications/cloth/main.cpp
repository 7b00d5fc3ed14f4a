// SPDX-License-Identifier: MIT
//
// cloth: a scene of cloth, bodies and wind from a file; its run in numbers, pictures, a film or a window.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "checks.hpp"
#include "cost.hpp"
#include "drawing.hpp"
#include "obj.hpp"
#include "run.hpp"
#include "scene.hpp"
#include "simulation.hpp"
#include "study.hpp"
#include "support/application.hpp"
#include "support/named.hpp"
#include "support/options.hpp"
#include "support/ranks.hpp"

namespace {

struct Settings {
  std::filesystem::path scene;
  std::string precision = "single";
  std::optional<std::int64_t> steps;
  std::vector<int> points;
  std::optional<int> frames;
  std::string size = "1280x720";
  int samples = 2;
  std::string output;
  bool bare = false;
  std::string csv;
  std::string obj;
  bool window = false;
  std::string study;
  std::int64_t checkedSteps = 100;
  bool compares = true;
};

void addOptions(CLI::App& cli, Settings& s) {
  cli.add_option("scene", s.scene, "a scene, as those in examples/applications/cloth/scenes");
  cli.add_option("--study", s.study,
                 examples::listed("in place of a scene, a table of the numerics:", examples::studies, 10));
  cli.add_option("--precision", s.precision,
                 "what steps are computed in: single, extended or double (default: single)")
      ->check(CLI::IsMember({"single", "extended", "double"}));
  cli.add_option("--steps", s.steps, "in place of the scene's")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 50));
  cli.add_option("--points", s.points, "columns and rows of points, in place of the scene's")
      ->expected(2)
      ->check(CLI::Range(1, 1 << 13));
  cli.add_option("--size", s.size, "of pictures, WIDTHxHEIGHT in pixels (default: 1280x720)");
  cli.add_option("--samples", s.samples, "N x N to a pixel (default: 2)")->check(CLI::Range(1, 8));
  cli.add_option("--frames", s.frames, "in place of the scene's; 1 is a picture of the end")
      ->check(CLI::Range(1, 1'000'000));
  cli.add_option("-o,--output", s.output,
                 "picture or film: .png (numbered where there are many frames), .apng, .gif, .mp4 or .webm");
  cli.add_flag("--bare", s.bare, "pictures without a frame and titles");
  cli.add_flag(
      "--window", s.window,
      "show it live: drag to turn, wheel to come nearer, space to stop, W for wind, R to begin anew");
  cli.add_option("--csv", s.csv, "file for energies, strain and height at each frame");
  cli.add_option("--obj", s.obj, "file for the cloth at the end: .obj, or .vtp (VTK)");
  cli.add_option("--check", s.checkedSteps,
                 "steps to compare with double loops (default: 100, fewer of large cloths)")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40));
  cli.add_flag("--compare,!--no-compare", s.compares,
               "measure the full model beside the scene's (the default)");
}

examples::Scene sceneOf(const Settings& s) {
  if (s.scene.empty())
    throw std::runtime_error(
        "which scene? Name a file, one of examples/applications/cloth/scenes for instance");
  std::optional<examples::Points> points;
  if (!s.points.empty()) points = examples::Points{s.points[0], s.points[1]};
  examples::Scene scene = examples::readScene(s.scene, points);
  if (s.steps) scene.run.steps = *s.steps;
  if (s.frames) scene.record.frames = *s.frames;
  if (!s.output.empty()) scene.record.output = s.output;
  if (!s.csv.empty()) scene.record.csv = s.csv;
  if (!s.obj.empty()) scene.record.obj = s.obj;
  return scene;
}

/// Fewer steps than were asked for, where loops would take many seconds.
std::int64_t stepsToCheck(const examples::Scene& scene, const Settings& s) {
  const double each = static_cast<double>(scene.points()) * (1 + scene.links.iterations);
  const auto affordable = std::max<std::int64_t>(1, static_cast<std::int64_t>(4e6 / each));
  return std::min({s.checkedSteps, scene.run.steps, affordable});
}

examples::PictureSize sizeOf(const std::string& text) {
  const std::vector<std::int64_t> size = examples::extentsOf("--size", text, {16, 8192});
  return {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

/// Films are drawn in the device's own context where it has one.
sk::Device openDevice(const std::string& name, bool isFilmed) {
  sk::Device device(name);
  if (isFilmed && device.profile() != "native") device = sk::Device({.device = name, .sharesContext = true});
  return device;
}

/// A line of the table of numbers.
std::string rowOf(const examples::Simulation& simulation, const examples::Scene& scene,
                  std::int64_t linksAtFirst) {
  const examples::Observation o = simulation.observe();
  return fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}",
                     simulation.step(), static_cast<double>(simulation.step()) * scene.run.dt, o.kinetic,
                     o.elastic, o.potential, o.strain, o.largest, o.centre.x, o.centre.y, o.centre.z,
                     simulation.census().fastest, linksAtFirst - simulation.links());
}

/// The whole of a cloth that is divided over ranks, on the first one's device: what is drawn and observed there has the bits of a
/// cloth on one device.
class WholeCloth {
 public:
  WholeCloth(examples::Simulation& simulation, std::optional<sk::Device>& device,
             const examples::Scene& scene, sk::Precision precision)
      : simulation_(simulation), isDivided_(simulation.space().isDivided()) {
    if (isDivided_ && device) copy_.emplace(*device, scene, simulation.features(), precision);
  }
  /// The cloth as it is now; null on ranks other than the first. Collective.
  examples::Simulation* now() {
    if (!isDivided_) return &simulation_;
    const examples::State state = simulation_.state();
    if (!copy_) return nullptr;
    copy_->restore(state);
    return &*copy_;
  }

 private:
  examples::Simulation& simulation_;
  bool isDivided_;
  std::optional<examples::Simulation> copy_;
};

void runScene(examples::Application& app, const Settings& s) {
  const examples::Scene scene = sceneOf(s);
  const sk::Precision precision = examples::precisionNamed(s.precision);
  const examples::PictureSize size = sizeOf(s.size);
  examples::Ranks& ranks = app.ranks();
  if (s.window) {
    ranks.refuseSeveral("--window", "start it without mpirun, or make a film with --output");
    return examples::runLive(scene, precision, app.device(), size);
  }
  const examples::Features features = examples::Features::of(scene);
  const bool isFilmed = !scene.record.output.empty(), isObserved = !scene.record.csv.empty();
  const auto divided = ranks.divide(app.device(), examples::shapeOf(scene), examples::Ends::Open);
  std::optional<sk::Device> device;
  if (ranks.isFirst()) device = openDevice(app.device(), isFilmed);
  const examples::Space space =
      divided ? examples::Space(*divided) : examples::Space(*device, examples::shapeOf(scene));
  examples::Simulation simulation(space, scene, features, precision);
  WholeCloth whole(simulation, device, scene, precision);

  std::optional<examples::Filming> filming;
  if (isFilmed && device)
    filming.emplace(*device, scene, examples::Look{size, s.samples, !s.bare}, s.precision);
  examples::CsvFile csv(scene.record.csv,
                        "step,time_s,kinetic_J,elastic_J,potential_J,mean_strain,largest_strain,centre_x_m,"
                        "centre_y_m,centre_z_m,fastest_m_per_s,torn_links",
                        ranks.isFirst());
  std::int64_t linksAtFirst = 0;
  const examples::Outcome outcome = examples::run(simulation, scene, [&](int) {
    if (!isFilmed && !isObserved) return;
    examples::Simulation* const now = whole.now();
    if (now && isObserved) {
      if (now->step() == 0) linksAtFirst = now->links();
      csv.add(rowOf(*now, scene, linksAtFirst));
    }
    if (filming) filming->add(*now);
  });
  examples::Simulation again(space, scene, features, precision);
  const std::int64_t checked = stepsToCheck(scene, s);
  again.advance(checked);
  const std::vector<double> positions = again.positions();
  examples::Simulation* const last = whole.now();
  if (last == nullptr) return;

  if (filming) filming->finish(*last);
  if (!scene.record.obj.empty()) {
    last->dress();
    examples::saveMesh(scene.record.obj, scene.cloth.columns, scene.cloth.rows,
                       last->dressedPositions().read(), last->dressedNormals().read());
  }
  app.report(fmt::format("{}, {} x {} points, {} steps in {} precision", scene.title, scene.cloth.columns,
                         scene.cloth.rows, outcome.steps, s.precision),
             examples::placeOf(ranks, space.device().name()), simulation.milliseconds());
  const examples::Observation end = last->observe();
  fmt::print("{:.3g} ms a step; {}mean strain {:.3g}, largest {:.3g}, fastest point {:.3g} m/s\n",
             simulation.milliseconds() / static_cast<double>(std::max<std::int64_t>(1, outcome.steps)),
             outcome.settled ? "settled; " : "", end.strain, end.largest, outcome.fastest);
  if (filming) fmt::print("{}\n", filming->report());
  if (s.compares && ranks.count() == 1)  // costs are those of one device
    fmt::print("{}",
               examples::tableOf(examples::compareWithFull(*device, scene, precision, last->state()), scene));
  app.verified(examples::checkSteps(scene, checked, positions, precision));
  app.verified(examples::checkObservation(scene, end, last->state()));
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app("cloth", "Cloth that hangs, falls, flutters and tears: a scene from a file.",
                            examples::joinRanks());
  addOptions(app.options(), settings);
  return app.run(argc, argv, [&] {
    if (settings.study.empty()) return runScene(app, settings);
    app.ranks().refuseSeveral("--study", "start it without mpirun");
    const examples::Study& study = examples::rowNamed(examples::studies, settings.study, "study");
    sk::Device device(app.device());
    fmt::print("{}", study.run(device, false).table);
  });
}
