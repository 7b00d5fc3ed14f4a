// SPDX-License-Identifier: MIT
//
// Streams with known elements, and every operation on them: the tests of faults try each in turn.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sk/sk.hpp"

namespace faults {

class Scene {
 public:
  /// Makes streams of about `size` x 8 elements. No two sizes share textures.
  Scene(sk::Device& device, std::int64_t size);

  /// The bytes of every stream; nullopt for a stream whose elements were lost.
  using Elements = std::vector<std::optional<std::vector<std::byte>>>;
  Elements elements() const;
  /// Writes the initial elements to all streams.
  void reset();
  /// Writes the initial elements to `x` and `box`, of which calls expect results.
  void resetInputs();

  sk::Device& device;
  const std::int64_t size;
  const std::vector<float> fives;  ///< as many as `x` has elements
  const std::vector<std::int32_t> rowStarts;  ///< of `x`
  sk::Stream<float> x, r, s, box, part, pushed;
  sk::Stream<float> halves[2];  ///< of the shape of `part`, stored as halves
  sk::Stream<std::int32_t> indices, bins;
  sk::Stream<sk::float4> wide[6];
};

struct Scenario {
  std::string name;
  std::vector<std::string> operations;  ///< the names by which errors of exhausted memory begin
  std::function<void(Scene&)> call;
  bool needsGl = false;
  bool moves = false;  ///< whether the call moves elements to another texture without changing them
  bool overwrites = false;  ///< whether the call gives every element of what it writes, and reads none of it
};
const std::vector<Scenario>& scenarios();

}  // namespace faults
