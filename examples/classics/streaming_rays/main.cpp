// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "classics/support/classic.hpp"
#include "streaming_rays.sk.hpp"
#include "support/vec.hpp"

using namespace streaming_rays;
using examples::normalized, examples::toFloat3, examples::Vector, examples::vecOf;
using Mesh = std::vector<Triangle>;
enum Use : unsigned { RayCasting, ShadowCasting, Whitted, PathTracing };  // as in streaming_rays.sk
constexpr const char* uses[] = {"ray casting", "shadow casting", "Whitted", "path tracing"};
constexpr int fields = 32, voxels = 24, samples = 16;  // along each side of landscape and grid; of each pixel
constexpr float low = -1.01f, size = -2 * low / voxels;
constexpr Vector eye = {0, 0.3, 1.5}, sun = {-0.6, 0.64, 0.48};

/// A list has the triangles that come near its voxel, so that rounding on a ray's way loses no hit.
void buildGrid(const Mesh& mesh, std::vector<int>& cell, std::vector<int>& list) {
  const auto meets = [](float a, float b, float c, int voxel) {
    const float from = low + float(voxel) * size - 0.001f, to = from + size + 0.002f;
    return std::min({a, b, c}) <= to && std::max({a, b, c}) >= from;
  };
  for (int i = 0; i < voxels * voxels * voxels; ++i) {
    const int start = int(list.size()), x = i % voxels, y = i / voxels % voxels, z = i / voxels / voxels;
    for (int id = 0; id < int(mesh.size()); ++id) {
      const auto& [a, b, c, material] = mesh[std::size_t(id)];
      if (meets(a.y, b.y, c.y, y) && meets(a.x, b.x, c.x, x) && meets(a.z, b.z, c.z, z)) list.push_back(id);
    }
    cell.push_back(int(list.size()) > start ? start : -1);
    if (cell.back() >= 0) list.push_back(-1);
  }
}

unsigned pcg(unsigned x) {
  const unsigned state = x * 747796405u + 2891336453u;
  const unsigned word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}

struct Hit {
  double t;
  int id;  ///< of the triangle, or -1
  Vector edge1, edge2;
};

/// Finds the nearest hit among all triangles in double. A ray grazes an edge if rounding below 2^-16 could change the result.
Hit nearest(const Mesh& mesh, Vector ro, Vector rd, bool& grazes) {
  Hit hit{0x1p100, -1, {}, {}};
  for (const Triangle& m : mesh) {
    const Vector v0 = vecOf<double>(m.v0), edge1 = vecOf<double>(m.v1) - v0, edge2 = vecOf<double>(m.v2) - v0;
    const Vector pvec = cross(rd, edge2), tvec = ro - v0, qvec = cross(tvec, edge1);
    const double det = dot(edge1, pvec), t = dot(edge2, qvec) / det;
    const double u = dot(tvec, pvec) / det, v = dot(rd, qvec) / det, inside = std::min({u, v, 1 - u - v});
    grazes |= t >= 0 && std::abs(inside * det) < 0x1p-16 * (length(edge1) + length(edge2));
    if (t >= 0 && t < hit.t && inside >= 0) hit = {t, int(&m - mesh.data()), edge1, edge2};
  }
  return hit;
}

Vector radiance(const Mesh& mesh, Use use, unsigned pixel, unsigned bounces, Vector ro, Vector rd,
                bool& grazes) {
  const auto [t, id, edge1, edge2] = nearest(mesh, ro, rd, grazes);
  if (id < 0) return Vector{1, 1, 1} - std::max(rd.y, 0.0) * Vector{0.5, 0.3, 0};
  const auto [r, g, b, mirror] = mesh[std::size_t(id)].material;
  Vector n = normalized(cross(edge1, edge2));
  if (dot(n, rd) > 0) n = -1.0 * n;
  if (use == RayCasting) return -dot(n, rd) * Vector{r, g, b};
  if (bounces == 3) return {};
  const Vector p = ro + t * rd, above = p + 0x1p-17 * (length(p) + length(edge1) + length(edge2)) * n;
  if (use == PathTracing || (use == Whitted && mirror == 1)) {
    const unsigned bits = pcg(pixel + pcg(bounces + 1));
    const double z = 1 - (bits >> 8) * 0x1p-23, a = (pcg(bits) >> 8) * 0x1p-23 * std::acos(-1.0);
    const Vector onSphere = {std::sqrt(1 - z * z) * std::cos(a), std::sqrt(1 - z * z) * std::sin(a), z};
    const Vector next = mirror == 1 ? rd - 2 * dot(n, rd) * n : normalized(n + onSphere);
    const Vector light = radiance(mesh, use, pixel, bounces + 1, above, next, grazes);
    return {r * light.x, g * light.y, b * light.z};
  }
  const double cosine = nearest(mesh, above, sun, grazes).id < 0 ? std::max(dot(n, sun), 0.0) : 0;
  return (0.2 + cosine) * Vector{r, g, b};
}

int main(int argc, char** argv) {
  const classics::Classic about{"streaming_rays", "Purcell and others 2002", "pixels a side", 256, 16, 1024};
  return classics::run(argc, argv, about, [](classics::Run& run) {
    StreamingRaysStreams s(run.device(), 2 * fields * fields, voxels, run.size(), run.size());
    landscape(fields, s.triangle);
    const Mesh mesh = s.triangle.read();
    std::vector<int> cell, lists;
    buildGrid(mesh, cell, lists);
    auto list = run.device().stream<int>({std::ssize(lists)});
    list.write(lists);
    s.cell.write(cell);
    Scene scene{toFloat3(eye), toFloat3(sun), low, size, s.cell, list, s.triangle};
    int passes = 0, different = 0, checked = 0, grazing = 0;
    const auto multipass = [&] {
      generate(scene, s.ray, s.walk);
      for (passes = 1;; ++passes) {
        const auto [traversing, intersecting, shading] = count(s.walk);
        if (traversing + intersecting + shading == 0) return;
        if (traversing + intersecting == 0)
          shade(scene, s.ray, s.walk, s.ray, s.walk);
        else if (4 * intersecting >= traversing)  // a fifth of those on their way
          intersect(scene, s.ray, s.walk, s.walk);
        else
          traverse(scene, s.ray, s.walk, s.walk);
      }
    };
    const auto branching = [&] { trace(scene, s.sum, s.sum); };
    std::vector<examples::Image> pictures;
    for (const Use use : {RayCasting, ShadowCasting, Whitted, PathTracing}) {
      scene.use = use;
      scene.sample = 0u;
      s.sum.fill({0, 0, 0});
      branching();
      const std::vector<sk::float3> colour = s.sum.read();
      run.ratio(fmt::format("{}, multipass / branching", uses[use]), multipass, branching, 3);
      colourOf(s.ray, s.colour);
      different += colour != s.colour.read();
      const std::vector<Walk> walk = s.walk.read();
      double ofHits = 0, ofColours = 0;
      for (unsigned i = 0, n = unsigned(run.size()); i < n * n; i += 1 + n * n / 1000) {
        bool grazes = false;
        const Vector rd = normalized(Vector{(i % n + 0.5) / n - 0.5, 0.5 - (i / n + 0.5) / n, -1});
        const Vector expected = radiance(mesh, use, i, 0, eye, rd, grazes);
        const auto [t, id, edge1, edge2] = nearest(mesh, eye, rd, grazes);
        ++(grazes ? grazing : checked);
        if (grazes) continue;
        const double fromPlane = std::abs((walk[i].h.x - t) * dot(normalized(cross(edge1, edge2)), rd));
        ofHits = classics::larger(ofHits, walk[i].h.w == float(id) ? fromPlane : 1.0);
        ofColours = classics::larger(ofColours, length(vecOf<double>(colour[i]) - expected));
      }
      if (use == RayCasting) run.check("nearest hits", ofHits, 0x1p-18, "16 roundings at distances up to 4");
      run.check(fmt::format("{} in {} passes", uses[use], passes), ofColours, 0x1p-18, "64 roundings");
      s.sum.fill({0, 0, 0});
      for (unsigned i = samples; i-- > 0;) {
        scene.sample = i;
        run.timed(branching);
      }
      std::vector<sk::float3> pixels = s.sum.read();
      for (sk::float3& p : pixels)
        p = {std::sqrt(p.x / samples), std::sqrt(p.y / samples), std::sqrt(p.z / samples)};
      pictures.push_back(examples::imageOf(run.size(), run.size(), pixels));
    }
    run.say("{} triangles, {} voxels, lists of {} entries; {} pixels checked, {} more graze an edge",
            mesh.size(), cell.size(), lists.size(), checked, grazing);
    run.check("pictures of both machines that differ", different, 0, "the same operations in the same order");
    run.picture("streaming_rays.png", classics::sideBySide(pictures));
  });
}
