// SPDX-License-Identifier: MIT
#include "device/loop_tiles.hpp"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk {

std::optional<std::int64_t> givenTileBytes() {
  const char* const given = std::getenv("SK_LOOP_TILES");
  if (given == nullptr) return std::nullopt;
  const std::string_view text = given;
  if (text == "off") return 0;
  std::int64_t bytes = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bytes);
  if (error == std::errc() && end == text.data() + text.size() && bytes > 0) return bytes;
  throw Error(fmt::format(
      "SK_LOOP_TILES is '{}'; give \"off\", or the bytes of the cache that a tile of a loop may take", text));
}

}  // namespace sk
