// SPDX-License-Identifier: MIT
//
// The arrays of the problems "rays: ...", which peers read as well. C++17, as contender.hpp.
#pragma once

namespace race {

// Problem::floats. Four floats an element but for the corners.
enum RayFloats {
  rayOrigins,  ///< a ray: origin, least distance
  rayDirections,  ///< a ray: direction, greatest distance
  rayNodes,  ///< two elements a node: (least, first) and (most, count), as rays::pairLayout has them
  rayShapes,  ///< three elements a triangle in the order of leaves: (a, id), (b, ...), (c, ...), as rays::shapeLayout has them
  rayCorners,  ///< nine floats a triangle, in the order of ids
  rayFloatLists
};

// Problem::ints: rays::WideBvh.
enum RayInts { rayWideNodes, rayWideChildren };

constexpr const char* rayPrograms[] = {"rays: interior, primary", "rays: interior, diffuse",
                                       "rays: organic mesh, primary", "rays: organic mesh, diffuse"};

/// Integers are in floats with bits that are neither NaN nor denormal: this number is added to them.
constexpr int rayIntBias = 0x40000001;

}  // namespace race
