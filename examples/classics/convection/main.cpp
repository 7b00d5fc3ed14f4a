// SPDX-License-Identifier: MIT
//
// Finds where rolls set in, on the device and by the linear theory of the map, and runs three lattices far beyond.
#include <cmath>
#include <numbers>
#include <random>

#include "classics/support/classic.hpp"
#include "convection.sk.hpp"
#include "support/vec.hpp"

namespace {

using Cell = examples::Vec<double>;  ///< v is x and y, E is z

constexpr classics::Classic about{"convection", "Yanagita, Kaneko 1993", "cells along a plate", 192, 32, 384};
constexpr convection::Fluid papers{.c = 0.5f, .lambda = 0.4f, .nu = 0.2f, .eta = 0.15f, .along = 0.5f};
constexpr convection::Fluid gradient{.c = 0.5f, .lambda = 0.2f, .nu = 0.05f, .eta = 0.4f, .along = 1};
constexpr double visible = 3e-5;  ///< speed of a wave that floats can tell from rest

/// A lattice in double, whose step is plain loops. It begins at rest and conducts heat.
struct Lattice {
  int width, height;  ///< rows are 0 to height
  std::vector<Cell> cells;
  Lattice(int w, int h, double deltaT) : width(w), height(h) {
    for (int y = 0; y <= h; ++y) cells.insert(cells.end(), w, {0, 0, (0.5 - double(y) / h) * deltaT});
  }
  Cell& at(int x, int y) { return cells[y * width + (x + width) % width]; }
  void forEach(const auto& body) {  // but in the plates
    for (int i = width; i < width * height; ++i) body(i % width, i / width);
  }
  void step(const convection::Fluid& f) {
    forEach([&](int x, int y) { at(x, y).y += f.c * (at(x, y).z - (at(x - 1, y).z + at(x + 1, y).z) / 2); });
    std::vector<Cell> particles;
    forEach([&](int x, int y) {
      const Cell here = at(x, y), sideways = at(x - 1, y) + at(x + 1, y) - 2.0 * here;
      const Cell upright = at(x, y - 1) + at(x, y + 1) - 2.0 * here, laplacian = 0.25 * (sideways + upright);
      const Cell mixed = 0.25 * (at(x + 1, y + 1) + at(x - 1, y - 1) - at(x - 1, y + 1) - at(x + 1, y - 1));
      particles.push_back({here.x + f.nu * laplacian.x + f.eta * (f.along * sideways.x + mixed.y),
                           here.y + f.nu * laplacian.y + f.eta * (f.along * upright.y + mixed.x),
                           here.z + f.lambda * laplacian.z});
    });
    forEach([&](int x, int y) { at(x, y) = {}; });
    forEach([&](int x, int y) {
      const Cell& p = particles[(y - 1) * width + x];
      for (const int corner : {0, 1, 2, 3}) {
        const int toX = int(std::floor(x + p.x)) + corner % 2, toY = int(std::floor(y + p.y)) + corner / 2;
        const double share = (1 - std::abs(x + p.x - toX)) * (1 - std::abs(y + p.y - toY));
        if (toY > 0 && toY < height) at(toX, toY) += share * p;
      }
    });
  }
  double speed() const {
    double sum = 0;
    for (const Cell& c : cells) sum += c.x * c.x + c.y * c.y;
    return std::sqrt(sum / double(cells.size()));
  }
};

/// Power iteration: adds to a lattice at rest the wave, as long as the lattice, that grows fastest. Returns its growth, in % in 1000 steps.
double addWave(const convection::Fluid& f, Lattice& l) {
  const Lattice rest = l;
  const double k = std::numbers::pi / l.height;
  l.forEach([&](int x, int y) { l.at(x, y).y = 1e-6 * std::cos(k * x) * std::sin(k * y); });
  for (int n = 0; n < 0.7 * l.height * l.height / f.nu; ++n) l.step(f);  // viscosity ends other waves
  const double before = l.speed();
  l.step(f);
  const double after = l.speed();
  for (std::size_t i = 0; i < l.cells.size(); ++i)
    l.cells[i] = rest.cells[i] + visible / after * (l.cells[i] - rest.cells[i]);
  return 1e5 * std::log(after / before);
}

sk::Stream<sk::float3> streamOf(sk::Device& device, const std::vector<Lattice>& lattices) {
  std::vector<sk::float3> cells;
  for (const Lattice& l : lattices)
    for (const Cell& c : l.cells) cells.push_back(examples::toFloat3(c));
  auto stream = device.stream<sk::float3>({int(lattices.size()), lattices[0].height + 1, lattices[0].width});
  stream.write(cells);
  return stream;
}

void advance(sk::Device& device, const convection::Fluid& f, int steps, std::vector<Lattice>& lattices) {
  auto cell = streamOf(device, lattices);
  sk::Loop step = device.record([&] {
    convection::buoyancy(f, cell, cell);
    convection::heatDiffusion(f, cell, cell);
    convection::viscosityAndPressure(f, cell, cell);
    convection::lagrangian(cell, cell);
  });
  step.repeat(steps);
  const std::vector<sk::float3> values = cell.read();
  auto value = values.begin();
  for (Lattice& l : lattices)
    for (Cell& c : l.cells) c = examples::vecOf<double>(*value++);
}

void onset(classics::Run& run, const char* name, const convection::Fluid& f, int height, double near) {
  std::vector<Lattice> lattices;
  std::vector<double> theory, growth;
  for (const double part : {0.8, 0.95, 1.05, 1.2})
    theory.push_back(addWave(f, lattices.emplace_back(2 * height, height, part * near)));
  advance(run.device(), f, 300, lattices);
  for (const Lattice& l : lattices) growth.push_back(1e5 / 300 * std::log(l.speed() / visible));
  const auto zero = [&](const auto& g) { return (0.95 + 0.1 * g[1] / (g[1] - g[2])) * near; };
  const double deltaT = zero(growth), lift = f.c * (1 - std::cos(std::numbers::pi / height));
  run.say("{}, {} high: growth {:+.1f}, theory {:+.1f}; onset {:.4f}, theory {:.4f}; Ra {:.0f} (1708)", name,
          height, fmt::join(growth, " "), fmt::join(theory, " "), deltaT, zero(theory),
          lift * deltaT * std::pow(height, 3) / (f.nu / 4 * f.lambda / 4));
  run.check("onset", std::abs(deltaT / zero(theory) - 1), 0.01, "waves are not infinitely small");
}

void convect(classics::Run& run) {
  onset(run, "papers' weights", papers, 16, 0.085);
  onset(run, "grad div, eta = 8 nu", gradient, 8, 0.096);
  onset(run, "grad div, eta = 8 nu", gradient, 16, 0.031);
  sk::Device& device = run.device();
  const int width = run.size(), height = width / 4, rows = 3 * (height + 1), steps = 20 * width;
  std::vector<Lattice> far;
  std::mt19937 random(1993);
  for (const double deltaT : {2.0, 0.6, 0.2}) far.emplace_back(width, height, deltaT);
  for (Lattice& l : far) l.forEach([&](int x, int y) { l.at(x, y).z *= 1 - 0x1p-37 * random(); });
  const double took = run.timed([&] { advance(device, papers, steps, far); });
  run.say("{} steps of {} cells: {:.3g} ns for each", steps, rows * width, 1e6 * took / steps / rows / width);
  std::vector<float> e;
  for (const Lattice& l : far)
    for (const Cell& c : l.cells) e.push_back(float(c.z / l.cells[0].z));
  run.picture("convection.png", classics::fieldPicture(e, rows, width, -1, 1, "ember", 900 / width, true));
  auto before = streamOf(device, far), gathered = streamOf(device, far), scattered = streamOf(device, far);
  const auto scatter = [&] { convection::lagrangianScatter(before, scattered); };
  run.ratio("particles, scatter / gather", scatter, [&] { convection::lagrangian(before, gathered); });
  scattered.fill({0, 0, 0});
  scatter();
  const auto check = [&](const char* what, const auto& got, const auto& expected, double bound) {
    const std::vector<double> a = got.readReals(), b = expected.readReals();
    double worst = 0;
    for (int i = 3 * width; i < 3 * width * rows; ++i)
      if (i / 3 / width % (height + 1) % height != 0) worst = classics::larger(worst, std::abs(a[i] - b[i]));
    run.check(what, worst, bound, "8 roundings a step, but in plates");
  };
  check("scatter against gather", scattered, gathered, 0x1p-21);
  std::vector<Lattice> loops = far;
  for (int n = 0; n < 3 * 20; ++n) loops[n % 3].step(papers);
  advance(device, papers, 20, far);
  check("20 steps", streamOf(device, far), streamOf(device, loops), 20 * 0x1p-21);
}

}  // namespace

int main(int argc, char** argv) { return classics::run(argc, argv, about, convect); }
