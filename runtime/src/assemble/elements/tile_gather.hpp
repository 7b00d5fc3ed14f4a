// SPDX-License-Identifier: MIT
//
// The functions with which a body reads a gather whose texels a work group has in shared memory, for a tile of the domain
// (program/tile_program.hpp). Boundary modes apply at the ends of the stream; beyond the ends of the tile, any texel is read,
// for results that nothing uses.
#pragma once

#include <array>
#include <string>

#include "assemble/elements/domain.hpp"
#include "assemble/glsl/program_text.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// An array of packed texels in shared memory, by rows.
struct TileArray {
  std::string name;
  std::array<int, 2> texels;  ///< columns and rows
};

/// Defines the functions for a gather of rank 2 and of one scalar. Its neighbours are at constant offsets: before the body runs,
/// main() sets the variables of a TexelWindow, by `sk_texel_at_P(ivec2 d)`, which fetches the texel at an offset from the
/// invocation's, or by what it holds itself.
/// Programs declare, and main() sets: `sk_origin`, the stream's texel that is the tile's first one; `sk_spot`, the texel of the
/// invocation in the tile; `sk_low` and `sk_high`, the first and the last texel of the stream that are in the tile.
void defineTileGather(ProgramText& program, DomainText& domain, const program::Parameter& gather,
                      const TileArray& array);

}  // namespace sk::assemble
