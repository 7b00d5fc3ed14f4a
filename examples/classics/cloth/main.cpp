// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "classics/support/classic.hpp"
#include "cloth.sk.hpp"
#include "support/vec.hpp"

using classics::larger, examples::toFloat3, examples::Vector, examples::vecOf;
using Vectors = std::vector<Vector>;
constexpr classics::Classic about{"cloth", "Green 2003", "particles along a side", 128, 16, 256};
constexpr cloth::Scene scene{{-0.2f, 0.55f, 0.15f}, 0.55f, 0, 0.01f, 0.4f};  ///< lengths in metres
constexpr double side = 2, seconds = 1.6, drag = 1, gravity = 9.81;
constexpr int rounds = 4, stepsPerParticle = 16;   ///< of a side: a round passes a correction on by a link
constexpr float stiffness = 0.15f;
constexpr double longer = 1.0 / 16, ofStep = 4 * (1 + rounds) * 0x1p-24;  ///< a step in seconds; errors
const Vector centre = vecOf<double>(scene.centre);

/// A flat cloth above the ball.
std::vector<sk::float3> firstState(int n) {
  const double link = side / (n - 1);
  std::vector<sk::float3> x;
  for (int i = 0; i < n * n; ++i)
    x.push_back(toFloat3({link * (i % n) - side / 2, 1.25, link * (i / n) - side / 2}));
  return x;
}

cloth::Camera lookAt(Vector eye, Vector at, double focal) {
  const Vector forward = normalized(at - eye), right = normalized(cross(forward, Vector{0, 1, 0}));
  return {toFloat3(eye), toFloat3(right), toFloat3(cross(right, forward)), toFloat3(forward), float(focal)};
}

Vectors doubles(const std::vector<sk::float3>& x) {
  Vectors all(x.size());
  std::ranges::transform(x, all.begin(), examples::vecOf<double>);
  return all;
}

/// What the kernels do, in plain loops: leave(), a round of constraints, and a step.
void leave(Vector& x, Vector oldx, Vector normal, double depth) {
  if (depth <= 0) return;
  x += depth * normal;
  const Vector slip = x - oldx - dot(x - oldx, normal) * normal;
  if (const double way = length(slip); way > 0) x -= std::min(scene.friction * depth / way, 1.0) * slip;
}

double depthInBall(Vector x) { return double{scene.radius} + scene.thickness - length(x - centre); }
double depthInFloor(Vector x) { return double{scene.level} + scene.thickness - x.y; }

Vectors satisfied(const Vectors& x, const Vectors& oldx, int n) {
  const double restlength = side / (n - 1);
  Vectors next;
  for (int i = 0; i < n * n; ++i) {
    Vector here = x[i], pull;
    for (int row = std::max(0, i / n - 2); row <= std::min(n - 1, i / n + 2); ++row)
      for (int column = std::max(0, i % n - 2); column <= std::min(n - 1, i % n + 2); ++column) {
        const double far = std::hypot(row - i / n, column - i % n);
        if (far == 0 || far > 2) continue;  // 1, sqrt(2), 2: structural, shear, bend
        const Vector delta = x[row * n + column] - here;
        pull += stiffness * (1 - restlength * far / length(delta)) * delta;
      }
    here += pull;
    leave(here, oldx[i], normalized(here - centre), depthInBall(here));
    leave(here, oldx[i], {0, 1, 0}, depthInFloor(here));
    next.push_back(here);
  }
  return next;
}

Vectors stepped(const Vectors& x, const Vectors& oldx, int n, double dt) {
  Vectors next;
  for (std::size_t i = 0; i < x.size(); ++i)
    next.push_back(x[i] + (1 - drag * dt) * (x[i] - oldx[i]) + Vector{0, -gravity * dt * dt, 0});
  for (int i = 0; i < rounds; ++i) next = satisfied(next, x, n);
  return next;
}

/// Draws twice as many pixels each way as the picture has. Nothing but the picture is read.
void draw(classics::Run& run, int n, const sk::Stream<sk::float3>& x) {
  sk::Device& device = run.device();
  constexpr int points = 16, squares = 16;   // of a link, and of the cloth
  const float apart = 1.0f / points, square = float(n - 1) / squares;
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
  const auto restlength = static_cast<float>(side / (n - 1));
  auto x = run.device().stream<sk::float3>({n, n}), oldx = run.device().stream<sk::float3>({n, n});
  const auto stepOf = [&](double dt) {
    return run.device().record([&] {
      cloth::integrate(1 - drag * dt, toFloat3({0, -gravity * dt * dt, 0}), x, oldx, x, oldx);
      for (int i = 0; i < rounds; ++i) cloth::satisfyConstraints(restlength, stiffness, scene, x, oldx, x);
    });
  };
  const auto errorOfStep = [&](double dt) {
    const Vectors before = doubles(oldx.read()), now = doubles(x.read());
    stepOf(dt).repeat(1);
    const Vectors after = doubles(x.read()), expected = stepped(now, before, n, dt);
    double error = 0;
    for (std::size_t i = 0; i < now.size(); ++i) error = larger(error, length(after[i] - expected[i]));
    return error;
  };
  x.write(firstState(n));
  oldx.write(firstState(n));
  stepOf(longer).repeat(1);
  run.check("a step of 1/16 s in the fall", errorOfStep(longer), ofStep,
            "in each pass 4 roundings of lengths up to 1 m");

  x.write(firstState(n));
  oldx.write(firstState(n));
  sk::Loop step = stepOf(seconds / steps);
  const double took = run.timed([&] { step.repeat(steps); });
  run.say("{} steps of {} rounds in {:.0f} ms, {:.0f} million links a second", steps, rounds, took,
          12e-3 * n * n * steps * rounds / took);
  draw(run, n, x);
  const Vectors last = doubles(x.read());
  double inside = 0, threads = 0;
  for (std::size_t i = 0, row = std::size_t(n); i < last.size(); ++i) {
    inside = larger(inside, larger(depthInBall(last[i]), depthInFloor(last[i])));
    if (i % row > 0) threads += length(last[i] - last[i - 1]);
    if (i >= row) threads += length(last[i] - last[i - row]);
  }
  run.check("one step", errorOfStep(seconds / steps), ofStep,
            "in each pass 4 roundings of lengths up to 1 m");
  run.check("depth in ball and floor", inside, 0x1p-21, "8 roundings of lengths up to 1 m");
  run.check("stretch of threads", std::abs(threads / (2 * n * side) - 1), 0.03, "chosen: cloth, not rubber");
}

int main(int argc, char** argv) { return classics::run(argc, argv, about, drape); }
