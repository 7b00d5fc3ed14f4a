// SPDX-License-Identifier: MIT
#include "scene_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "mesh.hpp"
#include "raster_file.hpp"
#include "shapes.hpp"

namespace rays {
namespace {

using examples::Range;
using examples::SceneTable;

constexpr std::array<std::string_view, 8> shapeNames = {"quad",  "box",     "sponge", "sphere",
                                                        "torus", "terrain", "gyroid", "teapot"};
/// Ids are ints, and so are three times them.
constexpr std::int64_t mostTriangles = std::int64_t{1} << 28;

/// p -> rows * p + move.
struct Transform {
  std::array<Vector, 3> rows = {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};
  Vector move;

  Vector point(Vector p) const { return turned(p) + move; }
  Vector turned(Vector p) const { return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)}; }
  /// Normals transform by the matrix of cofactors, which is the transpose of the inverse up to a factor.
  Vector normal(Vector n) const {
    return {dot(cross(rows[1], rows[2]), n), dot(cross(rows[2], rows[0]), n),
            dot(cross(rows[0], rows[1]), n)};
  }
};

/// Whole quarter turns stay exact.
Transform rotation(const std::array<double, 4>& axisAndDegrees) {
  const Vector axis = normalized(Vector{axisAndDegrees[0], axisAndDegrees[1], axisAndDegrees[2]});
  const double quarters = axisAndDegrees[3] / 90.0;
  double s = std::sin(quarters * std::numbers::pi / 2), c = std::cos(quarters * std::numbers::pi / 2);
  if (quarters == std::floor(quarters)) {
    s = std::round(s);
    c = std::round(c);
  }
  const Vector k = (1 - c) * axis;
  return {{Vector{c + k.x * axis.x, k.x * axis.y - s * axis.z, k.x * axis.z + s * axis.y},
           Vector{k.y * axis.x + s * axis.z, c + k.y * axis.y, k.y * axis.z - s * axis.x},
           Vector{k.z * axis.x - s * axis.y, k.z * axis.y + s * axis.x, c + k.z * axis.z}},
          {}};
}

/// Scaled first, then turned, then moved.
Transform readTransform(const SceneTable& table) {
  Vector scale{1, 1, 1};
  if (const auto s = table.numbers("scale", -1, Range{-1e18, 1e18})) {
    if (s->size() != 1 && s->size() != 3) table.refuse("scale", "is one number in brackets, or three");
    scale = s->size() == 1 ? Vector{(*s)[0], (*s)[0], (*s)[0]} : Vector{(*s)[0], (*s)[1], (*s)[2]};
    if (scale.x == 0 || scale.y == 0 || scale.z == 0) table.refuse("scale", "must not be 0");
  }
  Transform t;
  if (const auto r = table.numbers("rotate", 4)) {
    if ((*r)[0] == 0 && (*r)[1] == 0 && (*r)[2] == 0)
      table.refuse("rotate", "is an axis, which is not zero, and an angle in degrees");
    t = rotation({(*r)[0], (*r)[1], (*r)[2], (*r)[3]});
  }
  for (Vector& row : t.rows) row = {row.x * scale.x, row.y * scale.y, row.z * scale.z};
  table.read("translate", t.move);
  return t;
}

bool isFinite(Vector p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }
bool isFinite(const sk::float3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// A mesh of the scene, with its materials in the model.
struct Named {
  std::string label{};  ///< for messages
  Mesh mesh;
  std::int32_t firstMaterial = 0;
  bool ownMaterials = false;
};

Mesh computedMesh(const SceneTable& table, std::size_t shape, int mostLevel) {
  const auto whole = [&](std::string_view key, std::int64_t otherwise, double least, double most) {
    return static_cast<int>(table.integer(key, Range{least, most}).value_or(otherwise));
  };
  switch (shape) {
    case 0: return quad();
    case 1: return box();
    case 2: return sponge(std::min(whole("level", 3, 0, 5), mostLevel));
    case 3:
      return icosphere(std::min(whole("level", 4, 0, 8), mostLevel), table.flag("smooth").value_or(true));
    case 4: {
      // At a given level a torus has about as many triangles as the other shapes.
      const int most = 3 << std::min(mostLevel, 20);
      const int around = std::min(whole("around", 64, 3, 4096), 2 * most),
                across = std::min(whole("across", 32, 3, 4096), most);
      return torus(around, across, table.number("tube", Range{1e-3, 0.25}).value_or(0.15));
    }
    case 5: {
      const int level = std::min(whole("level", 7, 0, 11), mostLevel);
      const auto seed = static_cast<std::uint32_t>(whole("seed", 1, 0, 2147483647));
      return terrain(level, table.number("height", Range{0, 100}).value_or(0.3), seed);
    }
    case 6: {
      // Natively, so that all devices see the same triangles.
      sk::Device device = sk::Device::native();
      const int cells = std::min(whole("cells", 96, 8, 400), 8 << std::min(mostLevel, 20));
      return gyroid(device, cells, table.number("turns", Range{0.25, 32}).value_or(3.0),
                    table.number("thickness", Range{0.02, 1.4}).value_or(0.3));
    }
    case 7: return teapot(std::min(whole("level", 12, 1, 256), mostLevel));
    default: throw std::logic_error("a shape without a mesh");
  }
}

Mesh meshOf(const SceneTable& table, const Reading& reading, bool wantsMaterials) {
  const auto shape = table.choice("shape", shapeNames);
  const auto file = table.text("file");
  if (shape && file) table.refuse("shape", "and 'file' exclude each other");
  if (shape) return computedMesh(table, *shape, reading.mostLevel);
  if (!file) table.refuse("file", "is missing; name an OBJ or PLY file, or a 'shape'");
  const std::filesystem::path path = reading.folder / *file;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    table.refuse("file", fmt::format("'{}' does not exist", path.string()));
  return loadMesh(path, wantsMaterials);
}

/// Tells of vertices that are not finite, by their numbers from 0, where a face has them.
void tellBroken(const Named& named, Reading& reading) {
  std::vector<bool> isBroken(named.mesh.points.size());
  std::string list;
  int broken = 0;
  for (const Face& face : named.mesh.faces) {
    for (const std::uint32_t p : face.points) {
      if (isBroken[p] || isFinite(named.mesh.points[p])) continue;
      isBroken[p] = true;
      if (++broken <= 4) list += fmt::format("{}{}", broken == 1 ? "" : ", ", p);
    }
  }
  if (broken == 0) return;
  const std::string message = fmt::format(
      "{}: {} not finite ({}{}, counted from 0)", named.label,
      broken == 1 ? "a vertex is" : fmt::format("{} vertices are", broken), list, broken > 4 ? " ..." : "");
  if (reading.strict) throw std::runtime_error(message);
  reading.warnings.push_back(message + "; the triangles of it are left out");
}

class Placing {
 public:
  Placing(Model& model) : model_(model) {}

  void add(const SceneTable& table, const Named& named, const Transform& transform,
           std::optional<std::int32_t> material) {
    const Mesh& mesh = named.mesh;
    if (std::int64_t{model_.triangleCount} + static_cast<std::int64_t>(mesh.faces.size()) > mostTriangles)
      table.fail("file", fmt::format("the scene has more than {} triangles", mostTriangles));
    std::vector<sk::float3> points;
    points.reserve(mesh.points.size());
    for (const Vector& p : mesh.points) points.push_back(toFloat3(transform.point(p)));
    const bool hasCorners = !mesh.corners.empty();
    if (hasCorners) model_.corners.resize(model_.triangles.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const Face& face = mesh.faces[f];
      const auto point = [&](std::size_t i) { return points[face.points[i]]; };
      const std::int32_t id = model_.triangleCount++;
      if (!isFinite(point(0)) || !isFinite(point(1)) || !isFinite(point(2))) {
        ++model_.leftOut;
        continue;
      }
      const std::int32_t own =
          face.material >= 0 && named.ownMaterials ? named.firstMaterial + face.material : 0;
      model_.triangles.push_back({point(0), point(1), point(2), id, material.value_or(own)});
      if (hasCorners)
        model_.corners.push_back(cornersOf(mesh.corners[f], transform));
      else if (!model_.corners.empty())
        model_.corners.emplace_back();
    }
  }

 private:
  static Corners cornersOf(Corners corners, const Transform& transform) {
    for (sk::float3& n : corners.normals)
      n = toFloat3(normalized(transform.normal(examples::vecOf<double>(n))));
    return corners;
  }

  Model& model_;
};

Named readMesh(const SceneTable& table, std::size_t number, Reading& reading, Model& model) {
  const bool wantsMaterials = !table.has("material");
  Named named{.mesh = meshOf(table, reading, wantsMaterials)};
  named.label = table.text("file").value_or(fmt::format("mesh {}", number));
  named.ownMaterials = wantsMaterials && !named.mesh.materials.empty();
  named.firstMaterial = static_cast<std::int32_t>(model.materials.size());
  if (named.ownMaterials) {
    const auto firstTexture = static_cast<std::int32_t>(model.textures.size());
    for (Material material : named.mesh.materials) {
      if (material.texture >= 0) material.texture += firstTexture;
      model.materials.push_back(std::move(material));
    }
    for (const std::filesystem::path& file : named.mesh.textures) model.textures.push_back(loadRaster(file));
  }
  if (named.mesh.faces.empty()) reading.warnings.push_back(named.label + ": the mesh has no faces");
  tellBroken(named, reading);
  return named;
}

/// Returns the material that the table names, or nullopt where it leaves the choice to the mesh.
std::optional<std::int32_t> materialOf(const SceneTable& table, const Reading& reading) {
  return table.has("material") ? std::optional(materialNumber(table, "material", reading)) : std::nullopt;
}

void readMeshes(const SceneTable& root, Reading& reading, Model& model) {
  struct Defined {
    Named named;
    std::optional<std::int32_t> material;
  };
  std::map<std::string, Defined, std::less<>> defined;
  Placing placing(model);
  std::size_t number = 0;
  for (const SceneTable& table : root.tables("mesh")) {
    Named named = readMesh(table, ++number, reading, model);
    const std::optional<std::int32_t> material = materialOf(table, reading);
    const Transform transform = readTransform(table);
    if (table.flag("placed").value_or(true)) placing.add(table, named, transform, material);
    const std::optional<std::string> name = table.text("name");
    if (!name) continue;
    if (!defined.try_emplace(*name, Defined{std::move(named), material}).second)
      table.refuse("name", fmt::format("'{}' is taken by another mesh", *name));
  }
  for (const SceneTable& table : root.tables("instance")) {
    const std::string of = table.text("of").value_or("");
    const auto found = defined.find(of);
    if (found == defined.end()) table.refuse("of", fmt::format("names no mesh: '{}'", of));
    const std::optional<std::int32_t> material = materialOf(table, reading);
    placing.add(table, found->second.named, readTransform(table),
                material ? material : found->second.material);
  }
}

void readRound(const SceneTable& root, const Reading& reading, Model& model) {
  for (const SceneTable& table : root.tables("sphere")) {
    const Vector centre = table.vector("centre").value_or(Vector{});
    const double radius = table.number("radius", positiveLength).value_or(1.0);
    model.spheres.push_back(
        {toFloat3(centre), static_cast<float>(radius), materialNumber(table, "material", reading)});
  }
  for (const SceneTable& table : root.tables("flake")) {
    const Vector centre = table.vector("centre").value_or(Vector{});
    const double radius = table.number("radius", positiveLength).value_or(1.0);
    const auto level = static_cast<int>(table.integer("level", Range{0, 6}).value_or(3));
    const std::int32_t material = materialNumber(table, "material", reading);
    for (Sphere sphere : sphereFlake(centre, radius, std::min(level, reading.mostLevel))) {
      sphere.material = material;
      model.spheres.push_back(sphere);
    }
  }
}

void readPlanes(const SceneTable& root, const Reading& reading, Model& model) {
  for (const SceneTable& table : root.tables("plane")) {
    const Vector normal = table.vector("normal").value_or(Vector{0, 1, 0});
    if (!(length(normal) > 0)) table.refuse("normal", "must not be zero");
    const Vector n = normalized(normal);
    const double distance = dot(n, table.vector("through").value_or(Vector{}));
    model.planes.push_back(
        {toFloat3(n), static_cast<float>(distance), materialNumber(table, "material", reading)});
  }
  if (model.planes.size() > 64)
    throw std::runtime_error("a scene has 64 planes at most; make meshes of them");
}

double largest(const sk::float3& p) {
  return std::max({std::abs(double(p.x)), std::abs(double(p.y)), std::abs(double(p.z))});
}

sk::float3 scaled(const sk::float3& p, float by) { return {p.x * by, p.y * by, p.z * by}; }

}  // namespace

sk::float3 colourOf(const SceneTable& table, std::string_view key, sk::float3 otherwise) {
  const auto v = table.numbers(key, 3, Range{0.0, 1e30});
  return v ? toFloat3(Vector{(*v)[0], (*v)[1], (*v)[2]}) : otherwise;
}

std::int32_t materialNumber(const SceneTable& table, std::string_view key, const Reading& reading) {
  const std::optional<std::string> name = table.text(key);
  if (!name) return 0;
  const auto found = reading.materials.find(*name);
  if (found != reading.materials.end()) return found->second;
  std::vector<std::string_view> names;
  for (const auto& [known, number] : reading.materials) names.push_back(known);
  table.choice(key, names);  // tells which there are
  table.refuse(key, "names no material");
}

void readShapes(const SceneTable& root, Reading& reading, Model& model) {
  readMeshes(root, reading, model);
  readRound(root, reading, model);
  readPlanes(root, reading, model);
}

void chooseUnit(Model& model) {
  double extent = 0.0;
  for (const Triangle& t : model.triangles)
    extent = std::max({extent, largest(t.a), largest(t.b), largest(t.c)});
  for (const Sphere& s : model.spheres) extent = std::max(extent, largest(s.centre) + double(s.radius));
  if (extent == 0.0) extent = std::max(1e-30, length(model.camera.to - model.camera.from));
  model.unit = std::ldexp(1.0, -std::ilogb(extent));

  const auto by = static_cast<float>(model.unit);
  for (Triangle& t : model.triangles) {
    t.a = scaled(t.a, by);
    t.b = scaled(t.b, by);
    t.c = scaled(t.c, by);
  }
  for (Sphere& s : model.spheres) {
    s.centre = scaled(s.centre, by);
    s.radius *= by;
  }
  for (Plane& p : model.planes) p.distance *= by;
  for (PointLight& light : model.points) {
    light.position = scaled(light.position, by);
    light.intensity = scaled(light.intensity, by * by);
  }
  Camera& camera = model.camera;
  camera.from = model.unit * camera.from;
  camera.to = model.unit * camera.to;
  camera.lens *= model.unit;
  camera.focus *= model.unit;
}

}  // namespace rays
