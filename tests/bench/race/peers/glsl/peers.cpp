// SPDX-License-Identifier: MIT
#include <exception>
#include <memory>

#include <fmt/format.h>

#include "peers/glsl/all.hpp"

namespace race {

void addGlslPeers(const std::string& renderer, Field& field) {
  // The context lives as long as the program: tasks refer to it.
  static std::unique_ptr<bench::PlainContext> context;
  try {
    context = std::make_unique<bench::PlainContext>(renderer);
  } catch (const std::exception& error) {
    field.absent.push_back(fmt::format("hand-written GLSL: {}", error.what()));
    return;
  }
  addGlslSaxpy(*context, field.contenders);
  addGlslSums(*context, field.contenders);
  addGlslStencils(*context, field.contenders);
  addGlslRays(*context, field.contenders);
  addGlslMandelbrot(*context, field.contenders);
}

}  // namespace race
