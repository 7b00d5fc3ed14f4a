// SPDX-License-Identifier: MIT
//
// The table of profiles: one row per version of a target.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk::assemble {
namespace {

constexpr std::array table = {
    // name      #version  stage  es  draw buffers or images  texture units  uniform components (guaranteed minima)
    Profile{"glsl330", "#version 330 core", Stage::Fragment, false, 8, 16, 1024, Doubles::Native},
    Profile{"essl300", "#version 300 es", Stage::Fragment, true, 4, 16, 896, Doubles::Pairs},
    Profile{"glsl430", "#version 430 core", Stage::Compute, false, 8, 16, 1024, Doubles::Native},
    Profile{"essl310", "#version 310 es", Stage::Compute, true, 4, 16, 512, Doubles::Pairs},
    Profile{"webgl2", "#version 300 es", Stage::Fragment, true, 4, 16, 896, Doubles::Pairs, true},
};

}  // namespace

std::span<const Profile> profiles() { return table; }

const Profile* findProfile(std::string_view name) {
  const auto row = std::ranges::find(table, name, &Profile::name);
  return row == table.end() ? nullptr : &*row;
}

namespace {

/// Bits and kind of a component.
std::string_view componentFormat(program::Scalar scalar) {
  using program::Scalar;
  switch (scalar) {
    case Scalar::Bool:
    case Scalar::Uchar: return "8ui";
    case Scalar::Int: return "32i";
    case Scalar::Uint:
    case Scalar::Double:
    case Scalar::Long:
    case Scalar::Ulong: return "32ui";
    case Scalar::Float: return "32f";
    case Scalar::Half: return "16f";
    case Scalar::Char:
    case Scalar::Snorm8: return "8i";
    case Scalar::Short:
    case Scalar::Snorm16: return "16i";
    case Scalar::Ushort:
    case Scalar::Unorm16: return "16ui";
    case Scalar::Unorm8: break;
  }
  return "8";
}

}  // namespace

std::string imageFormat(const program::Field& field) {
  const int components = program::is64Bit(field.scalar) ? 2 * field.width : field.width;
  return fmt::format("{}{}",
                     components == 1   ? "r"
                     : components == 2 ? "rg"
                                       : "rgba",
                     componentFormat(field.scalar));
}

bool mayStore(const Profile& profile, std::string_view format) {
  if (!profile.es || profile.storesAllFormats) return true;
  return format.starts_with("rgba") || format.starts_with("r32");
}

bool mayStore(const Profile& profile, const program::Element& element) {
  return std::ranges::all_of(
      element.fields, [&](const program::Field& field) { return mayStore(profile, imageFormat(field)); });
}

}  // namespace sk::assemble
