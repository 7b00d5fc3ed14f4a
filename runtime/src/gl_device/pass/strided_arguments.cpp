// SPDX-License-Identifier: MIT
//
// Which strided regions a GL device uses as they lie: kernels read elements at any address, but draw to rectangles, and
// passes of reductions and of append outputs read these.
#include <algorithm>

#include "assemble/append/append_passes.hpp"
#include "device/region.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"

namespace sk {

using program::Role;

bool GlDevice::needsDense(const program::Kernel& kernel, std::span<const Argument> arguments, std::size_t i) {
  const Role role = kernel.parameters[i].role;
  if (role == Role::Uniform) return false;
  if (role == Role::Scatter) return true;  // points are placed by the rank of the stream
  if (!needsDense(arguments[i].region)) return false;
  if (isPlaced(arguments[i].region)) return true;
  const bool readsRectangles =
      std::ranges::any_of(kernel.parameters, [](const program::Parameter& parameter) {
        return parameter.role == Role::Accumulator || assemble::isAppendOutput(parameter);
      });
  return readsRectangles || (role != Role::Input && role != Role::Gather);
}

bool GlDevice::needsDense(const StreamRegion& region) {
  return regionLayoutOf(region, glStream(region).layout).strided;
}

}  // namespace sk
