// SPDX-License-Identifier: MIT
//
// The programs that bring the list of a scatter output to where it belongs: each entry is a point that covers
// its texel, and the device draws points in order. A plain store is the last point's; sums, smallest and
// largest floats are the device's own blending (Krueger and Westermann 2003). Devices do not blend
// integers, so these travel in floats that hold them exactly:
//
//   sums    each component as four limbs of 8 bits, in four channels: 65,536 points add up without rounding.
//           Split the old elements into limbs, draw the points, join the limbs; and again for the next points.
//   min max the upper 16 bits of each component first; then the lower ones of those that have the upper ones
//           that have come out. What is smallest is largest with all bits changed, so that one order serves.
#pragma once

#include <cstdint>
#include <string>

#include "assemble/assemble.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// Points that one draw of limbs may have, the old element being one more.
inline constexpr std::int32_t mostLimbPoints = (1 << 16) - 1;

/// The passes of a scatter output. Those but Points are drawn over its region.
enum class PointStep : std::uint8_t {
  Store,  ///< points: the values, to the planes; with blending for floats that are combined
  SplitLimbs,  ///< the element's limbs, a target a component
  AddLimbs,  ///< points, blended by addition: the limbs of the values
  JoinLimbs,  ///< the elements of the limbs
  SplitUpper,  ///< upper halves of the elements
  Upper,  ///< points, blended by maximum
  SplitLower,  ///< lower halves of the elements whose upper half came out, -1 of others
  Lower,  ///< points, blended by maximum: likewise of the values
  JoinHalves,
};

/// Whether the step draws the list, else the region.
bool hasPoints(PointStep step);

/// Which textures are array textures.
struct PointTextures {
  bool list = false;
  bool elements = false;  ///< of the output, and what other steps draw
  auto operator<=>(const PointTextures&) const = default;
};

/// The vertex program of points. Uniforms: `sk_targets`, the texels of the entries (sampler), `sk_list_shift`,
/// log2 of its width, `sk_first`, the entry of the first point, `sk_size` (ivec4), width and height of
/// the target, and `sk_domain_row`, the first row of its layer. A texel with negative coordinates is nowhere.
std::string pointVertexProgram(const Profile& profile, const PointTextures& textures);

/// The fragment program of a step for scatter output `append output`. Samplers, as far as the step reads them:
/// samplerName() the values of the list, or the elements where it is no step of points; `sk_limbs0` ...,
/// `sk_upper`, `sk_lower`: what earlier steps have drawn. Where the elements have layers, `sk_domain_row` and
/// `sk_domain_shift` are the first row of the one that is drawn, and log2 of its rows.
std::string pointProgram(const Profile& profile, const program::Parameter& appendOutput, PointStep step,
                         const PointTextures& textures);

}  // namespace sk::assemble
