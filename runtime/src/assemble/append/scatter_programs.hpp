// SPDX-License-Identifier: MIT
//
// The programs that carry out the list of a scatter output.
// Drawn programs: each entry of the list is a point that covers its target texel, and the device draws
// points in order. For a plain store, the last point wins. Sums, minima and maxima of floats use the device's
// blending (Krueger and Westermann 2003). Devices do not blend integers, so integers are represented exactly
// in floats:
//
//   sums    each component as four limbs of 8 bits, in four channels: 65,536 points add up without rounding.
//           Split the stored elements into limbs, draw points, join the limbs; repeat for the next points.
//   min max first the upper 16 bits of each component, then the lower 16 bits of those whose upper bits are
//           the result. A minimum is a maximum with all bits inverted, so that one order serves both.
//
// A compute program combines, in order, what atomic operations cannot combine so: sums of floats, and vectors. Its records
// are the targets and values that a kernel has pushed (append/append_groups.hpp). A stable sort by targets has brought
// those of each target together, in the order of the elements.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "assemble/assemble.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// The most points in one draw of limbs; the stored element counts as one more.
inline constexpr std::int32_t mostLimbPoints = (1 << 16) - 1;

/// The passes of a scatter output. The steps that do not draw points draw the output's region.
enum class PointStep : std::uint8_t {
  Store,  ///< points: stores the values to the planes; blends floats that are combined
  SplitLimbs,  ///< the element's limbs, one render target per component
  AddLimbs,  ///< points, with additive blending: the limbs of the values
  JoinLimbs,  ///< joins limbs to elements
  SplitUpper,  ///< upper halves of the elements
  Upper,  ///< points, with maximum blending
  SplitLower,  ///< lower halves of elements whose upper half is the result, else -1
  Lower,  ///< points, with maximum blending: the lower halves of values, likewise
  JoinHalves,
};

/// The steps that apply the list of a scatter output, in order.
std::span<const PointStep> pointSteps(const program::Parameter& scatter);

/// Whether the step draws the list's points, rather than the region.
bool hasPoints(PointStep step);

/// Which textures are array textures.
struct PointTextures {
  bool list = false;
  bool elements = false;  ///< of the output, and of what steps draw
  auto operator<=>(const PointTextures&) const = default;
};

/// The vertex program of points. Uniforms: `sk_targets`, the target texels of the entries (sampler);
/// `sk_list_shift`, log2 of its width; `sk_first`, the entry of the first point; `sk_size` (ivec4), width and
/// height of the render target; `sk_domain_row`, the first row of its layer. A texel with negative
/// coordinates is not drawn.
std::string pointVertexProgram(const Profile& profile, const PointTextures& textures);

/// The fragment program of a step for a scatter output. Samplers, if the step reads them: samplerName() for
/// the list's values, or for the elements in steps without points; `sk_limbs0` ..., `sk_upper` and `sk_lower`
/// for the results of earlier steps. If the elements have layers, `sk_domain_row` is the first row of the
/// drawn layer, and `sk_domain_shift` is log2 of the layer's rows.
std::string pointProgram(const Profile& profile, const program::Parameter& appendOutput, PointStep step,
                         const PointTextures& textures);

/// The records of a work group.
inline constexpr std::int32_t recordTile = 1024;

/// The program for a scatter output that isListed(). It is dispatched in rows of 2^15 groups, one for each tile, and has the
/// uniforms sk_rect, sk_length, sk_tiles, sk_keys_shift, sk_list_shift and sk_width. Its samplers are sk_keys, of sorted pairs;
/// sk_count, of the number of records, if it `isCounted` on the device; sk_values, of the list, unless a pair holds the value; and in
/// ES sk_elements, of the target. Image 0 is the target.
std::string recordProgram(const Profile& profile, const program::Parameter& scatter, bool isCounted);

}  // namespace sk::assemble
