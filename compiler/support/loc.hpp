// SPDX-License-Identifier: MIT
//
// A source location. Line and file serve #line directives; `token` is the frontend's own handle, from which
// it draws the caret. No other code interprets it.
#pragma once

#include <cstdint>

namespace skc {

struct Loc {
  std::uint32_t token = 0;   ///< 0: no location
  std::uint32_t line = 0;    ///< from 1
  std::uint32_t file = 0;    ///< index into Module::sources
};

}  // namespace skc
