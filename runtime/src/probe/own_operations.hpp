// SPDX-License-Identifier: MIT
//
// The trial by which a device leaves the XOR barrier out: whether it computes the operations of kernels as they are written without
// one. It runs in each stage, in a program that maps and in one with a loop that folds, since compilers know different things there.
#pragma once

#include <string_view>

namespace sk {

class GlDevice;

/// True if all operations of the trial had the bits of IEEE 754, in this or an earlier process with the driver `key`. Must not be
/// called while the device records.
bool computesAsWritten(GlDevice& device, std::string_view key);

}  // namespace sk
