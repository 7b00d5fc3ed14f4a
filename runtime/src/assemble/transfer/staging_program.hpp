// SPDX-License-Identifier: MIT
//
// The compute programs that copy a box of a stream between the texels of a plane and a buffer that the host reads and
// writes. The buffer has a word for each component: those of the first component of all elements of the box, row-major,
// then those of the next.
#pragma once

#include <string>
#include <string_view>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// Invocations of a work group, each of which takes a texel.
inline constexpr std::int32_t stagingGroup = 64;
/// The most boxes of a dispatch, whose groups have the box's number in y.
inline constexpr std::size_t stagedBoxes = 4;

/// The program that reads texels, or writes them. `format`: the name of their format, such as "RGBA32F". Its uniforms are
/// sk_stride, sk_shift, sk_lane_bits, sk_channels and, for each box, sk_origin[], sk_extent[] and sk_first[]; the plane is the
/// sampler or image sk_texels.
std::string stagingProgram(const Profile& profile, bool writesTexels, std::string_view format,
                           bool isLayered);

}  // namespace sk::assemble
