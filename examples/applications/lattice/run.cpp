// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "limits.hpp"
#include "painter.hpp"
#include "support/progress.hpp"
#include "support/record.hpp"
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
  Numbers(const std::filesystem::path& path, const Model& model, bool writes)
      : model_(model), file_(path, heads(model), writes) {}

  void add(std::int64_t step, Lattice& lattice) {
    if (!file_.isWanted()) return;
    const double dt =
        model_.reaction && !model_.hasTemperature() ? model_.reaction->timeStep : model_.timeStep;
    std::string row = fmt::format("{},{:.9g}", step, static_cast<double>(step) * dt);
    for (const Field field : fieldsOf(model_)) {
      const Observation o = lattice.observe(field);
      row += fmt::format(",{:.9g},{:.9g},{:.9g}", o.mean, o.least, o.most);
    }
    if (model_.flow) row += fmt::format(",{:.9g},{:.9g}", lattice.nusselt(), lattice.kineticEnergy());
    if (model_.boils()) row += fmt::format(",{:.9g}", lattice.vapour());
    file_.add(row);
  }

 private:
  static std::string heads(const Model& model) {
    std::string head = "step,time";
    for (const Field field : fieldsOf(model)) head += fmt::format(",{0}_mean,{0}_min,{0}_max", nameOf(field));
    if (model.flow) head += ",nusselt,kinetic_energy";
    if (model.boils()) head += ",vapour";
    return head;
  }

  const Model& model_;
  CsvFile file_;
};

/// The text below a picture.
std::string captionOf(const Model& model, std::int64_t step) {
  const Grid& g = model.grid;
  std::string text = g.isSpace() ? fmt::format("{} x {} x {} cells", g.width, g.height, g.depth)
                                 : fmt::format("{} x {} cells", g.width, g.height);
  if (const auto& flow = model.flow)
    text += fmt::format("   Ra = {:g}, Pr = {:g}", flow->rayleigh, flow->prandtl);
  if (const auto& r = model.reaction) text += fmt::format("   F = {:g}, k = {:g}", r->feed, r->kill);
  return text + fmt::format("   step {}", step);
}

GridFile gridFileOf(Lattice& lattice) {
  const Grid& g = lattice.model().grid;
  GridFile file{{g.width, g.height, g.depth}, g.spacing, {}};
  for (const Field field : fieldsOf(lattice.model()))
    file.fields.push_back({std::string(nameOf(field)), 1, lattice.read(field)});
  return file;
}

/// The next multiple of `every` after `step`; never, where it is 0.
std::int64_t nextOf(std::int64_t step, std::int64_t every, std::int64_t never) {
  return every > 0 ? (step / every + 1) * every : never;
}

}  // namespace

void requireFinite(Lattice& lattice, std::int64_t step) {
  for (const Field field : fieldsOf(lattice.model())) {
    if (lattice.observe(field).broken == 0) continue;
    const std::string cell = placeOf(lattice.model().grid, lattice.firstBroken(field));
    throw std::runtime_error(fmt::format("step {}: {} is not finite in cell {}; what was made before is kept",
                                         step, nameOf(field), cell));
  }
}

BytesPerCell memoryFor(const Scene& scene, bool hasAccount) {
  const auto fields = static_cast<double>(fieldsOf(scene.model).size());
  // Measuring a change keeps both states; the account makes a lattice of the model and one of all operators.
  double streams = Lattice::streamsOf(scene.model) + (scene.settling ? fields : 0.0);
  if (hasAccount) streams += Lattice::streamsOf(scene.model) + Lattice::streamsOf(fullModel(scene.model));
  // The last two states, the exact one, and what a field is read through.
  return {.device = streams * Lattice::bytesOf(scene.model.precision), .host = (3.0 * fields + 1.0) * 8.0};
}

Outcome runScene(const Scene& scene, Lattice& lattice) {
  sk::Device& device = lattice.space().device();
  Outcome outcome;
  const std::int64_t steps = scene.steps;
  const std::int64_t every =
      scene.csvInterval > 0 ? scene.csvInterval : std::max<std::int64_t>(1, steps / 100);
  const bool isFirst = lattice.space().isFirst();
  Painter painter(device, scene);
  Frames pictures(scene.record, isFirst);
  Numbers numbers(scene.record.csv, scene.model, isFirst);
  numbers.add(0, lattice);
  Progress progress(scene.name, steps);
  const auto addPicture = [&](std::int64_t step) {
    pictures.add([&] { return painter.paint(lattice, captionOf(scene.model, step)); },
                 [&] { return gridFileOf(lattice); });
  };
  requireFinite(lattice, 0);
  if (pictures.wantsStart()) addPicture(0);
  std::int64_t step = 0;
  while (step < steps && !outcome.settled) {
    const std::int64_t never = steps;
    const std::int64_t check = scene.settling ? nextOf(step, scene.settling->every, never) : never;
    std::int64_t end = std::min({steps, step + 4096, nextOf(step, every, never), check});
    if (pictures.isWanted()) end = std::min(end, std::max(pictures.nextStep(steps), step + 1));

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

    const bool isEnd = step == steps || outcome.settled;
    const bool frameDue = pictures.isDue(step, steps) ||
                          (isEnd && pictures.isWanted() && scene.record.frames == 1 && pictures.count() == 0);
    if (step % every == 0 || frameDue || isEnd) requireFinite(lattice, step);
    if (step % every == 0 || isEnd) numbers.add(step, lattice);
    if (frameDue) {
      progress.clear();
      addPicture(step);
    }
    if (isFirst) progress.update(step);
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
