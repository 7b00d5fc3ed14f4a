// SPDX-License-Identifier: MIT
//
// What other users of the processor may ask of the threads that native loops run on.
#pragma once

namespace sk::native {

/// Threads that wait for more work end. They would watch for it, as OpenMP's do for some milliseconds, in which a renderer that
/// is software needs the cores; the next loop starts others.
void restThreads();

}  // namespace sk::native
