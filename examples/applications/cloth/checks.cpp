// SPDX-License-Identifier: MIT
#include "checks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "host_cloth.hpp"

namespace examples {
namespace {

template <class Rounded, class Exact>
Verification checkAgainst(const Scene& scene, std::int64_t steps, std::span<const double> device, double unit,
                          double looser, const char* exactName) {
  const Constants constants = constantsOf(scene);
  HostCloth<Exact> exact(scene, constants);
  HostCloth<Rounded> rounded(scene, constants);
  exact.advance(steps);
  rounded.advance(steps);
  double hostError = 0.0, farthest = 0.0;
  for (std::size_t i = 0; i < exact.positions().size(); ++i) {
    const auto e = exact.positions()[i];
    const auto difference = static_cast<Vector>(static_cast<Vec<Exact>>(rounded.positions()[i]) - e);
    hostError = std::max({hostError, std::abs(difference.x), std::abs(difference.y), std::abs(difference.z)});
    farthest = std::max(farthest, length(static_cast<Vector>(e)));
  }
  Verification verification(
      fmt::format("positions after {} steps against {} loops, in metres", steps, exactName),
      looser * (8.0 * hostError + 4.0 * unit * farthest),
      fmt::format("{:g} times what loops in the device's precision are off, {:.2g}", 8 * looser, hostError));
  for (std::size_t i = 0; i < exact.positions().size(); ++i) {
    const auto e = static_cast<Vector>(exact.positions()[i]);
    const auto place = static_cast<std::int64_t>(i);
    verification.compare(place, device[4 * i], e.x);
    verification.compare(place, device[4 * i + 1], e.y);
    verification.compare(place, device[4 * i + 2], e.z);
  }
  return verification;
}

}  // namespace

Verification checkSteps(const Scene& scene, std::int64_t steps, std::span<const double> device,
                        sk::Precision precision) {
  if (precision == sk::Precision::Double || precision == sk::Precision::Extended) {
    const double looser = precision == sk::Precision::Extended ? 0x1p8 : 1.0;
    return checkAgainst<double, long double>(scene, steps, device, 0x1p-53, looser, "long double");
  }
  return checkAgainst<float, double>(scene, steps, device, roundoff, 1.0, "double");
}

Verification checkObservation(const Scene& scene, const Observation& device, const State& state) {
  const std::vector<double>& positions = state.positions;
  const Constants constants = constantsOf(scene);
  const LinkConstants& k = constants.relaxed;
  const Cloth& c = scene.cloth;
  const auto at = [&](int x, int y) {
    const std::size_t i =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(c.columns) + static_cast<std::size_t>(x));
    return Vector{positions[i], positions[i + 1], positions[i + 2]};
  };
  double strain = 0.0, mass = 0.0, size = 0.0;
  Vector centre;
  std::int64_t links = 0;
  for (int y = 0; y < c.rows; ++y) {
    for (int x = 0; x < c.columns; ++x) {
      const Vector here = at(x, y);
      const double w = positions[4 * static_cast<std::size_t>(y * std::int64_t{c.columns} + x) + 3];
      if (w > 0) {
        mass += 1.0;
        centre += here;
        size = std::max(size, length(here));
      }
      for (const int link : {0, 2, 4, 6, 8, 10}) {
        if ((link >= 4 && link < 8 && !scene.links.shear) || (link >= 8 && !scene.links.bend)) continue;
        const int nx = x + linkDirections[link].x, ny = y + linkDirections[link].y;
        if (nx < 0 || nx >= c.columns || ny >= c.rows) continue;
        const auto i = static_cast<std::size_t>(y * std::int64_t{c.columns} + x);
        if (!state.alive.empty() && !((state.alive[i] >> link) & 1)) continue;
        const bool across = linkDirections[link].y == 0;
        const double rest =
            link >= 4 && link < 8 ? k.diagonal : (link < 4 ? 1.0 : 2.0) * (across ? k.right : k.down);
        if (rest > 0) strain += std::abs(length(at(nx, ny) - here) - rest) / rest;
        ++links;
      }
    }
  }
  const double shortest = std::min(k.right > 0 ? k.right : 1e30f, k.down > 0 ? k.down : 1e30f);
  Verification verification("mean strain and centre by reduce",
                            16.0 * roundoff * (1.0 + size + size / shortest),
                            "roundings of lengths over the distance of points, and of the sums");
  if (links > 0 && c.rest > 0) verification.compare(0, device.strain, strain / static_cast<double>(links));
  if (mass > 0) {
    verification.compare(1, device.centre.x, centre.x / mass);
    verification.compare(2, device.centre.y, centre.y / mass);
    verification.compare(3, device.centre.z, centre.z / mass);
  }
  if (links == 0 && mass == 0) verification.note(0, 0.0);
  return verification;
}

}  // namespace examples
