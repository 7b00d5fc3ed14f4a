// SPDX-License-Identifier: MIT
#include "assemble/reduce/scan_tile_program.hpp"

#include "assemble/reduce/scan_tile_text.hpp"

namespace sk::assemble {

std::string scanTileProgram(const Profile& profile, const program::Reduction& reduction,
                            const ReduceVariant& variant) {
  return TileScanText(profile, reduction, variant).write();
}

}  // namespace sk::assemble
