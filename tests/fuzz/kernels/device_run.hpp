// SPDX-License-Identifier: MIT
//
// Runs a compiled random kernel on a device and compares all of its outputs with what they must hold.
#pragma once

#include <string>

#include "kernels/kernels.hpp"
#include "sk/sk.hpp"

namespace fuzz {

/// What differs, or ''. The descriptors must outlive the device. Throws sk::Error where the runtime does.
std::string difference(sk::Device& device, const sk::program::Kernel& compiled, const RandomKernel& kernel);

}  // namespace fuzz
