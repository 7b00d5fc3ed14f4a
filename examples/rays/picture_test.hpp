// SPDX-License-Identifier: MIT
//
// Pictures of scenes that a test writes as text.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <sk/sk.hpp>

#include "engine.hpp"
#include "scene.hpp"
#include "support/testing.hpp"

namespace rays {

/// Renders `samples` samples of each pixel by an engine of the scene, and returns the red, green and blue of all pixels, in row-major order.
/// The text is written to `file` meanwhile, whose name no other test may have.
inline std::vector<float> pictureBy(sk::Device& device, const std::string& scene, const char* file,
                                    const char* engine, int samples) {
  const examples::WrittenFile written(scene, file);
  const Scene read = readScene(written.path(), {});
  const std::unique_ptr<Engine> made = read.engines.at(engine)(device, read.model);
  const std::unique_ptr<Renderer> renderer = made->renderer(read.picture);
  for (int i = 0; i < samples; ++i) renderer->pass(i);
  std::vector<float> components;
  for (const sk::float3& p : renderer->image()) components.insert(components.end(), {p.x, p.y, p.z});
  return components;
}

}  // namespace rays
