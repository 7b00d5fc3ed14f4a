// SPDX-License-Identifier: MIT
#include "surface.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "run.hpp"
#include "scene.hpp"
#include "study.hpp"
#include "support/testing.hpp"

namespace waves {
namespace {

Model small() {
  Model m;
  m.width = 19;
  m.height = 13;
  m.spacing = 1.0 / 19.0;
  m.timeStep = 1.5 * m.spacing;
  return m;
}

std::vector<double> dent(const Model& m) {
  std::vector<double> heights(static_cast<std::size_t>(m.width * m.height), 0.0);
  add({.x = 0.3, .y = 0.2, .radius = 0.2, .depth = 0.1}, m, heights);
  return heights;
}

double norm(const std::vector<double>& a) {
  double sum = 0.0;
  for (const double v : a) sum += v * v;
  return std::sqrt(sum);
}

TEST_CASE("standing waves have the frequency and the damping of their scheme") {
  sk::Device device = sk::Device::native();
  for (const Scheme scheme : {Scheme::CrankNicolson, Scheme::BackwardEuler}) {
    Model m = small();
    m.scheme = scheme;
    m.precision = sk::Precision::Double;
    m.tolerance = 1e-12;
    m.speed = 1.7;
    m.timeStep = std::sqrt(m.lambdaSquared()) * m.spacing / m.speed;  // the one that kernels compute with
    const Mode mode{2, 1};
    const Oscillation exact = schemeOscillation(mode, m), found = measure(device, m, mode, 40).oscillation;
    // Amplitudes are right but for the tolerance, which second differences divide by (w dt)^2, here more than 0.1.
    CHECK(found.frequency == Approx(exact.frequency).epsilon(100.0 * m.tolerance));
    CHECK(found.gain == Approx(exact.gain).epsilon(100.0 * m.tolerance));
  }
}

TEST_CASE("Crank-Nicolson keeps the energy within its bound, and backward Euler loses it") {
  sk::Device device = sk::Device::native();
  for (const sk::Precision precision : {sk::Precision::Single, sk::Precision::Double}) {
    Model m = small();
    m.precision = precision;
    m.tolerance = precision == sk::Precision::Double ? 1e-10 : 1e-6;
    Surface surface(device, m);
    surface.writeHeights(dent(m));
    const double start = surface.energy();
    double bound = 0.0;
    int missed = 0;
    const int steps = precision == sk::Precision::Double ? 100 : 1000;
    for (int i = 0; i < steps; ++i) {
      const Step step = surface.step();
      missed += step.reached ? 0 : 1;
      bound += surface.energyBound(step, start);
    }
    CHECK(missed == 0);
    CHECK(std::abs(surface.energy() - start) <= bound);
    CHECK(bound <= (precision == sk::Precision::Double ? 1e-5 : 2e-2) * start);
    CHECK(surface.residualInDouble() <= m.tolerance + 2.0 * m.attainable());
  }
  Model m = small();
  m.scheme = Scheme::BackwardEuler;
  Surface surface(device, m);
  surface.writeHeights(dent(m));
  const double start = surface.energy();
  for (int i = 0; i < 20; ++i) surface.step();
  CHECK(surface.energy() < 0.5 * start);
}

TEST_CASE("water is neither lost nor gained") {
  sk::Device device = sk::Device::native();
  const Model m = small();
  Surface surface(device, m);
  std::vector<double> heights = dent(m);
  for (double& h : heights) h += 0.01;
  surface.writeHeights(heights);
  for (int i = 0; i < 50; ++i) surface.step();
  double before = 0.0, after = 0.0;
  for (const double h : heights) before += h;
  for (const double h : surface.heights()) after += h;
  // A step's residual r adds (1, r) / theta, at most 2 sqrt(n) ||r||.
  const double n = static_cast<double>(m.width * m.height);
  CHECK(std::abs(after - before) <= 50.0 * 2.0 * std::sqrt(n) * m.tolerance * norm(heights));
}

TEST_CASE("waves are the same drawn, dispatched, natively and in double precision") {
  Model m = small();
  constexpr int steps = 4;
  const auto stepped = [&](sk::Device& device, const Model& model) {
    Surface surface(device, model);
    surface.writeHeights(dent(m));
    for (int i = 0; i < steps; ++i) surface.step();
    return surface.heights();
  };
  Model precise = m;
  precise.precision = sk::Precision::Double;
  precise.tolerance = 1e-10;
  sk::Device reference = sk::Device::reference(), native = sk::Device::native();
  const std::vector<double> expected = stepped(reference, precise);
  // A step moves w by its residual at most, the heights by twice that, and the velocity by four times; these add up in the steps that follow.
  const double bound = 2.0 * steps * (steps + 1) * std::max(m.tolerance, m.attainable()) * norm(dent(m));
  const auto compare = [&](sk::Device& device) {
    std::vector<double> found = stepped(device, m);
    for (std::size_t i = 0; i < found.size(); ++i) found[i] -= expected[i];
    CHECK(norm(found) <= bound);
  };
  compare(native);
  for (const char* profile : {"glsl330", "glsl430"}) {
    sk::Device gl = examples::deviceNamed(profile);
    compare(gl);
  }
}

TEST_CASE("numbers that are not finite are named with their step") {
  sk::Device device = sk::Device::native();
  const Model m = small();
  Surface surface(device, m);
  std::vector<double> heights = dent(m);
  surface.writeHeights(heights);
  surface.step();
  heights[7] = std::numeric_limits<double>::quiet_NaN();
  surface.writeHeights(heights);
  CHECK_THROWS_WITH(surface.step(), Catch::Contains("step 2: the surface is not finite"));
  for (const double wrong : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    Model bad = small();
    bad.timeStep = wrong;
    CHECK_THROWS_WITH(Surface(device, bad), Catch::Contains("the time step of a surface is"));
  }
}

void read(const std::string& text) {
  readScene(examples::WrittenFile(text, "written_waves.toml").path(), {});
}

TEST_CASE("what is wrong with a scene of water is said with its place and a way out") {
  const std::string water = "[water]\nsize = [16, 16]\n",
                    drop = "[[drop]]\ncentre = [0.5, 0.5]\nradius = 0.1\n";
  CHECK_NOTHROW(read(water + drop));
  const std::pair<std::string, const char*> cases[] = {
      {"", "'water' is missing"},
      {water, "'drop' is missing"},
      {water + "spead = 1.0\n" + drop, ":3:1:"},
      {water + "spead = 1.0\n" + drop, "did you mean 'speed'?"},
      {"[water]\nsize = [-16, 16]\n" + drop, "whole numbers from 2 to 16384"},
      {"[water]\nsize = [16384, 16384]\n" + drop, "more than 2^26 cells"},
      {water + "speed = nan\n" + drop, ":3:"},
      {water + "speed = nan\n" + drop, "speed"},
      {water + drop + "depth = inf\n", ":6:"},
      {water + drop + "depth = inf\n", "depth"},
      {water + drop + "[run]\ntime_step = 0\n", ":7:"},
      {water + drop + "[run]\ntime_step = 0\n", "time_step"},
      {water + drop + "[run]\ntime_step = 1e6\n", "take a smaller 'time_step'"},
      {water + "[[drop]]\nradius = 0.1\n", "'centre' is missing"},
      {water + drop + "[run]\nscheme = \"crank-nicholson\"\n", "crank-nicolson"}};
  for (const auto& [text, message] : cases) CHECK_THROWS_WITH(read(text), Catch::Contains(message));
}

}  // namespace
}  // namespace waves
