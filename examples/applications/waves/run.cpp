// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "painter.hpp"
#include "support/figure.hpp"
#include "support/record.hpp"
#include "support/stopwatch.hpp"

namespace waves {

namespace {

examples::Image pictureOf(Painter& painter, const Scene& scene, const Surface& surface) {
  const Model& m = scene.model;
  const std::string moment = fmt::format("{} x {} cells   {}   Courant number {:.3g}   step {}   time {:.3g}",
                                         m.width, m.height, schemeNames[static_cast<std::size_t>(m.scheme)],
                                         std::sqrt(m.lambdaSquared()), surface.steps(), surface.time());
  const examples::Image water = painter.paint(surface);
  return surface.space().isFirst() ? examples::figure(water, {scene.title, "", moment}) : water;
}

examples::GridFile gridFileOf(const Surface& surface) {
  const Model& m = surface.model();
  return {{m.width, m.height, 1},
          m.spacing,
          {{"height", 1, surface.heights()}, {"velocity", 1, surface.velocities()}}};
}

/// The energy between drops, each of which begins a stretch of its own.
class Energies {
 public:
  explicit Energies(const Surface& surface) : surface_(surface), start_(surface.energy()) {}
  /// Before a drop falls.
  void end() { drift_ += surface_.energy() - start_; }
  /// After it.
  void begin() { start_ = surface_.energy(); }
  void add(const Step& step) { bound_ += surface_.energyBound(step, start_); }
  double drift() const { return drift_; }
  double bound() const { return bound_; }

 private:
  const Surface& surface_;
  double start_, drift_ = 0.0, bound_ = 0.0;
};

/// One step from the same state on the device and in double precision on the host.
examples::Verification checkStep(sk::Device& device, const Model& model, const std::vector<double>& heights,
                                 const std::vector<double>& velocities) {
  Model precise = model;
  precise.precision = sk::Precision::Double;
  precise.tolerance = 1e-3 * model.tolerance;
  precise.mostIterations = 4 * model.mostIterations;
  sk::Device reference = sk::Device::reference();
  Surface here(device, model), there(reference, precise);
  for (Surface* s : {&here, &there}) {
    s->writeHeights(heights);
    s->writeVelocities(velocities);
  }
  const Step step = here.step();
  there.step();
  // ||A^-1|| is 1, so that w is off by at most its residual, and the new heights by 1 / theta times that.
  examples::Verification v(
      "a step's heights against double precision, 2-norm",
      (std::max(model.tolerance, model.attainable()) + 8.0 * model.roundoff()) / model.theta(),
      "the tolerance over theta, since the inverse of the matrix has the norm 1, and roundings");
  v.note(0, examples::distance(here.heights(), there.heights()) / std::max(step.length, 1e-300));
  return v;
}

}  // namespace

examples::BytesPerCell memoryFor(const Model& model) {
  // Vectors of a surface and of its conjugate gradients; the check makes another two surfaces, one of them in doubles on the host. Heights and velocities are read to the host.
  constexpr double vectors = 8 + 4, hostVectors = 6;
  const double bytes = model.precision == sk::Precision::Double ? 8.0 : 4.0;
  return {.device = 2.0 * vectors * bytes, .host = (vectors + hostVectors) * 8.0};
}

Outcome run(const linear::Space& space, const Scene& scene) {
  const Model& m = scene.model;
  sk::Device& device = space.device();
  const bool isFirst = space.isFirst();
  Outcome outcome;
  Surface surface(space, m);
  if (!scene.heights.empty()) surface.writeHeights(isFirst ? scene.heights : std::vector<double>());
  Energies energies(surface);
  std::optional<Painter> painter;
  if (!scene.record.output.empty()) painter.emplace(device, scene);
  auto drop = scene.drops.begin();
  std::vector<double> heights, velocities;
  const auto dropWhatIsDue = [&] {
    const auto isDue = [&] { return drop != scene.drops.end() && drop->time <= surface.time(); };
    if (!isDue()) return;
    energies.end();
    heights = surface.heights();
    for (; isDue(); ++drop)
      if (isFirst) add(*drop, m, heights);
    surface.writeHeights(heights);
    energies.begin();
  };
  Step last{};
  const auto step = [&](std::int64_t i) {
    dropWhatIsDue();
    if (i == scene.steps) {
      heights = surface.heights();
      velocities = surface.velocities();
    }
    outcome.milliseconds += examples::millisecondsOf(device, [&] { last = surface.step(); });
    energies.add(last);
    outcome.iterations += last.iterations;
    outcome.mostIterations = std::max(outcome.mostIterations, last.iterations);
    outcome.residual = std::max(outcome.residual, last.residual);
    outcome.missed += last.reached ? 0 : 1;
  };
  const auto row = [&] {  // all ranks must come here, for the energy
    return fmt::format("{},{:.9g},{},{:.4g},{:.9g}", surface.steps(), surface.time(), last.iterations,
                       last.residual, surface.energy());
  };
  dropWhatIsDue();  // so that the first picture has what falls at the start
  outcome.pictures = examples::runRecorded(
      {scene.name, scene.steps, scene.record, isFirst, "step,time,iterations,residual,energy", step, row,
       [&] { return pictureOf(*painter, scene, surface); }, [&] { return gridFileOf(surface); }});
  energies.end();
  outcome.steps = surface.steps();
  outcome.time = surface.time();
  outcome.residualLast = surface.residualInDouble();
  outcome.energy = surface.energy();
  if (!isFirst) return outcome;
  const double scale = std::max(outcome.energy, 1e-300);
  outcome.drift = energies.drift() / scale;
  outcome.driftBound = energies.bound() / scale;

  examples::Verification residual("||b - A w|| / ||b|| of the last step, in double precision",
                                  std::max(m.tolerance, m.attainable()) + m.attainable(),
                                  "the tolerance, and rounding the terms of the residual");
  residual.note(outcome.steps, outcome.residualLast);
  outcome.verifications.push_back(residual);
  if (m.scheme == Scheme::CrankNicolson) {
    examples::Verification energy(
        "change of the energy", outcome.driftBound,
        "8 Courant numbers times the residual over the energy's root, summed over all steps");
    energy.note(outcome.steps, std::abs(outcome.drift));
    outcome.verifications.push_back(energy);
  }
  outcome.verifications.push_back(checkStep(device, m, heights, velocities));
  return outcome;
}

}  // namespace waves
