// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "painter.hpp"
#include "support/figure.hpp"
#include "support/film.hpp"
#include "support/progress.hpp"
#include "support/stopwatch.hpp"

namespace waves {

namespace {

class Pictures {
 public:
  Pictures(sk::Device& device, const Scene& scene) : scene_(scene) {
    const std::filesystem::path& output = scene.record.output;
    if (output.empty()) return;
    painter_ = std::make_unique<Painter>(device, scene);
    if (scene.record.frames > 1 || output.extension() != ".png")
      film_ = std::make_unique<examples::Film>(output, scene.record.framesPerSecond);
  }

  void add(const Surface& surface) {
    if (!painter_) return;
    const Model& m = scene_.model;
    const std::string moment =
        fmt::format("{} x {} cells   {}   Courant number {:.3g}   step {}   time {:.3g}", m.width, m.height,
                    schemeNames()[static_cast<std::size_t>(m.scheme)], std::sqrt(m.lambdaSquared()),
                    surface.steps(), surface.time());
    const examples::Image image = examples::figure(painter_->paint(surface), {scene_.title, "", moment});
    if (film_)
      film_->add(image);
    else
      examples::savePng(scene_.record.output, image);
    ++count_;
  }
  void finish() {
    if (film_ && count_ > 0) film_->finish();
  }
  int count() const { return count_; }

 private:
  const Scene& scene_;
  std::unique_ptr<Painter> painter_;
  std::unique_ptr<examples::Film> film_;
  int count_ = 0;
};

class Numbers {
 public:
  explicit Numbers(const std::filesystem::path& path) : path_(path.string()) {
    if (path.empty()) return;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
    file_.open(path);
    write("step,time,iterations,residual,energy");
  }
  void add(const Step& s, const Surface& surface) {
    if (path_.empty()) return;
    write(fmt::format("{},{:.9g},{},{:.4g},{:.9g}", surface.steps(), surface.time(), s.iterations, s.residual,
                      surface.energy()));
  }

 private:
  void write(const std::string& row) {
    if (!(file_ << row << '\n').flush()) throw std::runtime_error(fmt::format("cannot write '{}'", path_));
  }
  std::string path_;
  std::ofstream file_;
};

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

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

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
  v.note(0, distance(here.heights(), there.heights()) / std::max(step.length, 1e-300));
  return v;
}

}  // namespace

Outcome run(sk::Device& device, const Scene& scene) {
  const Model& m = scene.model;
  Outcome outcome;
  Surface surface(device, m);
  Energies energies(surface);
  Pictures pictures(device, scene);
  Numbers numbers(scene.record.csv);
  const int frames = scene.record.frames;
  int frame = 1;
  auto drop = scene.drops.begin();
  std::vector<double> heights, velocities;
  {
    examples::Progress progress(scene.name, scene.steps);
    for (std::int64_t i = 1; i <= scene.steps; ++i) {
      const bool isLast = i == scene.steps;
      if (drop != scene.drops.end() && drop->time <= surface.time()) {
        energies.end();
        heights = surface.heights();
        for (; drop != scene.drops.end() && drop->time <= surface.time(); ++drop) add(*drop, m, heights);
        surface.writeHeights(heights);
        energies.begin();
      }
      if (frames > 1 && i == 1) pictures.add(surface);
      if (isLast) {
        heights = surface.heights();
        velocities = surface.velocities();
      }
      Step step;
      const examples::Stopwatch watch;
      try {
        step = surface.step();
      } catch (...) {
        pictures.finish();  // what there is stays, as a whole file
        throw;
      }
      device.finish();
      outcome.milliseconds += watch.milliseconds();
      energies.add(step);
      outcome.iterations += step.iterations;
      outcome.mostIterations = std::max(outcome.mostIterations, step.iterations);
      outcome.residual = std::max(outcome.residual, step.residual);
      outcome.missed += step.reached ? 0 : 1;
      numbers.add(step, surface);
      if (frames > 1 ? frame < frames && scene.steps * frame / (frames - 1) <= i : isLast) {
        progress.clear();
        pictures.add(surface);
        ++frame;
      }
      progress.update(i);
    }
  }
  pictures.finish();
  energies.end();
  outcome.steps = surface.steps();
  outcome.time = surface.time();
  outcome.pictures = pictures.count();
  outcome.residualLast = surface.residualInDouble();
  outcome.energy = surface.energy();
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
