// SPDX-License-Identifier: MIT
//
// Structs for tests, registered as element types in the same way as the headers that skc writes do it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sk/sk.hpp"

namespace sk::test {

struct Hit {
  float t;
  std::int32_t id;
  friend bool operator==(const Hit&, const Hit&) = default;
};
inline constexpr const char* hitDeclaration = "struct Hit { float t; int id; };\n";

/// Every scalar type, a vector of three, bools, and padding.
struct Particle {
  float3 position;
  bool alive;
  int2 cell;
  bool3 flags;
  std::uint32_t color;
  friend bool operator==(const Particle&, const Particle&) = default;
};
inline constexpr const char* particleDeclaration =
    "struct Particle { vec3 position; bool alive; ivec2 cell; bvec3 flags; uint color; };\n";

}  // namespace sk::test

template <>
struct sk::ElementTraits<sk::test::Hit> {
  static constexpr sk::program::Field fields[] = {
      {"t", sk::program::Scalar::Float, 1, offsetof(sk::test::Hit, t)},
      {"id", sk::program::Scalar::Int, 1, offsetof(sk::test::Hit, id)}};
  static constexpr sk::program::Element value{"Hit", "Hit", sizeof(sk::test::Hit), fields};
  static constexpr const sk::program::Element& element() { return value; }
};

template <>
struct sk::ElementTraits<sk::test::Particle> {
  static constexpr sk::program::Field fields[] = {
      {"position", sk::program::Scalar::Float, 3, offsetof(sk::test::Particle, position)},
      {"alive", sk::program::Scalar::Bool, 1, offsetof(sk::test::Particle, alive)},
      {"cell", sk::program::Scalar::Int, 2, offsetof(sk::test::Particle, cell)},
      {"flags", sk::program::Scalar::Bool, 3, offsetof(sk::test::Particle, flags)},
      {"color", sk::program::Scalar::Uint, 1, offsetof(sk::test::Particle, color)}};
  static constexpr sk::program::Element value{"Particle", "Particle", sizeof(sk::test::Particle), fields};
  static constexpr const sk::program::Element& element() { return value; }
};
