// SPDX-License-Identifier: MIT
#include "model.hpp"

#include <cmath>

namespace examples {

void setConvection(Model& model, double rayleigh, double prandtl, double sound, bool slip) {
  model.grid.spacing = 1.0 / static_cast<double>(model.grid.height);
  model.diffusion = Diffusion{1.0 / std::sqrt(rayleigh * prandtl)};
  model.flow = Flow{.viscosity = std::sqrt(prandtl / rayleigh),
                    .lift = 1.0,
                    .sound = sound,
                    .damping = 0.2,
                    .slip = slip,
                    .rayleigh = rayleigh,
                    .prandtl = prandtl};
}

Coefficients coefficientsOf(const Model& model) {
  const double h = model.grid.spacing, dt = model.timeStep;
  const auto& [edges, temperatures, closedZ] = model.boundary;
  Coefficients c;
  c.point = static_cast<float>(model.boilingPoint);
  if (model.diffusion) c.spread = static_cast<float>(model.diffusion->rate * dt / (h * h));
  if (model.buoyancy) {
    c.alpha = static_cast<float>(model.buoyancy->alpha);
    c.sigma = static_cast<float>(model.buoyancy->sigma);
  }
  if (model.latentHeat) c.latent = static_cast<float>(model.latentHeat->heat);
  if (model.reaction) {
    const Reaction& r = *model.reaction;
    const double perCell = r.timeStep / (r.spacing * r.spacing);
    c.feed = static_cast<float>(r.feed);
    c.kill = static_cast<float>(r.kill);
    c.spreadU = static_cast<float>(r.diffusionU * perCell);
    c.spreadV = static_cast<float>(r.diffusionV * perCell);
    c.reactionStep = static_cast<float>(r.timeStep);
    c.stirring = static_cast<float>(0.5 * r.stirring * dt / h);
  }
  if (model.flow) {
    const Flow& f = *model.flow;
    c.carry = static_cast<float>(dt / h);
    c.stiffness = static_cast<float>(f.sound * f.sound * dt / h);
    c.viscosity = static_cast<float>(f.viscosity * dt / (h * h));
    c.damping = static_cast<float>(f.damping * f.sound * dt / h);
    c.lift = static_cast<float>(f.lift * dt);
    // Between plates, what conduction alone would make of the temperature; else the mean of the walls at the sides.
    const bool plates = edges[Boundary::Bottom] == Edge::Wall && edges[Boundary::Top] == Edge::Wall;
    const double bottom = temperatures[Boundary::Bottom], top = temperatures[Boundary::Top];
    const double sides = 0.5 * (temperatures[Boundary::Left] + temperatures[Boundary::Right]);
    c.rest = static_cast<float>(plates ? bottom : sides);
    c.slope = static_cast<float>(plates ? (top - bottom) / static_cast<double>(model.grid.height) : 0.0);
  }
  return c;
}

Model fullModel(const Model& model) {
  Model full = model;
  if (!full.diffusion) full.diffusion.emplace();
  if (!full.buoyancy) full.buoyancy.emplace();
  if (!full.latentHeat) full.latentHeat.emplace();
  if (model.grid.isSpace()) return full;
  if (!full.reaction) full.reaction.emplace();
  if (!full.flow) full.flow.emplace();
  return full;
}

std::vector<std::string> operatorsOf(const Model& model) {
  std::vector<std::string> names;
  if (model.diffusion) names.emplace_back("diffusion");
  if (model.buoyancy) names.emplace_back("buoyancy");
  if (model.latentHeat) names.emplace_back("latent heat");
  if (model.reaction) names.emplace_back("reaction");
  if (model.flow) names.emplace_back("flow");
  return names;
}

std::vector<Field> fieldsOf(const Model& model) {
  std::vector<Field> fields;
  if (model.hasTemperature()) fields.push_back(Field::Temperature);
  if (model.reaction) fields.insert(fields.end(), {Field::U, Field::V});
  if (model.flow) fields.insert(fields.end(), {Field::VelocityX, Field::VelocityY, Field::Pressure});
  return fields;
}

const char* nameOf(Field field) {
  switch (field) {
    case Field::Temperature: return "temperature";
    case Field::U: return "u";
    case Field::V: return "v";
    case Field::VelocityX: return "vx";
    case Field::VelocityY: return "vy";
    case Field::Pressure: return "pressure";
  }
  return "";
}

}  // namespace examples
