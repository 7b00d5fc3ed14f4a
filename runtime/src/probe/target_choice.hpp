// SPDX-License-Identifier: MIT
//
// Which programs are faster on a device, drawn or dispatched ones: tried out once for each class of kernels and kept for
// the driver, on disk, too. Kernels of a class ask much the same of a device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "assemble/assemble.hpp"
#include "sk/device.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

enum class KernelClass : std::uint8_t {
  Elements,  ///< reads and writes elements, and no more
  Neighbours,  ///< reads neighbours
  Gathers,  ///< reads at computed indices
  Loops,  ///< has loops
  Reduces,
};
inline constexpr std::size_t kernelClasses = 5;

std::string_view nameOf(KernelClass kernels);

/// The class of a kernel that is no fold of a reduction.
KernelClass classOf(const program::Kernel& kernel);

/// What a trial's result depends on, in words: streams lie otherwise in smaller textures, and software is as fast as the processor.
std::string trialKey(std::string_view driver, const DeviceLimits& limits, bool isSoftware);

/// The time of compute programs over that of fragment programs for a kernel of the class; below 1, dispatches are faster.
/// No scope of the device is open. None where the device could not be tried out: for want of memory, say.
std::optional<double> computeOverFragment(GlDevice& device, KernelClass kernels);

}  // namespace sk
