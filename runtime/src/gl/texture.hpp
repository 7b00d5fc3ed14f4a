// SPDX-License-Identifier: MIT
//
// A texture in one of our formats, without filtering and mipmaps: a 2-D texture or an array of layers.
#pragma once

#include "gl/format.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

void deleteTexture(BoundState& bound, GLuint name);
/// Sets one level and no filter for the texture bound to a target.
void setNearest(GLenum target);

struct TextureSize {
  GLsizei width = 0, height = 0;
  GLsizei layers = 0;  ///< 0: it is not an array texture
};

/// A rectangle of texels of a layer.
struct Texels {
  GLint x, y;
  GLsizei width, height;
};

class Texture {
 public:
  Texture() = default;
  /// Creates a texture with undefined texels. name() is 0 afterwards if the driver is out of memory.
  Texture(BoundState& bound, const Format& format, const TextureSize& size);

  /// Writes texels (format().tight) of a layer, row by row without gaps.
  void write(BoundState& bound, const Texels& rect, GLint layer, const void* texels);

  /// Copies the first width x height texels of a framebuffer, whose texture has the same format, to a layer,
  /// bit for bit.
  void copyLayer(BoundState& bound, GLuint framebuffer, GLint layer, GLsizei width, GLsizei height);

  GLuint name() const { return name_.get(); }
  const Format& format() const { return *format_; }
  const TextureSize& size() const { return size_; }
  bool isLayered() const { return size_.layers > 0; }
  /// The rows of all layers.
  GLsizei rows() const { return size_.height * (isLayered() ? size_.layers : 1); }
  std::size_t bytes() const;

 private:
  ObjectName<deleteTexture> name_;
  const Format* format_ = nullptr;
  TextureSize size_;
};

}  // namespace sk::gl
