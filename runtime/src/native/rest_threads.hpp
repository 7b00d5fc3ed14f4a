// SPDX-License-Identifier: MIT
//
// Frees the processor from the idle threads of native loops.
#pragma once

namespace sk::native {

/// Ends threads that wait for more work; the next loop starts new ones. OpenMP's threads spin for some
/// milliseconds, in which a software renderer needs the cores.
void restThreads();

}  // namespace sk::native
