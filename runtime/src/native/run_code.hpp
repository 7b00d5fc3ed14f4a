// SPDX-License-Identifier: MIT
//
// Runs kernels that skc compiled to object code over their domains.
#pragma once

#include "native/call.hpp"
#include "native/entries.hpp"
#include "sk/program.hpp"

namespace sk {

/// `kernel.code` is not null. Throws sk::Error where this CPU runs none of it.
void runCode(const program::Kernel& kernel, const native::Call& call, const CodeChoice& choice);

}  // namespace sk
