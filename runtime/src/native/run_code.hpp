// SPDX-License-Identifier: MIT
//
// Runs kernels that skc compiled to object code over their domains.
#pragma once

#include "native/call.hpp"
#include "native/entries.hpp"
#include "sk/program.hpp"

namespace sk {

/// `kernel.code` must not be null. Throws sk::Error if it has no code that runs on this CPU.
void runCode(const program::Kernel& kernel, const native::Call& call, const CodeChoice& choice);

}  // namespace sk
