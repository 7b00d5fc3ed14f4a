// SPDX-License-Identifier: MIT
//
// The functions with which a body reads a gather whose texels a work group has in shared memory, for a tile of the domain
// (program/tile_program.hpp). Boundary modes apply at the ends of the stream; beyond the ends of the tile, any texel is read,
// for results that nothing uses.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "assemble/elements/domain.hpp"
#include "assemble/glsl/program_text.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// Packed texels of a tile in shared memory, by rows.
struct TileArray {
  std::string name;
  std::string_view type;  ///< of a texel: "vec4"
  std::array<int, 2> texels;  ///< columns and rows
  bool isExtended = false;  ///< texels beyond the ends of the stream are what Boundary::Clamp gives there

  void declare(ProgramText& program) const;
  /// A texel, as an expression.
  std::string texel(std::string_view row, std::string_view column) const;
};

/// Defines the functions for a gather of rank 2 and of one scalar. Its neighbours are at constant offsets: before the body runs,
/// main() sets the variables of a TexelWindow, by `sk_texel_at_P(ivec2 d)`, which fetches the texel at an offset from the
/// invocation's, or by what it holds itself.
/// Programs declare, and main() sets: `sk_origin`, the stream's texel that is the tile's first one; `sk_spot`, the texel of the
/// invocation in the tile; `sk_low` and `sk_high`, the first and the last texel of the stream that are in the tile.
void defineTileGather(ProgramText& program, DomainText& domain, const program::Parameter& gather,
                      const TileArray& array);

}  // namespace sk::assemble
