// SPDX-License-Identifier: MIT
//
// A picture to work on where the user has none: shapes, gradients and grain, the same on every machine.
#pragma once

#include "support/image.hpp"

namespace examples {

/// A composition of discs, bars, rings and a sphere on a shaded ground, with film grain.
Picture stillLife(int width, int height);

}  // namespace examples
