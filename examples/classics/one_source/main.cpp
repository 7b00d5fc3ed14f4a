// SPDX-License-Identifier: MIT
// Shades one ball on every profile of this machine, and compares the results bit by bit.
#include <array>
#include <cmath>
#include <cstring>

#include "classics/support/classic.hpp"
#include "one_source.sk.hpp"
#include "support/vec.hpp"

using namespace one_source;
using examples::Vector;
constexpr sk::float3 eye = {0, 0, 1};
constexpr std::array<Lamp, 2> lamps = {
    {{{-0.6f, 0.64f, 0.48f}, {1.5f, 1.375f, 1.25f}}, {{0.8f, 0.36f, 0.48f}, {0.375f, 0.5f, 0.75f}}}};

Vector wide(sk::float3 v) { return examples::vecOf<double>(v); }

/// The gradient and the value, as in one_source.sk.
std::array<double, 4> noise(const std::array<double, 3>& q) {
  std::array<double, 4> sum = {};
  for (unsigned i = 0; i < 8; ++i) {
    std::array<double, 4> term = {1, 1, 1, 1};
    unsigned h = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      const unsigned corner = i >> d & 1, factor = std::array{0x8da6b343, 0xd8163841, 0xcb1ab31f}[d];
      const double base = std::floor(q[d]), t = q[d] - base, rise = t * t * t * (t * (6 * t - 15) + 10);
      const double slope = 30 * t * t * (t - 1) * (t - 1);
      h ^= (unsigned(int(base)) + corner) * factor;
      for (std::size_t k = 0; k < 4; ++k)
        term[k] *= k == d ? (corner ? slope : -slope) : corner ? rise : 1 - rise;
    }
    h = (h ^ h >> 15) * 0x2c1b3c6d;
    h = (h ^ h >> 12) * 0x297a2d39;
    for (std::size_t k = 0; k < 4; ++k) sum[k] += (((h ^ h >> 15) >> 8) * 0x1p-23 - 1) * term[k];
  }
  return sum;
}

/// Albedo, normal and colour, as in one_source.sk.
std::array<Vector, 3> shadeInDouble(const Vector& p) {
  const Vector q = 2.0 * p, e = wide(eye);
  Vector slope, diffuse = {0.0625, 0.0625, 0.0625}, highlight;
  double height = 0;
  for (int octave = 0; octave < 5; ++octave) {
    const double scale = 1 << octave, offset = 0.375 * octave;
    const auto [x, y, z, value] = noise({scale * q.x + offset, scale * q.y + offset, scale * q.z + offset});
    slope += Vector{x, y, z};
    height += value / scale;
  }
  const double band = q.x + 0.5 * q.y + 1.5 * height, vein = std::pow(2 * (band - std::floor(band)) - 1, 4);
  const Vector albedo = Vector{0.0625, 0.1875, 0.15625} + vein * Vector{0.75, 0.625, 0.5};
  const Vector n = normalized(p - 0.03125 * (slope - dot(slope, p) * p));
  const Vector t = normalized(cross(Vector{0.125, 0.75, -0.5}, n));
  for (const Lamp& lamp : lamps) {
    const auto l = wide(lamp.direction), power = std::max(dot(n, l), 0.0) * wide(lamp.colour);
    const double shine = length(cross(l, t)) * length(cross(e, t)) - dot(l, t) * dot(e, t);
    diffuse += power;
    highlight += std::pow(std::max(shine, 0.125), 32) * power;
  }
  const double fresnel = 0.0625 + 0.9375 * std::pow(1 - std::max(dot(n, e), 0.0), 5);
  const double up = 0.5 + 0.5 * (2 * dot(n, e) * n.y - e.y);
  const Vector mirror = Vector{0.25, 0.1875, 0.125} + up * up * (3 - 2 * up) * Vector{0.25, 0.5, 0.875};
  const Vector lit = {albedo.x * diffuse.x, albedo.y * diffuse.y, albedo.z * diffuse.z};
  return {albedo, n, lit + 0.5 * highlight + fresnel * mirror};
}
using Result = std::pair<std::vector<Surface>, std::vector<Reflection>>;

/// Appends the device's result. Returns how many pixels have other bits than in the first result and should not.
int shadeOn(sk::Device& device, const std::vector<sk::float3>& ball, classics::Run& run,
            std::vector<Result>& results) {
  const int n = run.size(), buffers = std::min(device.limits().drawBuffers, 10);
  auto p = device.stream<sk::float3>({n, n});
  auto surface = device.stream<Surface>({n, n});
  auto light = device.stream<Reflection>({n, n});
  p.write(ball);
  const auto call = [&] {
    shade(p, eye, lamps, surface, light);
    device.finish();
  };
  device.countPasses(true);
  call();
  const auto [passes, read, written] = device.passCount();
  double time = &device == &run.device() ? run.timed(call) : run.milliseconds(call);
  for (int round = 0; round < 4; ++round) time = std::min(time, run.milliseconds(call));
  const auto& here = results.emplace_back(surface.read(), light.read());
  int surfaces = 0, lights = 0, cells = 0;
  for (std::size_t i = 0; i < ball.size(); ++i) {
    surfaces += std::memcmp(&here.first[i], &results[0].first[i], sizeof(Surface)) != 0;
    cells += here.first[i].cell != results[0].first[i].cell;
    lights += std::memcmp(&here.second[i], &results[0].second[i], sizeof(Reflection)) != 0;
  }
  run.say("{:<8} {:>15} {:>7} {:>11} {:>8} {:>7.2f} {:>14} {:>6}", device.profile(), buffers, passes,
          read / n / n, written / n / n, time, surfaces, lights);
  return device.isSoftware() && run.device().isSoftware() ? surfaces + lights : cells;
}

sk::float3 encoded(sk::float3 c) { return {std::sqrt(c.x), std::sqrt(c.y), std::sqrt(c.z)}; }

void body(classics::Run& run) {
  auto points = run.device().stream<sk::float3>({run.size(), run.size()});
  rasterize(points);
  const std::vector<sk::float3> ball = points.read();
  std::vector<Result> results;
  run.say("profile   outputs a pass  passes  bytes read  written      ms  other surface  light");
  int differ = shadeOn(run.device(), ball, run, results);
  const std::string own = run.device().name(), gl = run.device().kind() == "native" ? "gl" : own;
  std::array<std::size_t, 4> shown = {};  // in the quadrants of the picture
  for (unsigned k = 0; k < 4; ++k) {
    const std::string profile = std::array{"native", "glsl330", "glsl430", "essl300"}[k];
    if (profile == own) continue;
    try {
      sk::Device device({.device = k ? gl : profile, .profile = k ? profile : "", .limits = "guaranteed"});
      differ += shadeOn(device, ball, run, results);
      shown[k] = results.size() - 1;
    } catch (const sk::Error& error) {
      if (error.kind() != sk::Error::Kind::Device) throw;
      run.say("{:<8} left out: this machine has no such device", profile);
    }
  }
  if (own.starts_with("reference"))
    run.say("bits are not compared, as the first line is computed in double");
  else
    run.check("pixels with other bits", differ, 0, "on CPUs; on GPUs, of integers");
  double error = 0;
  const std::size_t n = std::size_t(run.size());
  std::vector<sk::float3> pixels(2 * n * n, {1, 1, 1});
  for (std::size_t i = 0; i < n * n; ++i) {
    const auto [albedo, normal, colour] = shadeInDouble(wide(ball[i]));
    for (const auto& [surface, light] : results) {
      const double apart = length(wide(surface[i].albedo) - albedo) + length(wide(light[i].normal) - normal) +
                           length(wide(light[i].colour) - colour);
      error = classics::larger(error, apart);
    }
    if (ball[i].z == 0) continue;
    const std::size_t row = i / n, column = i % n, quadrant = 2 * (row >= n / 2) + (column >= n / 2);
    const auto& [surface, light] = results[shown[quadrant]];
    const Vector shifted = 0.5 * (wide(light[i].normal) + Vector{1, 1, 1});
    const std::array outputs = {surface[i].albedo, toFloat3(shifted), light[i].highlight, light[i].mirror};
    pixels[2 * n * row + column] = encoded(light[i].colour);
    pixels[2 * n * row + n + column] = encoded(outputs[quadrant]);
  }
  run.check("albedo, normal and colour", error, 0x1p-13, "2^11 roundings");
  run.picture("one_source.png", examples::imageOf(2 * run.size(), run.size(), pixels));
}

int main(int argc, char** argv) {
  return classics::run(argc, argv, {"one_source", "Proudfoot and others 2001", "pixels a side", 480, 8, 1200},
                       body);
}
