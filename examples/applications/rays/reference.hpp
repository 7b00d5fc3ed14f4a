// SPDX-License-Identifier: MIT
//
// Hits by loops in double precision over everything there is: what engines are held against.
#pragma once

#include "engine.hpp"
#include "model.hpp"
#include "support/verification.hpp"

namespace rays {

/// Where a ray meets the plane of a triangle.
struct Meeting {
  double t = HUGE_VAL;
  double inside = -1.0;  ///< the least weight of a corner; negative outside the triangle
  double margin =
      -HUGE_VAL;  ///< the least distance of the ray from an edge, seen along the ray; negative outside
  double across = 0.0;   ///< the ray's length along the normal, for t = 1
};
Meeting meet(const Triangle& triangle, const Ray& ray);

/// The length by which a thin triangle's hits may be off, beside the 16 roundings of floats that hits of any shape have (docs/rays.md, "Needles").
/// `scale` is what a distance is computed from.
double needleError(const Triangle& triangle, const TriangleTest& test, double scale);

/// How far a hit's point is from the surface that it names, or a surface that was missed is before it, relative to the lengths that it was computed
/// from; of a triangle, these include a sixteenth of the roundings that its needleError() takes. Infinite where something was missed as a whole. What a ray meets within a thousandth of a triangle, or within the roundings of its
/// corners, from an edge may be a hit or none: needles may be no wider than that.
double errorOf(const Model& model, const Ray& ray, const Hit& hit, const TriangleTest& test = {});

/// Traces some of the rays through the picture's pixels, as many as loops over all shapes can follow in a moment.
examples::Verification checkEngine(Engine& engine, const Model& model, int width, int height);

}  // namespace rays
