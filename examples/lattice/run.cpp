// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "limits.hpp"
#include "painter.hpp"
#include "support/film.hpp"
#include "support/image.hpp"
#include "support/progress.hpp"
#include "support/stopwatch.hpp"

namespace examples {
namespace {

std::string placeOf(const Grid& g, std::int64_t cell) {
  const std::int64_t x = cell % g.width, y = cell / g.width % g.height, z = cell / (g.width * g.height);
  return g.isSpace() ? fmt::format("({}, {}, {})", x, y, z) : fmt::format("({}, {})", x, y);
}

/// Rows of numbers, reduced on the device.
class Numbers {
 public:
  Numbers(const std::filesystem::path& path, const Model& model)
      : model_(model), path_(path.string()), file_(path) {
    std::string head = "step,time";
    for (const Field field : fieldsOf(model)) {
      const char* name = nameOf(field);
      head += fmt::format(",{0}_mean,{0}_min,{0}_max", name);
    }
    if (model.flow) head += ",nusselt,kinetic_energy";
    if (model.boils()) head += ",vapour";
    write(head);
  }

  void add(std::int64_t step, Lattice& lattice) {
    const double dt =
        model_.reaction && !model_.hasTemperature() ? model_.reaction->timeStep : model_.timeStep;
    std::string row = fmt::format("{},{:.9g}", step, static_cast<double>(step) * dt);
    for (const Field field : fieldsOf(model_)) {
      const Observation o = lattice.observe(field);
      row += fmt::format(",{:.9g},{:.9g},{:.9g}", o.mean, o.least, o.most);
    }
    if (model_.flow) row += fmt::format(",{:.9g},{:.9g}", lattice.nusselt(), lattice.kineticEnergy());
    if (model_.boils()) row += fmt::format(",{:.9g}", lattice.vapour());
    write(row);
  }

 private:
  void write(const std::string& row) {
    if (!(file_ << row << '\n').flush()) throw std::runtime_error(fmt::format("cannot write '{}'", path_));
  }

  const Model& model_;
  std::string path_;
  std::ofstream file_;
};

/// Pictures where the scene wants some.
class Pictures {
 public:
  Pictures(sk::Device& device, const Scene& scene) : scene_(scene), painter_(device, scene) {
    if (scene.record.output.empty()) return;
    if (scene.record.frames > 1 || scene.record.output.extension() != ".png")
      film_ = std::make_unique<Film>(scene.record.output, scene.record.framesPerSecond);
  }

  void add(std::int64_t step, Lattice& lattice) {
    if (scene_.record.output.empty()) return;
    const Image image = painter_.paint(lattice, moment(step));
    if (film_)
      film_->add(image);
    else
      savePng(scene_.record.output, image);
    ++count_;
  }
  void finish() {
    if (film_ && count_ > 0) film_->finish();
  }
  int count() const { return count_; }

 private:
  std::string moment(std::int64_t step) const {
    const Grid& g = scene_.model.grid;
    std::string text = g.isSpace() ? fmt::format("{} x {} x {} cells", g.width, g.height, g.depth)
                                   : fmt::format("{} x {} cells", g.width, g.height);
    if (const auto& flow = scene_.model.flow)
      text += fmt::format("   Ra = {:g}, Pr = {:g}", flow->rayleigh, flow->prandtl);
    if (const auto& r = scene_.model.reaction) text += fmt::format("   F = {:g}, k = {:g}", r->feed, r->kill);
    return text + fmt::format("   step {}", step);
  }

  const Scene& scene_;
  Painter painter_;
  std::unique_ptr<Film> film_;
  int count_ = 0;
};

/// The next multiple of `every` after `step`; never, where it is 0.
std::int64_t nextOf(std::int64_t step, std::int64_t every, std::int64_t never) {
  return every > 0 ? (step / every + 1) * every : never;
}

}  // namespace

void requireFinite(Lattice& lattice, std::int64_t step) {
  for (const Field field : fieldsOf(lattice.model())) {
    const Observation o = lattice.observe(field);
    if (o.broken < 0) continue;
    throw std::runtime_error(fmt::format("step {}: {} is not finite in cell {}; what was made before is kept",
                                         step, nameOf(field), placeOf(lattice.model().grid, o.broken)));
  }
}

Outcome runScene(sk::Device& device, const Scene& scene, Lattice& lattice) {
  Outcome outcome;
  const std::int64_t steps = scene.steps;
  const int frames = scene.record.frames;
  const std::int64_t every =
      scene.record.every > 0 ? scene.record.every : std::max<std::int64_t>(1, steps / 100);
  Pictures pictures(device, scene);
  std::unique_ptr<Numbers> numbers;
  if (!scene.record.csv.empty()) {
    numbers = std::make_unique<Numbers>(scene.record.csv, scene.model);
    numbers->add(0, lattice);
  }
  Progress progress(scene.name, steps);
  const auto checkFinite = [&](std::int64_t at) {
    try {
      requireFinite(lattice, at);
    } catch (...) {
      pictures.finish();  // what there is stays, as a whole file
      throw;
    }
  };
  checkFinite(0);
  if (frames > 1) pictures.add(0, lattice);
  const auto frameStep = [&](int frame) { return frames > 1 ? steps * frame / (frames - 1) : steps; };
  int frame = 1;
  std::int64_t step = 0;
  while (step < steps && !outcome.settled) {
    const std::int64_t never = steps;
    const std::int64_t check = scene.settling ? nextOf(step, scene.settling->every, never) : never;
    std::int64_t end = std::min({steps, step + 4096, nextOf(step, every, never), check});
    while (frame < frames && frameStep(frame) <= step) ++frame;
    if (frame < frames) end = std::min(end, std::max(frameStep(frame), step + 1));

    const Stopwatch stopwatch;
    const bool isLast = end == steps;
    const bool measures = scene.settling && end == check;
    const std::int64_t plain = end - step - (isLast || measures ? 1 : 0);
    lattice.advance(plain);
    if (isLast) {
      device.finish();
      outcome.milliseconds += stopwatch.milliseconds();
      outcome.beforeLast = readState(lattice);
    }
    const Stopwatch rest;
    if (measures) {
      outcome.change = lattice.advanceAndMeasure();
      outcome.settled = outcome.change <= scene.settling->tolerance;
      ++outcome.checks;
    } else if (isLast) {
      lattice.advance(1);
    }
    device.finish();
    outcome.milliseconds += (isLast ? rest : stopwatch).milliseconds();
    step = end;

    const bool frameDue = frame < frames && frameStep(frame) == step;
    if (step % every == 0 || frameDue || step == steps || outcome.settled) checkFinite(step);
    if (numbers && (step % every == 0 || step == steps || outcome.settled)) numbers->add(step, lattice);
    if (frameDue || ((step == steps || outcome.settled) && frames == 1)) {
      progress.clear();
      pictures.add(step, lattice);
    }
    progress.update(step);
  }
  if (outcome.beforeLast.empty()) {
    outcome.beforeLast = readState(lattice);
    lattice.advance(1);
    ++step;
  }
  outcome.last = readState(lattice);
  pictures.finish();
  outcome.steps = step;
  outcome.frames = pictures.count();
  return outcome;
}

}  // namespace examples
