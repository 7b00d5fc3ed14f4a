// SPDX-License-Identifier: MIT
//
// The texture formats of stream planes, with the pairs in which texels travel to and from host memory.
#pragma once

#include <cstddef>
#include <span>

#include <epoxy/gl.h>

#include "sk/program.hpp"

namespace sk::gl {

/// How texels lie in host memory.
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
  Transfer tight;      ///< as many channels as the format has; every GL and ES uploads it
  Transfer wide;       ///< what ES promises to read: four channels of 32 bits, of R8 and its like of 8
  std::size_t index;   ///< of this row in formats()

  std::size_t texelBytes() const { return tight.texelBytes(); }
};

/// Planes of 3 components have a format of 4. Both the scalar and the width are those of texels.
const Format& formatOf(program::Scalar scalar, int width);
/// Of a field's plane.
const Format& formatOf(const program::Field& field);

/// How many bytes a field takes in host memory.
std::size_t hostBytes(const program::Field& field);

std::span<const Format> formats();
inline constexpr std::size_t formatCount = 27;

}  // namespace sk::gl
