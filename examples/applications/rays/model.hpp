// SPDX-License-Identifier: MIT
//
// What a scene consists of, on the host and independent of any engine: triangles in file order, spheres, planes, materials,
// lights, the camera. It knows neither files nor devices.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <sk/types.hpp>

#include "support/vec.hpp"

namespace rays {

using examples::Vector;

/// Pixels of a texture or an environment, linear, row by row from the top.
struct Raster {
  int width = 0;
  int height = 0;
  std::vector<sk::float3> pixels;
};

enum class Scattering : std::uint8_t { Diffuse, Mirror, Glass, Metal, Frosted };

struct Material {
  std::string name;
  Scattering scattering = Scattering::Diffuse;
  sk::float3 colour = {0.8f, 0.8f,
                       0.8f};  ///< albedo; of metals the reflectance at normal incidence; of glass the tint
  sk::float3 emission = {0, 0,
                         0};  ///< radiance of the front, which sees a triangle's corners counterclockwise
  bool glowsBehind = false;  ///< the back emits as well
  float ior = 1.5f;  ///< of glass, relative to outside
  float roughness = 0.0f;  ///< GGX's alpha, of metal and frosted glass
  int texture = -1;  ///< index into Model::textures; multiplies the colour

  bool emits() const { return emission.x > 0 || emission.y > 0 || emission.z > 0; }
};

/// `id` counts the triangles of all meshes and instances in the order of the scene, also those that were left out.
struct Triangle {
  sk::float3 a, b, c;
  std::int32_t id = 0;
  std::int32_t material = 0;
};

/// Normals and texture coordinates of a triangle's corners; normals are zero if the mesh has none.
struct Corners {
  std::array<sk::float3, 3> normals{};
  std::array<sk::float2, 3> texture{};
};

struct Sphere {
  sk::float3 centre{};
  float radius = 1.0f;
  std::int32_t material = 0;
};

/// The points p with dot(normal, p) = distance.
struct Plane {
  sk::float3 normal{};  ///< of unit length
  float distance = 0.0f;
  std::int32_t material = 0;
};

struct PointLight {
  sk::float3 position{};
  sk::float3 intensity{};  ///< power per solid angle
};

/// A disc at infinity.
struct Sun {
  sk::float3 towards{};  ///< unit vector to the sun
  sk::float3 irradiance{};  ///< on a surface that faces it
  float angle = 0.0f;  ///< radius of the disc in radians; 0 makes sharp shadows
};

struct Environment {
  sk::float3 colour{};  ///< radiance; multiplies the image where there is one
  Raster image;  ///< latitude and longitude, y up; empty: the same everywhere
};

struct Camera {
  Vector from{0, 0, 5}, to{0, 0, 0}, up{0, 1, 0};
  double fieldOfView = 40.0;  ///< vertical, in degrees
  double lens = 0.0;  ///< radius of the aperture; 0 is a pinhole
  double focus = 0.0;  ///< distance of what is sharp
};

/// Lengths are those of the scene file times `unit`, a power of two that brings the scene's extent near 1. Products of
/// lengths then neither overflow nor vanish in any scene, and nothing is rounded.
struct Model {
  double unit = 1.0;
  std::vector<Triangle> triangles;
  std::vector<Corners> corners;  ///< one for each triangle, or none at all
  std::int32_t triangleCount = 0;  ///< of the file; ids of spheres begin here, and those of planes after them
  std::int32_t leftOut = 0;  ///< triangles with a vertex that is not finite
  std::vector<Sphere> spheres;
  std::vector<Plane> planes;
  std::vector<Material> materials;
  std::vector<Raster> textures;
  std::vector<PointLight> points;
  std::vector<Sun> suns;
  Environment environment;
  Camera camera;

  std::int32_t sphereId(std::size_t i) const { return triangleCount + static_cast<std::int32_t>(i); }
  std::int32_t planeId(std::size_t i) const {
    return sphereId(spheres.size()) + static_cast<std::int32_t>(i);
  }
};

/// Hits count from `least` to `most` times the direction, both included.
struct Ray {
  sk::float3 origin{};
  float least = 0.0f;
  sk::float3 direction{};
  float most = std::numeric_limits<float>::infinity();
};

/// The point is (1 - u - v) a + u b + v c on a triangle. On a sphere u and v are longitude and latitude from 0 to 1; on a plane, 0.
struct Hit {
  std::int32_t id = -1;  ///< -1: nothing is hit
  float t = std::numeric_limits<float>::infinity();
  float u = 0.0f;
  float v = 0.0f;

  friend bool operator==(const Hit&, const Hit&) = default;
};

}  // namespace rays
