// SPDX-License-Identifier: MIT
//
// Runs loops on a native device in tiles: several iterations at once where all of their calls may be tiled, else neighbouring
// calls of one iteration.
#pragma once

#include <memory>

#include "device/loop_runner.hpp"

namespace sk {

class NativeDevice;

std::unique_ptr<LoopRunner> makeTiledLoop(NativeDevice& device);

}  // namespace sk
