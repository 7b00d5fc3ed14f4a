// SPDX-License-Identifier: MIT
#pragma once

#include "mesh.hpp"

namespace rays {

/// The teapot of M. Newell ("The utilization of procedure models in digital image synthesis", 1975): 32 bicubic patches of level x level cells
/// each. It stands on y = 0 about the y axis, and is 1 wide from the handle to the tip of the spout. With normals; it is open where the lid lies and where the
/// spout ends.
Mesh teapot(int level);

}  // namespace rays
