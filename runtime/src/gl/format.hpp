// SPDX-License-Identifier: MIT
//
// The texture formats of stream planes, and the format and type pairs that transfer texels to and from host
// memory.
#pragma once

#include <cstddef>
#include <span>

#include <epoxy/gl.h>

#include "sk/program.hpp"

namespace sk::gl {

/// The layout of texels in host memory.
struct Transfer {
  GLenum format;       ///< GL_RED, GL_RGBA_INTEGER ...
  GLenum type;         ///< GL_FLOAT, GL_UNSIGNED_BYTE ...
  int channels;
  int channelBytes;

  std::size_t texelBytes() const {
    return static_cast<std::size_t>(channels) * static_cast<std::size_t>(channelBytes);
  }
  bool operator==(const Transfer&) const = default;
};

struct Format {
  GLenum internalFormat;
  const char* name;    ///< "R32F", for messages
  Transfer tight;  ///< the format's own channels; every GL and ES can upload it
  Transfer wide;  ///< what ES guarantees to read: four channels of 32 bits, or of 8 for R8 and similar
  std::size_t index;   ///< of this row in formats()

  std::size_t texelBytes() const { return tight.texelBytes(); }
};

/// Planes of 3 components use a format of 4. The scalar and the width are those of the texels.
const Format& formatOf(program::Scalar scalar, int width);
/// The format of a field's plane.
const Format& formatOf(const program::Field& field);

/// The size of a field in host memory.
std::size_t hostBytes(const program::Field& field);

std::span<const Format> formats();
inline constexpr std::size_t formatCount = 27;

}  // namespace sk::gl
