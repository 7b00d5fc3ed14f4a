// SPDX-License-Identifier: MIT
//
// Whole files in memory, as sk::linear reads and writes them.
#pragma once

#include "text/text_file.hpp"

namespace examples {

using sk::text::bytesOf;
using sk::text::writeFile;

}  // namespace examples
