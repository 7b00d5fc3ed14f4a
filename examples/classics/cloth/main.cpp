// SPDX-License-Identifier: MIT
//
// Drapes a cloth over a ball, draws it on the device, and checks the last state.
#include <algorithm>
#include <cmath>
#include <vector>

#include "classics/support/classic.hpp"
#include "cloth.sk.hpp"
#include "support/vec.hpp"

namespace {

using examples::Vector;
using Vectors = std::vector<Vector>;

constexpr classics::Classic about{"cloth", "Green 2003", "particles along a side", 128, 16, 256};

constexpr cloth::Scene scene{{-0.2f, 0.55f, 0.15f}, 0.55f, 0, 0.01f, 0.4f};  ///< lengths in metres
constexpr double side = 2, seconds = 1.6, drag = 1;
constexpr int rounds = 4, stepsPerParticle = 16;   ///< of a side: a round passes a correction on by a link
constexpr float stiffness = 0.15f;

/// A flat cloth above the ball.
std::vector<sk::float3> firstState(int n) {
  std::vector<sk::float3> x;
  for (int i = 0; i < n * n; ++i) {
    const double u = double(i % n) / (n - 1) - 0.5, v = double(i / n) / (n - 1) - 0.5;
    x.push_back(examples::toFloat3({side * u, 1.25, side * v}));
  }
  return x;
}

cloth::Camera lookAt(Vector eye, Vector at, double focal) {
  const Vector forward = normalized(at - eye), right = normalized(cross(forward, Vector{0, 1, 0}));
  return {examples::toFloat3(eye), examples::toFloat3(right), examples::toFloat3(cross(right, forward)),
          examples::toFloat3(forward), static_cast<float>(focal)};
}

Vectors doubles(const std::vector<sk::float3>& x) {
  Vectors all(x.size());
  std::ranges::transform(x, all.begin(), examples::vecOf<double>);
  return all;
}

/// What the kernels do, in plain loops: leave() and a round of constraints.
void leave(Vector& x, Vector oldx, Vector normal, double depth) {
  if (depth <= 0) return;
  x += depth * normal;
  const Vector slip = x - oldx - dot(x - oldx, normal) * normal;
  if (const double way = length(slip); way > 0) x -= std::min(scene.friction * depth / way, 1.0) * slip;
}

double depthInBall(Vector x) {
  return double{scene.radius} + scene.thickness - length(x - examples::vecOf<double>(scene.centre));
}
double depthInFloor(Vector x) { return double{scene.level} + scene.thickness - x.y; }

Vectors satisfied(const Vectors& x, const Vectors& oldx, int n, double restlength) {
  Vectors next;
  for (int i = 0; i < n * n; ++i) {
    const auto at = [&](int row, int column) { return x[static_cast<std::size_t>(row * n + column)]; };
    Vector here = at(i / n, i % n), pull;
    for (int row = std::max(0, i / n - 2); row <= std::min(n - 1, i / n + 2); ++row) {
      for (int column = std::max(0, i % n - 2); column <= std::min(n - 1, i % n + 2); ++column) {
        const int squared = (row - i / n) * (row - i / n) + (column - i % n) * (column - i % n);
        if (squared == 0 || (squared > 2 && squared != 4)) continue;   // 1, 2, 4: structural, shear, bend
        const Vector delta = at(row, column) - here;
        pull += stiffness * (1 - restlength * std::sqrt(squared) / length(delta)) * delta;
      }
    }
    here += pull;
    const Vector before = oldx[static_cast<std::size_t>(i)],
                 fromCentre = here - examples::vecOf<double>(scene.centre);
    leave(here, before, (1 / length(fromCentre)) * fromCentre, depthInBall(here));
    leave(here, before, {0, 1, 0}, depthInFloor(here));
    next.push_back(here);
  }
  return next;
}

/// Draws twice as many pixels each way as the picture has. Nothing but the picture is read.
void draw(classics::Run& run, int n, const sk::Stream<sk::float3>& x) {
  sk::Device& device = run.device();
  constexpr int points = 16, squares = 16;   // of a link, and of the cloth
  constexpr float apart = 1.0f / points;
  const int width = 10 * n, height = 8 * n, samples = points * (n - 1) + 1;
  auto normal = device.stream<sk::float3>({n, n}), colour = device.stream<sk::float3>({height, width});
  auto depth = device.stream<float>({height, width}), shadow = device.stream<float>({width, width});
  auto picture = device.stream<sk::float3>({height / 2, width / 2});
  const cloth::Camera camera = lookAt({2.6, 1.7, 2.2}, {-0.1, 0.5, 0.1}, 1.5 * width);
  const cloth::Camera lamp = lookAt({-1.2, 5, 3}, {-0.1, 0.3, 0}, 1.7 * width);
  const cloth::Light light{.lamp = lamp, .shadow = shadow};
  const auto frame = [&] {
    cloth::normals(x, normal);
    shadow.fill(1e30f);
    cloth::drawDepth.over({samples, samples})(lamp, apart, x, shadow);
    cloth::drawScene(camera, light, scene, colour, depth);
    cloth::drawDepth.over({samples, samples})(camera, apart, x, depth);
    const float square = float(n - 1) / squares;
    cloth::drawCloth.over({samples, samples})(camera, light, apart, square, x, normal, depth, colour);
    cloth::sum(colour, picture);
    cloth::develop(picture, picture);
  };
  frame();   // programs are compiled
  run.say("drawn in {:.0f} ms as {} points; {} x {} pixels are all that is read", run.milliseconds(frame),
          samples * samples, width / 2, height / 2);
  run.picture("cloth.png", examples::imageOf(width / 2, height / 2, picture.read()));
}

void drape(classics::Run& run) {
  const int n = run.size(), steps = stepsPerParticle * n;
  const double dt = seconds / steps;
  const auto restlength = static_cast<float>(side / (n - 1)), keep = static_cast<float>(1 - drag * dt);
  const sk::float3 a{0, static_cast<float>(-9.81 * dt * dt), 0};
  auto x = run.device().stream<sk::float3>({n, n}), oldx = run.device().stream<sk::float3>({n, n});
  x.write(firstState(n));
  x.copyTo(oldx);
  sk::Loop step = run.device().record([&] {
    cloth::integrate(keep, a, x, oldx, x, oldx);
    for (int i = 0; i < rounds; ++i) cloth::satisfyConstraints(restlength, stiffness, scene, x, oldx, x);
  });
  const double took = run.timed([&] { step.repeat(steps); });
  run.say("{} steps of {} rounds in {:.0f} ms, {:.0f} million links a second", steps, rounds, took,
          12e-3 * n * n * steps * rounds / took);
  draw(run, n, x);

  const Vectors before = doubles(oldx.read()), now = doubles(x.read());
  step.repeat(1);
  const Vectors after = doubles(x.read());
  Vectors next;
  double inside = 0, threads = 0, error = 0;
  for (std::size_t i = 0, row = std::size_t(n); i < now.size(); ++i) {
    next.push_back(now[i] + double{keep} * (now[i] - before[i]) + examples::vecOf<double>(a));
    inside = std::max({inside, depthInBall(now[i]), depthInFloor(now[i])});
    if (i % row > 0) threads += length(now[i] - now[i - 1]);
    if (i >= row) threads += length(now[i] - now[i - row]);
  }
  for (int i = 0; i < rounds; ++i) next = satisfied(next, now, n, restlength);
  for (std::size_t i = 0; i < next.size(); ++i) error = std::max(error, length(after[i] - next[i]));
  run.check("one step", error, 4 * (1 + rounds) * 0x1p-24, "in each pass 4 roundings of lengths up to 1 m");
  run.check("depth in ball and floor", inside, 0x1p-21, "8 roundings of lengths up to 1 m");
  run.check("stretch of the threads", std::abs(threads / (2 * n * side) - 1), 0.03,
            "chosen: cloth, and not rubber");
}

}  // namespace

int main(int argc, char** argv) { return classics::run(argc, argv, about, drape); }
