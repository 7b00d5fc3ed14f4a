// SPDX-License-Identifier: MIT
#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "camera.hpp"

namespace rays {
namespace {

using examples::vecOf;

constexpr double clearlyInside = 1e-3;
constexpr double roundings = 0x1p-20;  ///< 16 of floats, of the lengths that a hit is computed from
/// Limits the tests of rays against shapes that a verification may take.
constexpr std::size_t mostTests = 20'000'000;

Vector at(const Ray& ray, double t) { return vecOf<double>(ray.origin) + t * vecOf<double>(ray.direction); }

bool counts(const Ray& ray, double t) { return t >= ray.least && t <= ray.most; }

/// Lengths that a distance is computed from.
double scaleOf(const Ray& ray, double t) {
  const auto o = vecOf<double>(ray.origin);
  return 1.0 + std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)}) +
         std::abs(t) * length(vecOf<double>(ray.direction));
}

/// The nearest root that counts, with the part of the direction along the normal there.
std::optional<Meeting> meetSphere(const Sphere& sphere, const Ray& ray) {
  const Vector f = vecOf<double>(ray.origin) - vecOf<double>(sphere.centre), d = vecOf<double>(ray.direction);
  const double a = dot(d, d), b = dot(f, d);
  const double discriminant = b * b - a * (dot(f, f) - double(sphere.radius) * sphere.radius);
  if (discriminant < 0) return std::nullopt;
  for (const double t : {(-b - std::sqrt(discriminant)) / a, (-b + std::sqrt(discriminant)) / a}) {
    const double across = std::abs(dot(d, f + t * d)) / sphere.radius;
    if (counts(ray, t)) return Meeting{t, across / std::sqrt(a), HUGE_VAL, across};
  }
  return std::nullopt;
}

std::optional<Meeting> meetPlane(const Plane& plane, const Ray& ray) {
  const auto n = vecOf<double>(plane.normal);
  const double across = dot(n, vecOf<double>(ray.direction));
  const double t = (plane.distance - dot(n, vecOf<double>(ray.origin))) / across;
  if (across == 0 || !counts(ray, t)) return std::nullopt;
  return Meeting{t, 1.0, HUGE_VAL, std::abs(across)};
}

/// The lengths that a distance to a triangle is computed from, and what stands for its needleError() among them.
double scaleOf(const Triangle& triangle, const Ray& ray, double t, const TriangleTest& test) {
  const double scale = scaleOf(ray, t);
  return scale + needleError(triangle, test, scale) / roundings;
}

/// The lengths whose roundings decide beside an edge whether there is a hit. The signs of edge functions are exact; those of other tests are not.
double uncertain(const Triangle& triangle, const Ray& ray, double t, const TriangleTest& test) {
  return test.isWatertight ? scaleOf(ray, t) : scaleOf(triangle, ray, t, test);
}

/// The distance of the hit's point from the surface that it names, relative to the lengths that it was computed from.
double ownError(const Model& model, const Ray& ray, const Hit& hit, const TriangleTest& test) {
  const Vector p = at(ray, hit.t);
  if (hit.id >= model.planeId(0)) {
    const Plane& plane = model.planes[static_cast<std::size_t>(hit.id - model.planeId(0))];
    return std::abs(dot(vecOf<double>(plane.normal), p) - plane.distance) / scaleOf(ray, hit.t);
  }
  if (hit.id >= model.sphereId(0)) {
    const Sphere& sphere = model.spheres[static_cast<std::size_t>(hit.id - model.sphereId(0))];
    return std::abs(length(p - vecOf<double>(sphere.centre)) - sphere.radius) / scaleOf(ray, hit.t);
  }
  const auto found = std::ranges::lower_bound(model.triangles, hit.id, {}, &Triangle::id);
  if (found == model.triangles.end() || found->id != hit.id) return HUGE_VAL;
  const Meeting meeting = meet(*found, ray);
  const bool isBeside = meeting.inside < -clearlyInside &&
                        meeting.margin < -roundings * uncertain(*found, ray, meeting.t, test);
  return isBeside ? HUGE_VAL
                  : std::abs(hit.t - meeting.t) * meeting.across / scaleOf(*found, ray, hit.t, test);
}

}  // namespace

Meeting meet(const Triangle& triangle, const Ray& ray) {
  const auto o = vecOf<double>(ray.origin), d = vecOf<double>(ray.direction);
  const auto a = vecOf<double>(triangle.a) - o, b = vecOf<double>(triangle.b) - o,
             c = vecOf<double>(triangle.c) - o;
  const double u = dot(d, cross(c, b)), v = dot(d, cross(a, c)), w = dot(d, cross(b, a));
  const double sum = u + v + w;
  if (sum == 0) return {};
  const Vector n = normalized(cross(b - a, c - a));
  const auto from = [&](double weight, const Vector& edge) {
    return weight * (sum > 0 ? 1 : -1) / std::max(length(cross(d, edge)), 1e-300);
  };
  return {dot(n, a) / dot(n, d), std::min({u / sum, v / sum, w / sum}),
          std::min({from(u, c - b), from(v, a - c), from(w, b - a)}), std::abs(dot(n, d))};
}

double needleError(const Triangle& triangle, const TriangleTest& test, double scale) {
  const auto a = vecOf<double>(triangle.a), b = vecOf<double>(triangle.b), c = vecOf<double>(triangle.c);
  const double longest = std::max({length(b - a), length(c - b), length(a - c)});
  const double area = 0.5 * length(cross(b - a, c - a));
  if (!(area > 0.0)) return 0.0;
  const double across = longest * longest / area;
  return test.roundoff * across * (test.isWatertight ? 3.0 * longest : 9.0 * scale);
}

double errorOf(const Model& model, const Ray& ray, const Hit& hit, const TriangleTest& test) {
  double error = hit.id < 0 ? 0.0 : ownError(model, ray, hit, test);
  // How far a surface that is clearly met lies before what was found, relative to `scale`.
  const auto missed = [&](const Meeting& meeting, double scale) {
    error = std::max(error, hit.id < 0 ? HUGE_VAL : (hit.t - meeting.t) * meeting.across / scale);
  };
  const auto isBefore = [&](const Meeting& meeting) {
    return meeting.inside >= clearlyInside && meeting.t < hit.t && counts(ray, meeting.t);
  };
  for (const Triangle& triangle : model.triangles) {
    const Meeting meeting = meet(triangle, ray);
    if (isBefore(meeting) && meeting.margin >= roundings * uncertain(triangle, ray, meeting.t, test))
      missed(meeting, scaleOf(triangle, ray, hit.t, test));
  }
  for (const Sphere& sphere : model.spheres) {
    const auto meeting = meetSphere(sphere, ray);
    if (meeting && isBefore(*meeting)) missed(*meeting, scaleOf(ray, hit.t));
  }
  for (const Plane& plane : model.planes) {
    const auto meeting = meetPlane(plane, ray);
    if (meeting && isBefore(*meeting)) missed(*meeting, scaleOf(ray, hit.t));
  }
  return error;
}

examples::Verification checkEngine(Engine& engine, const Model& model, int width, int height) {
  examples::Verification verification("rays of pixels against all shapes", roundings,
                                      "16 roundings of floats, of the lengths that a hit is computed from");
  const TriangleTest test = engine.triangleTest();
  const std::vector<Ray> all = primaryRays(model.camera, width, height);
  const std::size_t shapes = std::max<std::size_t>(1, model.triangles.size() + model.spheres.size());
  const std::size_t count = std::clamp<std::size_t>(mostTests / shapes, 1, 2000);
  // Not a divisor of the width, so that all columns have their turn.
  std::size_t step = std::max<std::size_t>(1, all.size() / count);
  if (step > 1 && width % static_cast<int>(step) == 0) ++step;
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < all.size(); i += step) rays.push_back(all[i]);
  const std::vector<Hit> hits = hitsOf(engine, rays);
  for (std::size_t i = 0; i < rays.size(); ++i)
    verification.note(static_cast<std::int64_t>(i), errorOf(model, rays[i], hits[i], test));
  return verification;
}

}  // namespace rays
