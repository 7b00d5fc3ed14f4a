// SPDX-License-Identifier: MIT
//
// What kernels that follow paths need beside shapes: what the scene has, its camera, materials, lights and textures, on a device.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sk/sk.hpp>

#include "engine.hpp"
#include "model.hpp"
#include "path.sk.hpp"

namespace rays {

struct PathTables {
  PathTables(sk::Device& device, const Model& model, const Picture& picture);

  /// What is compiled, and what is left out.
  std::string account() const;

  int features;  ///< bits of Feature in scattering.sk
  Sampling sampling;
  std::uint32_t seed;
  kernels::View view;
  kernels::Setting setting{};
  sk::Stream<sk::float4> materials, corners, lights, sky, texels;
  sk::Stream<sk::int4> textures;
};

/// The mean of samples of a picture, which are summed in double precision.
class Exposure {
 public:
  Exposure(sk::Device& device, const Picture& picture);

  /// A sample of each pixel, for kernels to write before `add`.
  sk::Stream<sk::float3> radiance;
  void add();
  std::vector<sk::float3> image();
  /// As Renderer::variance.
  std::vector<sk::float3> variance();

 private:
  std::int64_t passes_ = 0;
  sk::Stream<sk::double3> sum_, squares_;
  sk::Stream<sk::float3> mean_;
};

}  // namespace rays
