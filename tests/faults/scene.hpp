// SPDX-License-Identifier: MIT
//
// Streams with known elements, and everything that can be done with them: what the tests of faults try out, call by call.
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
  /// Streams of `size` x 8 elements or so; each size takes textures that no other does.
  Scene(sk::Device& device, std::int64_t size);

  /// The bytes of every stream; none of one that says that it was lost.
  using Elements = std::vector<std::optional<std::vector<std::byte>>>;
  Elements elements() const;
  /// Writes all streams anew.
  void reset();

  sk::Device& device;
  const std::int64_t size;
  const std::vector<float> fives;  ///< as many as `x` has elements
  sk::Stream<float> x, r, s, box, part, pushed;
  sk::Stream<std::int32_t> indices, bins;
  sk::Stream<sk::float4> wide[6];
};

struct Scenario {
  std::string name;
  std::function<void(Scene&)> call;
  bool needsGl = false;
  bool moves = false;  ///< elements, which stay the same
};
const std::vector<Scenario>& scenarios();

}  // namespace faults
