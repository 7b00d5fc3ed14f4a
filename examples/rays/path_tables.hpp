// SPDX-License-Identifier: MIT
//
// The arguments of kernels that follow paths, apart from shapes: the scene's features, camera, materials, lights and textures, on a device.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sk/sk.hpp>

#include "engine.hpp"
#include "exposure.hpp"
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

/// What renderers of paths share: all but the way of a pass.
class PathsRenderer : public Renderer {
 public:
  PathsRenderer(sk::Device& device, const Model& model, const Picture& picture)
      : tables_(device, model, picture),
        exposure_(device, picture),
        picture_(picture),
        noPixels_(device.stream<sk::int2>({1})) {}

  void look(const Camera& camera) override;
  Exposure& exposure() override { return exposure_; }
  std::vector<std::string> account() override { return {tables_.account()}; }

 protected:
  /// The features of the tables, with a list of pixels where some have stopped.
  int features() const { return tables_.features | (exposure_.isSparse() ? listed : 0); }
  /// The list of active pixels; a stream of one element if all pixels are active, since kernels do not read it then.
  const sk::Stream<sk::int2>& pixels() const { return exposure_.isSparse() ? exposure_.pixels() : noPixels_; }
  /// Calls `follow(radiance)`, a kernel that makes a path of each element, for the active pixels, and adds the samples.
  template <class Follow>
  void passBy(Follow&& follow) {
    if (!exposure_.isSparse()) {
      follow(exposure_.radiance);
    } else if (exposure_.activePixels() > 0) {
      follow(exposure_.list());
      exposure_.deliver();
    }
    exposure_.add();
  }

  PathTables tables_;
  Exposure exposure_;

 private:
  static constexpr int listed = 16384;  ///< as in scattering.sk

  Picture picture_;
  sk::Stream<sk::int2> noPixels_;
};

}  // namespace rays
