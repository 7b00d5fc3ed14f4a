// SPDX-License-Identifier: MIT
//
// Rays through a hierarchy of boxes, one after the other on each core: the nearer child first, a stack for the others, and the test of
// Moeller and Trumbore, which most programs have.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "peers/openmp/all.hpp"
#include "rays_layout.hpp"

namespace race {
namespace {

struct Vector {
  float x, y, z;
};
Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
float dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Element {
  Vector v;
  float packed;
  int number() const {
    int bits = 0;
    std::memcpy(&bits, &packed, sizeof bits);
    return bits - rayIntBias;
  }
};

constexpr float nowhere = 3e38f;

struct Ray {
  Vector origin, direction, inverse;
  float least;
};

float entry(const Ray& r, const Element& low, const Element& high, float most) {
  const float ax = (low.v.x - r.origin.x) * r.inverse.x, bx = (high.v.x - r.origin.x) * r.inverse.x;
  const float ay = (low.v.y - r.origin.y) * r.inverse.y, by = (high.v.y - r.origin.y) * r.inverse.y;
  const float az = (low.v.z - r.origin.z) * r.inverse.z, bz = (high.v.z - r.origin.z) * r.inverse.z;
  const float from =
      std::max(std::max(std::min(ax, bx), std::min(ay, by)), std::max(std::min(az, bz), r.least));
  const float to = std::min(std::min(std::max(ax, bx), std::max(ay, by)), std::min(std::max(az, bz), most));
  return from <= to * 1.000001f ? from : nowhere;
}

struct Hit {
  float t;
  int id;
};

void testTriangle(const Ray& r, const Element* shape, Hit& best) {
  const Vector a = shape[0].v, ab = shape[1].v - a, ac = shape[2].v - a;
  const Vector p = cross(r.direction, ac);
  const float det = dot(ab, p);
  if (det == 0) return;
  const float inverse = 1 / det;
  const Vector ao = r.origin - a;
  const float u = dot(ao, p) * inverse;
  if (!(u >= 0 && u <= 1)) return;
  const Vector q = cross(ao, ab);
  const float v = dot(r.direction, q) * inverse;
  if (!(v >= 0 && u + v <= 1)) return;
  const float t = dot(ac, q) * inverse;
  if (t >= r.least && t < best.t) best = {t, shape[0].number()};
}

Hit nearest(const Ray& r, float most, const Element* nodes, const Element* shapes) {
  Hit best = {most, -1};
  int stack[64];
  int top = 0, node = 0;
  if (entry(r, nodes[0], nodes[1], most) == nowhere) return best;
  for (;;) {
    const int first = nodes[2 * node].number(), count = nodes[2 * node + 1].number();
    if (count > 0) {
      for (int i = first; i < first + count; ++i) testTriangle(r, shapes + 3 * i, best);
    } else {
      const float t0 = entry(r, nodes[2 * first], nodes[2 * first + 1], best.t);
      const float t1 = entry(r, nodes[2 * first + 2], nodes[2 * first + 3], best.t);
      const int nearer = t1 < t0 ? first + 1 : first;
      if (std::max(t0, t1) < nowhere) stack[top++] = 2 * first + 1 - nearer;
      if (std::min(t0, t1) < nowhere) {
        node = nearer;
        continue;
      }
    }
    if (top == 0) return best;
    node = stack[--top];
  }
}

}  // namespace

void raysOpenMp(const Problem& p, float* hits) {
  const auto* from = reinterpret_cast<const Element*>(p.floats[rayOrigins].data());
  const auto* along = reinterpret_cast<const Element*>(p.floats[rayDirections].data());
  const auto* nodes = reinterpret_cast<const Element*>(p.floats[rayNodes].data());
  const auto* shapes = reinterpret_cast<const Element*>(p.floats[rayShapes].data());
  const std::int64_t n = p.size();
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::int64_t i = 0; i < n; ++i) {
    const Vector d = along[i].v;
    const Ray ray = {from[i].v, d, {1 / d.x, 1 / d.y, 1 / d.z}, from[i].packed};
    const Hit hit = nearest(ray, along[i].packed, nodes, shapes);
    hits[i] = static_cast<float>(hit.id);
    hits[n + i] = hit.id < 0 ? -1.0f : hit.t;
  }
}

}  // namespace race
