// SPDX-License-Identifier: MIT
//
// Goes on after a crash of a library that skc calls, so that it becomes an error with a place.
#pragma once

#include "support/function_ref.hpp"

namespace skc {

/// Runs `work`. Returns false if it crashed: then nothing that it was building may be used or freed any more, and what it had
/// allocated is lost. Exceptions pass through. Not for nested use within one thread.
bool survivesCrash(FunctionRef<void()> work);

}  // namespace skc
