// SPDX-License-Identifier: MIT
//
// The fields of a model on a device, and the step that its operators make: passes that a model does not need are not
// made, and streams that it does not need do not exist.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <sk/sk.hpp>

#include "model.hpp"

namespace examples {

/// What is known of one field at one moment.
struct Observation {
  double least = 0.0, most = 0.0, mean = 0.0;
  std::int64_t broken =
      -1;  ///< the first cell that is NaN or infinite, row-major from the bottom; -1 where none is
};

class Lattice {
 public:
  /// All fields are 0 until they are written.
  Lattice(sk::Device& device, const Model& model);

  const Model& model() const { return model_; }
  /// Row-major from the bottom row, and the front slice. Throws std::logic_error for a field that the model has not.
  void write(Field field, std::span<const double> values);
  std::vector<double> read(Field field);
  sk::Stream<float>& stream(Field field);

  void advance(std::int64_t steps);
  /// One step, and the largest change that it made anywhere, reduced on the device.
  double advanceAndMeasure();

  Observation observe(Field field);
  /// The mean of the fields' temperature gradient at a wall over that of conduction, by a reduction of the row next to it:
  /// the Nusselt number. Of bottom and top, or of left and right, whichever are walls: at the warmer one.
  double nusselt();
  /// Half of the mean square of the velocity.
  double kineticEnergy();
  /// The part of the cells that boil.
  double vapour();

  /// Streams that are there.
  int streams() const;

 private:
  using Fields = std::array<std::optional<sk::Stream<float>>, 6>;
  static std::size_t placeOf(Field field) { return static_cast<std::size_t>(field); }
  sk::Stream<float>& in(Fields& fields, Field field) { return *fields[placeOf(field)]; }

  sk::Stream<float> makeStream();
  void allocate(Fields& fields);
  void step(Fields& from, Fields& to);  ///< which may be one
  void stepFlow(Fields& from, Fields& to);
  void stepTemperature(Fields& from, Fields& to);
  void stepReaction(Fields& from, Fields& to);
  void diffuse(sk::Stream<float>& from, sk::Stream<float>& to);
  void rise(sk::Stream<float>& from, sk::Stream<float>& to);
  void exchange(sk::Stream<float>& before, sk::Stream<float>& after, sk::Stream<float>& to);
  sk::float4 walls() const;

  sk::Device& device_;
  Model model_;
  Coefficients c_;
  sk::CallOptions options_;
  Fields now_;
  Fields next_;  ///< made by the first advanceAndMeasure
  /// What diffusion and buoyancy make of the temperature: the latent heat compares it with what it was.
  std::optional<sk::Stream<float>> warmed_;
};

/// The largest component of a velocity anywhere.
double fastestOf(Lattice& lattice);

/// The reports on those tables of the device in which the model looks up its density.
std::vector<sk::TableReport> tablesOf(const Model& model, const sk::Device& device);

}  // namespace examples
