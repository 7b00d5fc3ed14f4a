// SPDX-License-Identifier: MIT
//
// Descriptors as skc would generate them, for every scalar type and width; created on first use.
#include "gl_device/transfer/copy_kernel.hpp"

#include <array>
#include <string>

#include <fmt/format.h>

#include "sk/types.hpp"

namespace sk {

namespace {

constexpr int widths = 4;
constexpr int scalars = 16;

/// A field with the same texel format, so that the kernel copies bits instead of converting values.
program::Field texelField(const program::Field& field) {
  switch (field.scalar) {
    case program::Scalar::Double:
    case program::Scalar::Long:
    case program::Scalar::Ulong:
      return {"", program::Scalar::Uint, static_cast<std::uint8_t>(2 * field.width), 0};
    case program::Scalar::Snorm8: return {"", program::Scalar::Char, field.width, 0};
    case program::Scalar::Snorm16: return {"", program::Scalar::Short, field.width, 0};
    case program::Scalar::Unorm16: return {"", program::Scalar::Ushort, field.width, 0};
    case program::Scalar::Bool:
    case program::Scalar::Int:
    case program::Scalar::Uint:
    case program::Scalar::Float:
    case program::Scalar::Half:
    case program::Scalar::Char:
    case program::Scalar::Uchar:
    case program::Scalar::Short:
    case program::Scalar::Ushort:
    case program::Scalar::Unorm8: break;
  }
  return {"", field.scalar, field.width, 0};
}

/// Kernels that copy one plane, one for each scalar type and width.
class CopyKernels {
 public:
  CopyKernels() {
    for (std::size_t scalar = 0; scalar < scalars; ++scalar) {
      for (std::size_t width = 0; width < widths; ++width) {
        define(kernels_[scalar * widths + width], static_cast<program::Scalar>(scalar), width);
      }
    }
  }
  const program::Kernel& of(const program::Field& field) const {
    return kernels_[static_cast<std::size_t>(field.scalar) * widths + field.width - 1u].kernel;
  }

 private:
  struct CopyKernel {
    program::Field field;
    program::Element element;
    std::array<program::Parameter, 2> parameters;
    std::string body;
    program::Kernel kernel;
  };

  static void define(CopyKernel& copy, program::Scalar scalar, std::size_t width) {
    const std::size_t row = static_cast<std::size_t>(scalar);
    const std::string_view glsl = detail::spellings[row].glsl[width];
    const auto components = static_cast<std::uint8_t>(width + 1);
    copy.field = {"", scalar, components, 0};
    copy.element = {detail::spellings[row].names[width], glsl, components, {&copy.field, 1}};
    copy.parameters[0] = {
        .name = "from", .symbol = "from", .role = program::Role::Input, .element = &copy.element};
    copy.parameters[1] = {
        .name = "to", .symbol = "to", .role = program::Role::Output, .element = &copy.element};
    copy.body = fmt::format("void sk_copy({0} sk_from, out {0} sk_to) {{ sk_to = sk_from; }}\n", glsl);
    copy.kernel.name = "copy";
    copy.kernel.entry = "sk_copy";
    copy.kernel.body = copy.body;
    copy.kernel.parameters = copy.parameters;
  }

  std::array<CopyKernel, std::size_t{widths} * scalars> kernels_;
};

}  // namespace

const program::Kernel& copyKernel(const program::Field& field) {
  static const CopyKernels kernels;
  return kernels.of(texelField(field));
}

}  // namespace sk
