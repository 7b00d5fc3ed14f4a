// SPDX-License-Identifier: MIT
//
// Determines whether drawn or dispatched programs are faster on a device: measured once for each class of
// kernels, and cached on disk for the driver. Kernels of a class make similar demands on a device.
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
  Elements,  ///< only reads and writes elements
  Neighbours,  ///< reads neighbours
  Gathers,  ///< reads at computed indices
  Loops,  ///< has loops
  Reduces,
  Pushes,  ///< has variable outputs, whose order is kept
  Scatters,  ///< has scatter outputs, or variable outputs in any order
  OrderedScatters,  ///< has scatter outputs whose values are combined in order: sums of floats, or vectors
};
inline constexpr std::size_t kernelClasses = 8;

std::string_view nameOf(KernelClass kernels);

/// The class of a kernel that is not the fold of a reduction.
KernelClass classOf(const program::Kernel& kernel, Order order = Order::Kept);

/// Identifies what a trial's result depends on: texture limits change layouts, and software depends on the
/// processor.
std::string trialKey(std::string_view driver, const DeviceLimits& limits, bool isSoftware);

/// Time of compute programs divided by time of fragment programs, for a kernel of the class; below 1,
/// dispatching is faster. No scope of the device may be open. Nullopt if the trial fails, for example because
/// memory is exhausted.
std::optional<double> computeOverFragment(GlDevice& device, KernelClass kernels);

}  // namespace sk
