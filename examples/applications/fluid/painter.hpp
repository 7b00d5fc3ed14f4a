// SPDX-License-Identifier: MIT
//
// Pictures of a flow: computed on its device, titled on the host.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flow.hpp"
#include "scene.hpp"
#include "support/image.hpp"

namespace fluid {

class Painter {
 public:
  Painter(sk::Device& device, const Scene& scene);

  /// If the flow is divided over ranks, all must call it; those other than the first get an empty picture.
  /// The flow as it is now, with a title and, of planes, a bar of its colours; `moment` stands below it.
  examples::Image paint(Flow& flow, const std::string& moment);

 private:
  examples::Image plane(Flow& flow);
  examples::Image space(Flow& flow);

  sk::Device& device_;
  const Scene& scene_;
  std::vector<sk::float3> colours_;
  sk::Stream<sk::float3> palette_;
  sk::Stream<float> covered_;  ///< of one element if there are no obstacles
  std::optional<linear::Vector> derived_;
  std::optional<sk::Stream<float>> light_;
  examples::Gathered<float> shown_, heat_;
  examples::ShownValues values_;
};

}  // namespace fluid
