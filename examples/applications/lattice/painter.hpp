// SPDX-License-Identifier: MIT
//
// Pictures of a lattice: computed on its device, titled on the host. If the lattice is divided over ranks, the first one gathers what
// is shown and computes the picture.
#pragma once

#include <optional>
#include <string>

#include "lattice.hpp"
#include "scene.hpp"
#include "support/figure.hpp"
#include "support/image.hpp"

namespace examples {

class Painter {
 public:
  Painter(sk::Device& device, const Scene& scene);

  /// The field as it is now, with a title and a bar of its colours; `moment` stands below it. On ranks other than the first, the
  /// pictures of paint() and plot() are empty.
  Image paint(Lattice& lattice, const std::string& moment);
  /// The field alone.
  Image plot(Lattice& lattice);

  /// The texture of what is shown, until the lattice's next step: the field itself, or colours where it is seen in space. The
  /// lattice must be on one device.
  struct Texture {
    sk::StreamTexture texture;
    bool isColour = false;
    double low = 0.0, high = 1.0;
  };
  Texture texture(Lattice& lattice);

 private:
  GridStream<float>& shown(Lattice& lattice);
  ShownValues range(const GridStream<float>& field) const;
  sk::Stream<sk::float3> plane(const sk::Stream<float>& field, ShownValues values);
  sk::Stream<sk::float3> bubbles(const sk::Stream<float>& temperature, ShownValues values, int finer);

  sk::Device& device_;
  Scene scene_;
  std::vector<sk::float3> colours_;
  sk::Stream<sk::float3> palette_;
  std::optional<GridStream<float>> derived_;
  Gathered<float> gathered_;
  std::optional<sk::Stream<sk::float3>> seen_;
  ShownValues last_;
};

}  // namespace examples
