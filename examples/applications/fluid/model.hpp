// SPDX-License-Identifier: MIT
//
// What a flow is made of: its grid, what bounds it, and what acts on it. Lengths are in units of the scene; the spacing of the grid is
// the same along all axes. It knows no device.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "cell_kinds.hpp"

namespace fluid {

using Triple = std::array<double, 3>;

enum class Scheme { SemiLagrangian, MacCormack, Bfecc, Central };
enum class Side { Periodic, Wall, Slip, Inflow, Outflow };
/// In the order of Model::sides.
inline constexpr std::array<std::string_view, 6> sideNames = {"left", "right", "bottom",
                                                              "top",  "back",  "front"};

struct Sphere {
  Triple centre{};
  double radius = 0.0;
};
struct Brick {
  Triple low{}, high{};
};

/// A sphere, a disc in a plane, or a box.
struct Shape {
  std::optional<Sphere> sphere;
  std::optional<Brick> brick;
  /// Below 0 inside; the distance from the surface near it. Along z only in space.
  double distance(const Triple& p, bool isSpace) const;
};

struct Source {
  Shape shape;
  double smoke = 0.0;  ///< what is held inside of it
  double temperature = 0.0;
};

struct Buoyancy {
  double lift = 0.0;  ///< acceleration upwards, along y, for each degree above `ambient`
  double ambient = 0.0;
  double sink = 0.0;  ///< acceleration downwards for smoke of density 1
};

struct Viscosity {
  double value = 0.0;  ///< kinematic
  bool isImplicit = false;
};

/// What preconditions the conjugate gradients of the projection.
enum class Projector {
  Chebyshev,  ///< four steps of Chebyshev's iteration
  Multigrid,  ///< a V-cycle
};

struct Model {
  std::array<std::int64_t, 3> cells = {64, 64, 1};  ///< along x, y, z
  double spacing = 1.0 / 64;
  Scheme scheme = Scheme::MacCormack;
  std::array<Side, 6> sides{};  ///< left, right, bottom, top, back, front
  std::array<Triple, 6> sideVelocity{};  ///< of moving walls, and of inflows
  std::vector<Shape> obstacles;
  std::vector<bool>
      mask;  ///< cells that obstacles from files cover, x fastest, without the layer; empty: none
  bool obstaclesSlip = false;
  std::vector<Source> sources;
  std::optional<Viscosity> viscosity;
  std::optional<Buoyancy> buoyancy;
  Triple force{};  ///< an acceleration that acts everywhere
  bool hasSmoke = false;
  bool hasHeat = false;
  double cfl = 1.0;  ///< what the time step is chosen for, if none is given
  std::optional<double> timeStep;
  double tolerance =
      1e-4;  ///< of the root mean square of divergence * spacing, as a part of the largest speed
  int mostIterations = 2000;
  Projector projector = Projector::Chebyshev;
  sk::Precision precision = sk::Precision::Single;

  bool isSpace() const { return cells[2] > 1; }
  int rank() const { return isSpace() ? 3 : 2; }
  bool isPeriodic(int axis) const { return sides[static_cast<std::size_t>(2 * axis)] == Side::Periodic; }
  /// With the layer around the grid, slowest first, as streams have it.
  sk::Shape shape() const;
  /// The position of the centre of a cell that is counted with the layer.
  Triple centre(const std::array<std::int64_t, 3>& at) const;
  std::int64_t index(const std::array<std::int64_t, 3>& at) const;
  Bounds bounds() const;
  bool hasObstacles() const { return !obstacles.empty() || !mask.empty(); }
  /// Whether the mask covers a cell that is counted with the layer.
  bool isMasked(const std::array<std::int64_t, 3>& at) const;
  bool carriesHeat() const { return hasHeat; }
};

/// What a cell in the layer at a side is.
Cell cellOf(Side side);

/// "64 x 48", or "64 x 48 x 32" in space.
std::string sizeText(const Model& model);
/// "heat, smoke, viscosity, obstacles ...": what is computed, for people.
std::string operatorsOf(const Model& model);

/// What every cell is, the layer included; row-major as the streams.
std::vector<std::int8_t> cellsOf(const Model& model);

/// How much of each cell an obstacle covers, from 0 to 1, for pictures.
std::vector<double> coverageOf(const Model& model);

/// What has no solution, as a sentence with a way out: no fluid at all, or a part of it with flow in or out through its sides that nothing balances. ""
/// if all is well.
std::string contradiction(const Model& model);

/// How many cells are fluid.
std::int64_t fluidCells(const std::vector<std::int8_t>& cells);

/// The velocities of walls and inflows along an axis, and what is given inside of the flow, at the faces of all cells, the layer included.
std::vector<double> givenVelocity(const Model& model, int axis, const Triple& inside);

}  // namespace fluid
