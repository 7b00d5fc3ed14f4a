// SPDX-License-Identifier: MIT
//
// How much memory a device keeps for later calls, of textures and of each buffer that dispatches work on. An algorithm of
// many temporaries, such as a sort, is slower by a factor once they take more than that: a driver takes milliseconds to
// allocate some 100 MiB, and for buffers up to a hundred.
#pragma once

#include <cstddef>

#include "gl/capabilities.hpp"
#include "gl/context.hpp"

namespace sk {

/// A sixteenth of a GPU's memory, and at least 256 MiB.
std::size_t keptBytesOf(const gl::MemoryInfo& memory);
/// The same for a device. Software renderers have the host's memory, which is not theirs to keep.
std::size_t keptBytesOn(const gl::Context& context, const gl::Capabilities& capabilities);

}  // namespace sk
