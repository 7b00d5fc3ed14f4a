// SPDX-License-Identifier: MIT
//
// What the environment says of tiles of loops, for devices of every kind.
#pragma once

#include <cstdint>
#include <optional>

namespace sk {

/// The bytes that a tile of a loop may take, as SK_LOOP_TILES says: nullopt without it, 0 if it is "off", which runs loops call by
/// call. Throws sk::Error if it is something else.
std::optional<std::int64_t> givenTileBytes();

}  // namespace sk
