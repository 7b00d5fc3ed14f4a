// SPDX-License-Identifier: MIT
//
// A scene as its file describes it, in metres, seconds and kilograms. What the file does not name is absent here, too:
// an empty optional or list. It knows no device and no kernel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "support/record.hpp"
#include "support/vec.hpp"

namespace examples {

/// Values are those of the kernels' enumerations.
enum class Law : unsigned { Exact, Jakobsen };
enum class Verlet : unsigned { Displacements, Positions };

/// A rectangle of points, rows from its first side on, and its mass, which all points share alike.
struct Cloth {
  int columns = 65;
  int rows = 65;
  double width = 1.0;  ///< along a row
  double height = 1.0;  ///< along a column
  double mass = 0.2;  ///< kg
  double rest = 1.0;  ///< lengths of the links at rest over the distances of the points at first
  Vector origin;  ///< of the first point
  Vector right{1, 0, 0};  ///< of unit length: along a row, and along a column
  Vector down{0, 0, 1};
  double shake = 0.0;  ///< metres by which first positions are off at random, at most
  std::uint32_t seed = 1;
};

/// Links of each kind, where the scene has them.
struct LinkSettings {
  bool springs = false;  ///< stiffnesses are N/m; else parts of the excess, which relaxation takes away
  std::optional<double> structural, shear, bend;
  Law law = Law::Exact;
  int iterations = 1;
  double relaxation = 1.0;  ///< stable below 4/3 with one iteration, below 2 with more
};

struct WindSettings {
  Vector velocity;
  double density = 1.2;  ///< of the air, kg/m^3
  double across = 1.2;  ///< coefficients of drag across the cloth and along it
  double along = 0.05;
  double gust = 0.0;  ///< the part of the velocity that comes and goes
  double swirl = 0.0;  ///< that turns sideways
  double period = 1.0;  ///< of both
  double wavelength = 2.0;
};

/// Points that are held. They may be carried from one time to another.
struct Pin {
  std::vector<std::int64_t> points;
  Vector carry;  ///< the whole way
  double begin = 0.0;
  double end = 0.0;
};

enum class Kind { Sphere, Plane, Capsule, Box };

/// Something to fall on. `at`, `along` and `size` are a sphere's centre and radius (size.x); a plane's point and normal; a
/// capsule's ends at and at + along, and its radius; a box's centre and half extents, turned by a unit quaternion.
struct Body {
  Kind kind = Kind::Sphere;
  Vector at;
  Vector along;
  Vector size;
  Vector axis{0, 0, 0};  ///< vector part of the quaternion
  double turn = 1.0;  ///< its scalar part
  double friction = 0.3;
  Vector swing;  ///< it is at + swing * sin(2 pi t / period)
  double period = 1.0;
  Vector colour{0.75, 0.72, 0.68};

  /// How far it is from `at` at a time.
  Vector shift(double time) const;
};

struct RunSettings {
  double dt = 1.0 / 1200;
  std::int64_t steps = 1200;
  Verlet verlet = Verlet::Displacements;
  std::optional<double> untilSettled;  ///< m/s: the run ends when no point is faster
  int checkEvery = 100;  ///< steps between looks for broken numbers and for rest
};

/// What a run leaves behind; no picture unless one is named.
struct RecordSettings : Record {
  std::string obj;  ///< a file; empty: none
};

struct PictureSize {
  int width, height;
};

struct ViewSettings {
  Vector eye{2.5, 1.6, 3.5};
  Vector at{0, 0.8, 0};
  double fieldOfView = 35;  ///< degrees, from the top of the picture to its bottom
  Vector light{0.45, 0.8, 0.4};  ///< the direction to it
  Vector front{0.80, 0.20, 0.16};  ///< sRGB
  Vector back{0.92, 0.80, 0.55};
  Vector second{0.95, 0.93, 0.88};  ///< of the pattern
  Vector background{0.80, 0.84, 0.88};
  Vector ground{0.62, 0.60, 0.57};
  int pattern = 0;  ///< plain, stripes, checks, grid, harlequin
  double repeats = 8;  ///< of the pattern, along the longer side
  std::optional<double>
      floor;  ///< the height of the ground that is drawn; a plane that faces up gives it, too
};

struct Scene {
  std::string title;
  std::string subtitle;
  Cloth cloth;
  LinkSettings links;
  std::optional<double> tear;  ///< the strain at which links tear
  Vector gravity;
  double damping = 0.0;  ///< 1/s: the part of its speed that a point loses
  std::optional<WindSettings> wind;
  std::vector<Pin> pins;
  std::vector<Body> bodies;
  double thickness = 0.0;  ///< metres that points keep from the surface of bodies
  RunSettings run;
  RecordSettings record{{.output = {}, .framesPerSecond = 30}, {}};
  ViewSettings view;

  std::int64_t points() const { return std::int64_t{cloth.columns} * cloth.rows; }
  bool has(Kind kind) const;
};

/// Columns and rows in place of those of a file.
struct Points {
  int columns, rows;
};

/// Throws std::runtime_error, with line and column, where the file is no scene.
Scene readScene(const std::filesystem::path& file, const std::optional<Points>& points = std::nullopt);

}  // namespace examples
