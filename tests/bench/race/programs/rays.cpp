// SPDX-License-Identifier: MIT
//
// The nearest hits of rays through hierarchies of boxes, as examples/applications/rays has them: rays of a camera, side by side, and diffuse rays from what
// those hit, in a furnished hall and about a closed mesh. rays_layout.hpp says what the arrays of the problem are. The result: the triangle of
// each ray, or -1, and then the distance of each ray's hit, or -1.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bvh.sk.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"
#include "applications/rays/bvh.hpp"
#include "applications/rays/bvh_engine.hpp"
#include "applications/rays/camera.hpp"
#include "applications/rays/device_scene.hpp"
#include "applications/rays/reference.hpp"
#include "applications/rays/study.hpp"
#include "rays_layout.hpp"

namespace race {
namespace {

using rays::Bounds;
using rays::Bvh;
using rays::BvhNode;
using rays::Model;
using rays::Ray;

enum class Scene { Hall, Mesh };
enum class Kind { Primary, Diffuse };

const Model& modelOf(Scene scene) {
  static const Model hall = rays::interior(false), mesh = rays::organic(false);
  return scene == Scene::Hall ? hall : mesh;
}

std::vector<Ray> raysOf(Scene scene, Kind kind, const Problem& p) {
  const Model& model = modelOf(scene);
  std::vector<Ray> primary =
      rays::primaryRays(model.camera, static_cast<int>(p.columns), static_cast<int>(p.rows));
  if (kind == Kind::Primary) return primary;
  sk::Device device = sk::Device::native();
  std::vector<rays::Hit> hits(primary.size());
  rays::makeBvhEngine(device, model, {})->closest(primary, hits);
  return rays::diffuseRays(model, primary, hits, primary.size());
}

template <Scene scene, Kind kind>
Problem problemOf(int log2) {
  const Model& model = modelOf(scene);
  Problem p = grid(log2);
  const Bvh bvh = rays::buildBvh(model.triangles, model.spheres, {});
  const rays::WideBvh wide = rays::widen(bvh);
  std::vector<sk::float4> from, along;
  for (const Ray& r : raysOf(scene, kind, p)) {
    from.push_back({r.origin.x, r.origin.y, r.origin.z, r.least});
    along.push_back({r.direction.x, r.direction.y, r.direction.z, 1e30f});
  }
  std::vector<sk::float3> corners;
  for (const rays::Triangle& t : model.triangles) corners.insert(corners.end(), {t.a, t.b, t.c});
  std::vector<std::int32_t> words;
  for (const sk::int4& four : wide.nodes) words.insert(words.end(), {four.x, four.y, four.z, four.w});
  p.floats.resize(rayFloatLists);
  p.floats[rayOrigins] = flat(from);
  p.floats[rayDirections] = flat(along);
  p.floats[rayNodes] = flat(rays::pairLayout(bvh));
  p.floats[rayShapes] = flat(rays::shapeLayout(bvh.order, model));
  p.floats[rayCorners] = flat(corners);
  p.ints = {std::move(words), wide.children};
  return p;
}

Ray rayOf(const Problem& p, std::size_t i) {
  const float *o = &p.floats[rayOrigins][4 * i], *d = &p.floats[rayDirections][4 * i];
  return {{o[0], o[1], o[2]}, o[3], {d[0], d[1], d[2]}, d[3]};
}

/// Distances in double precision, by a hierarchy of the host.
class Reference {
 public:
  explicit Reference(const Model& model)
      : model_(model), bvh_(rays::buildBvh(model.triangles, model.spheres, {})) {}

  /// The nearest hit of a ray, or -1.
  double distance(const Ray& ray) const {
    double nearest = std::numeric_limits<double>::infinity();
    visit(0, ray, nearest);
    return std::isfinite(nearest) ? nearest : -1;
  }

  /// The same by a test of every triangle.
  double distanceByAll(const Ray& ray) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const rays::Triangle& t : model_.triangles) test(t, ray, nearest);
    return std::isfinite(nearest) ? nearest : -1;
  }

 private:
  static void test(const rays::Triangle& triangle, const Ray& ray, double& nearest) {
    const rays::Meeting meeting = rays::meet(triangle, ray);
    if (meeting.inside >= 0 && meeting.t >= ray.least && meeting.t < nearest) nearest = meeting.t;
  }

  static bool meets(const Bounds& b, const Ray& ray, double most) {
    double from = ray.least, to = most;
    const auto slab = [&](double low, double high, double o, double d) {
      const double s = (low - o) / d, t = (high - o) / d;
      from = std::fmax(from, std::fmin(s, t));
      to = std::fmin(to, std::fmax(s, t));
    };
    slab(b.least.x, b.most.x, ray.origin.x, ray.direction.x);
    slab(b.least.y, b.most.y, ray.origin.y, ray.direction.y);
    slab(b.least.z, b.most.z, ray.origin.z, ray.direction.z);
    return from <= to;
  }

  void visit(std::uint32_t at, const Ray& ray, double& nearest) const {
    const BvhNode& node = bvh_.nodes[at];
    if (!meets(node.bounds, ray, nearest)) return;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      test(model_.triangles[bvh_.order[i]], ray, nearest);
    if (node.count > 0) return;
    visit(node.first, ray, nearest);
    visit(node.first + 1, ray, nearest);
  }

  const Model& model_;
  Bvh bvh_;
};

template <Scene scene>
Check checkOf(const Problem& p) {
  const Reference reference(modelOf(scene));
  // Rays along edges may go either way, and single-precision tests that are not watertight miss some.
  Check check{{}, {}, 1e-5, 1e-3};
  const std::vector<std::int64_t> some = somePlaces(p.size(), 16384);
  for (std::size_t i = 0; i < some.size(); ++i) {
    const Ray ray = rayOf(p, static_cast<std::size_t>(some[i]));
    check.places.push_back(p.size() + some[i]);
    check.values.push_back(i % 1024 == 0 ? reference.distanceByAll(ray) : reference.distance(ray));
  }
  return check;
}

class NearestHits final : public OurTask {
 public:
  NearestHits(sk::Device& device, const sk::CallOptions& options, const Problem& p, const Model& model,
              const rays::DeviceSettings& settings)
      : OurTask(device),
        scene_(device, model, settings),
        closest_(rays::kernels::closest.with(options)),
        from_(filled<sk::float4>({p.rows, p.columns}, foursOf(p.floats[rayOrigins]))),
        along_(filled<sk::float4>({p.rows, p.columns}, foursOf(p.floats[rayDirections]))),
        hit_(device.stream<sk::float3>({p.rows, p.columns})),
        id_(device.stream<std::int32_t>({p.rows, p.columns})) {}

  std::vector<float> result() override {
    const std::vector<std::int32_t> ids = id_.read();
    std::vector<float> all(ids.begin(), ids.end());
    const std::vector<sk::float3> hits = hit_.read();
    for (std::size_t i = 0; i < ids.size(); ++i) all.push_back(ids[i] < 0 ? -1.0f : hits[i].x);
    return all;
  }

 private:
  static std::vector<sk::float4> foursOf(const std::vector<float>& parts) {
    std::vector<sk::float4> fours;
    for (std::size_t i = 0; i + 3 < parts.size(); i += 4)
      fours.push_back({parts[i], parts[i + 1], parts[i + 2], parts[i + 3]});
    return fours;
  }

  void once() override { scene_.call(closest_, from_, along_, hit_, id_); }

  rays::DeviceScene scene_;
  rays::kernels::ClosestKernel closest_;
  sk::Stream<sk::float4> from_, along_;
  sk::Stream<sk::float3> hit_;
  sk::Stream<std::int32_t> id_;
};

/// `isOther`: not with the nodes that are chosen for the device, two-wide or eight-wide, but with the others.
template <Scene scene>
std::unique_ptr<Task> oursBy(sk::Device& device, const sk::CallOptions& options, const Problem& p,
                             bool isOther) {
  const int others = device.name().starts_with("native") ? 2 : rays::wideChildren;
  rays::DeviceSettings settings;
  if (isOther) settings.nodes = others;
  return std::make_unique<NearestHits>(device, options, p, modelOf(scene), settings);
}

}  // namespace

Problem hallPrimaryProblem(int log2) { return problemOf<Scene::Hall, Kind::Primary>(log2); }
Problem hallDiffuseProblem(int log2) { return problemOf<Scene::Hall, Kind::Diffuse>(log2); }
Problem meshPrimaryProblem(int log2) { return problemOf<Scene::Mesh, Kind::Primary>(log2); }
Problem meshDiffuseProblem(int log2) { return problemOf<Scene::Mesh, Kind::Diffuse>(log2); }
Check hallCheck(const Problem& p) { return checkOf<Scene::Hall>(p); }
Check meshCheck(const Problem& p) { return checkOf<Scene::Mesh>(p); }
std::unique_ptr<Task> hallOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return oursBy<Scene::Hall>(device, options, p, false);
}
std::unique_ptr<Task> hallOtherOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return oursBy<Scene::Hall>(device, options, p, true);
}
std::unique_ptr<Task> meshOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return oursBy<Scene::Mesh>(device, options, p, false);
}
std::unique_ptr<Task> meshOtherOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return oursBy<Scene::Mesh>(device, options, p, true);
}

}  // namespace race
