// SPDX-License-Identifier: MIT
#include "limits.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace examples {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

}  // namespace

double diffusionLimit(double rate, double spacing, int dimensions) {
  return rate > 0.0 && dimensions > 0 ? spacing * spacing / (2.0 * dimensions * rate) : unlimited;
}

double reactionLimit(const Reaction& r, int dimensions) {
  const double decay = 4.0 * dimensions * r.diffusionU / (r.spacing * r.spacing) + r.feed;
  return decay > 0.0 ? 2.0 / decay : unlimited;
}

double soundLimit(const Flow& flow, double spacing) {
  const double c2 = flow.sound * flow.sound, h2 = spacing * spacing;
  const double nu = flow.viscosity + flow.damping * flow.sound * spacing;
  if (c2 == 0.0) return diffusionLimit(nu, spacing, 2);
  return (std::sqrt(4.0 * nu * nu + 2.0 * c2 * h2) - 2.0 * nu) / (2.0 * c2);
}

int dimensionsOf(const Grid& grid) {
  return static_cast<int>(grid.width > 1) + static_cast<int>(grid.height > 1) +
         static_cast<int>(grid.depth > 1);
}

std::vector<Limit> limitsOf(const Model& model) {
  const int dimensions = dimensionsOf(model.grid);
  std::vector<Limit> limits;
  if (model.diffusion) {
    limits.push_back({"diffusion", fmt::format("h^2 / {}D", 2 * dimensions),
                      diffusionLimit(model.diffusion->rate, model.grid.spacing, dimensions), model.timeStep});
  }
  if (model.flow) {
    limits.push_back({"flow", "2 c^2 dt^2 + 4 (nu + lambda) dt = h^2",
                      soundLimit(*model.flow, model.grid.spacing), model.timeStep});
  }
  if (model.reaction) {
    limits.push_back({"reaction", fmt::format("2 / ({} Du / h^2 + F)", 4 * dimensions),
                      reactionLimit(*model.reaction, dimensions), model.reaction->timeStep});
  }
  return limits;
}

}  // namespace examples
