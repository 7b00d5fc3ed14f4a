// SPDX-License-Identifier: MIT
//
// What a scene says, in numbers: the lattice, its edges, and the operators, each of which is there or not. It knows
// neither files nor devices; the limits of its time step are in limits.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <sk/options.hpp>

namespace examples {

/// As in boundary.sk.
enum class Edge : std::uint8_t { Wrap, Insulated, Wall };

/// As in phase.sk.
enum class Density : std::uint8_t { Computed, Linear, Cubic };

struct Grid {
  std::int64_t width = 256, height = 256, depth = 1;
  double spacing = 1.0;  ///< h
  std::int64_t cells() const { return width * height * depth; }
  bool isSpace() const { return depth > 1; }
};

/// Walls have the temperature at the same place in `temperatures`.
struct Boundary {
  enum Side : std::uint8_t { Left, Right, Bottom, Top };
  std::array<Edge, 4> edges = {Edge::Wrap, Edge::Wrap, Edge::Wrap, Edge::Wrap};
  std::array<double, 4> temperatures = {0.0, 0.0, 0.0, 0.0};
  bool closedZ = false;
  bool closedX() const { return edges[Left] != Edge::Wrap; }
  bool closedY() const { return edges[Bottom] != Edge::Wrap; }
};

struct Diffusion {
  double rate = 0.0;  ///< D: length^2 / time
};

/// Rising by the density tanh(alpha (T - point)).
struct Buoyancy {
  double sigma = 0.0;
  double alpha = 1.0;
  Density density = Density::Computed;
};

struct LatentHeat {
  double heat = 0.0;  ///< eta, for each neighbour
};

/// Gray and Scott's, with time and space of its own.
struct Reaction {
  double feed = 0.0, kill = 0.0;
  double diffusionU = 2e-5, diffusionV = 1e-5;
  double spacing = 2.5 / 256;
  double timeStep = 1.0;
  double stirring = 1.0;  ///< how many times as far as heat a flow carries the substances
};

/// The Boussinesq equations, incompressible but for sound that travels at `sound` (A. Chorin, 1967).
struct Flow {
  double viscosity = 0.0;
  double lift = 0.0;  ///< acceleration by a degree of warmth
  double sound = 0.0;
  double damping = 0.0;  ///< of sound: a viscosity for it alone of this times sound * h
  bool slip = false;  ///< walls without friction
  double rayleigh = 0.0, prandtl = 0.0;  ///< that it was made of
};

struct Model {
  Grid grid;
  Boundary boundary;
  double timeStep = 1.0;
  double boilingPoint = 0.0;
  std::optional<Diffusion> diffusion;
  std::optional<Buoyancy> buoyancy;
  std::optional<LatentHeat> latentHeat;
  std::optional<Reaction> reaction;
  std::optional<Flow> flow;
  sk::Precision precision = sk::Precision::Single;

  bool hasTemperature() const { return diffusion || buoyancy || latentHeat || flow; }
  bool boils() const { return buoyancy || latentHeat; }
};

/// Convection between walls at the temperatures of `model`, in units of its height H, the difference of the walls'
/// temperatures and the time of a free fall over H: viscosity sqrt(Pr / Ra), diffusivity 1 / sqrt(Ra Pr), lift 1. Sets the
/// grid's spacing (1 / cells of the height), the diffusion and the flow, whose sound is damped by 0.2.
void setConvection(Model& model, double rayleigh, double prandtl, double sound, bool slip);

/// What kernels are called with, rounded to floats as they are.
struct Coefficients {
  float spread = 0;  ///< D dt / h^2
  float carry = 0;  ///< dt / h
  float stiffness = 0;  ///< c^2 dt / h
  float viscosity = 0;  ///< nu dt / h^2
  float damping = 0;  ///< lambda dt / h^2
  float lift = 0;  ///< dt times lift
  float rest = 0, slope = 0;  ///< the temperature that does not rise: at the bottom, and more a row
  float point = 0, alpha = 0, sigma = 0, latent = 0;  ///< as phase.sk's Boiling
  float feed = 0, kill = 0, spreadU = 0, spreadV = 0, reactionStep = 0;  ///< as reaction.sk's Medium
  float stirring = 0;  ///< half of the cells that substances go in a step at a velocity of 1
};
Coefficients coefficientsOf(const Model& model);

/// The same lattice with all operators that its dimension has, those that it has not with parameters that change
/// nothing: what a program costs that models everything.
Model fullModel(const Model& model);

/// Names of the operators that it has: "diffusion", "buoyancy" ...
std::vector<std::string> operatorsOf(const Model& model);

/// The fields that it needs, in the order in which they are told and written.
enum class Field : std::uint8_t { Temperature, U, V, VelocityX, VelocityY, Pressure };
std::vector<Field> fieldsOf(const Model& model);
const char* nameOf(Field field);

}  // namespace examples
