// SPDX-License-Identifier: MIT
//
// Runs a compiled random kernel on a device and compares all of its outputs with the expected ones.
#pragma once

#include <string>

#include "kernels/kernels.hpp"
#include "sk/sk.hpp"

namespace fuzz {

/// The first difference, or "". The descriptors must outlive the device. Throws what the runtime throws.
std::string difference(sk::Device& device, const sk::program::Kernel& compiled, const RandomKernel& kernel);

}  // namespace fuzz
