// SPDX-License-Identifier: MIT
//
// The fields of a model on a device, or divided over several, and the step that its operators make: passes that a model does not need are not
// made, and streams that it does not need do not exist.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <sk/sk.hpp>

#include "model.hpp"
#include "support/grid_stream.hpp"

namespace examples {

/// The extents of a lattice's streams.
sk::Shape shapeOf(const Grid& grid);

/// What is known of one field at one moment.
struct Observation {
  double least = 0.0, most = 0.0, mean = 0.0;
  std::int64_t broken = 0;  ///< cells that are NaN or infinite
};

/// If its space is divided over ranks, all ranks make the same calls, and get the same numbers.
class Lattice {
 public:
  /// All fields are 0 until they are written. The space has the shape of the model's grid.
  Lattice(const Space& space, const Model& model);
  Lattice(sk::Device& device, const Model& model);

  const Model& model() const { return model_; }
  const Space& space() const { return space_; }
  /// All cells, row-major from the bottom row, and the front slice; on the first rank, if there are several. Throws
  /// std::logic_error for a field that the model has not.
  void write(Field field, std::span<const double> values);
  std::vector<double> read(Field field);
  GridStream<float>& stream(Field field);

  void advance(std::int64_t steps);
  /// One step, and the largest change that it made anywhere, reduced on the device.
  double advanceAndMeasure();

  Observation observe(Field field);
  /// The first cell that is NaN or infinite, row-major from the bottom; on the first rank. -1 where none is.
  std::int64_t firstBroken(Field field);
  /// The mean of the fields' temperature gradient at a wall over that of conduction, by a sum over the row next to it:
  /// the Nusselt number. Of bottom and top, or of left and right, whichever are walls: at the warmer one.
  double nusselt();
  /// Half of the mean square of the velocity.
  double kineticEnergy();
  /// The part of the cells that boil.
  double vapour();

  /// Streams that are there.
  int streams() const;
  /// Streams of a model's lattice before the first advanceAndMeasure().
  static int streamsOf(const Model& model);
  /// Bytes that an element of a stream has.
  static double bytesOf(sk::Precision precision);

 private:
  using Fields = std::array<std::optional<GridStream<float>>, 6>;
  static std::size_t placeOf(Field field) { return static_cast<std::size_t>(field); }
  GridStream<float>& in(Fields& fields, Field field) { return *fields[placeOf(field)]; }

  GridStream<float> makeStream(std::string_view name);
  void allocate(Fields& fields);
  void step(Fields& from, Fields& to);  ///< which may be one
  void stepFlow(Fields& from, Fields& to);
  void stepTemperature(Fields& from, Fields& to);
  void stepReaction(Fields& from, Fields& to);
  void rise(GridStream<float>& from, GridStream<float>& to);
  void exchange(GridStream<float>& before, GridStream<float>& after, GridStream<float>& to);

  Space space_;
  Model model_;
  Coefficients c_;
  sk::CallOptions options_;
  sk::CallOptions sums_;  ///< for reductions that add
  Fields now_;
  Fields next_;  ///< made by the first advanceAndMeasure
  /// What diffusion and buoyancy make of the temperature: the latent heat compares it with what it was.
  std::optional<GridStream<float>> warmed_;
};

/// The largest component of a velocity anywhere.
double fastestOf(Lattice& lattice);

/// The reports on those tables of the device in which the model looks up its density.
std::vector<sk::TableReport> tablesOf(const Model& model, const sk::Device& device);

}  // namespace examples
