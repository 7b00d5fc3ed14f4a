// SPDX-License-Identifier: MIT
//
// The ray engine (N. Carr, J. Hall, J. Hart, "The ray engine", 2002): the device does one thing, it intersects rays with triangles. The host sorts rays
// into buckets, finds the shapes that a bucket may hit, and deals with what came back while the device works on other buckets.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "engine.hpp"
#include "support/scene_file.hpp"

namespace rays {

/// How a triangle is tested, as in ray_engine.sk.
enum class BucketTest : std::uint8_t { Watertight, Moller, Modified };

struct RayEngineSettings {
  BucketTest test = BucketTest::Modified;
  int bucket = 256;  ///< rays; a multiple of 64, for a bucket is 64 wide
  int cache = 64;  ///< buckets of rays that the host keeps before it sends one
  int shapesPerCall = 64;
  int inFlight = 4;  ///< buckets on the device while the host goes on; 0: it waits for each
  int leaf = 16;  ///< shapes in a leaf of the octree
};

/// What the engine has done since it was made.
struct BucketCount {
  std::int64_t rays = 0;
  std::int64_t buckets = 0;
  std::int64_t calls = 0;
  std::int64_t tests = 0;  ///< of a ray with a shape, rays that fill a bucket up included
};

class RayEngine : public Engine {
 public:
  virtual const BucketCount& count() const = 0;
};

/// [ray_engine]: intersection = "modified", "moller" or "watertight", bucket, cache, shapes_per_call, in_flight, leaf.
MakeEngine readRayEngine(const std::optional<examples::SceneTable>& settings);

std::unique_ptr<RayEngine> makeRayEngine(sk::Device& device, const Model& model,
                                         const RayEngineSettings& settings);

}  // namespace rays
