// SPDX-License-Identifier: MIT
//
// A texture in one of our formats, without filtering and mipmaps: a 2-D texture or an array of layers. And the samplers
// through which programs read textures, created on first use: a nearest one and, for gathers declared [[filter]], a linear
// one per boundary mode that samplers support. A bound sampler overrides the texture's settings, which an application may
// have changed for drawing.
//
// A framebuffer of whole textures, or of one layer of each. Each texture is a colour attachment and a draw
// buffer.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "gl/format.hpp"
#include "gl/object_name.hpp"
#include "sk/program.hpp"

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
  /// Takes memory, on the bound texture.
  void take(GLenum target) const;
  void takeImmutable(GLenum target) const;

  ObjectName<deleteTexture> name_;
  const Format* format_ = nullptr;
  TextureSize size_;
};

inline void deleteSampler(BoundState&, GLuint name) { glDeleteSamplers(1, &name); }

/// The samplers of a device: one for each filter and boundary mode.
class Samplers {
 public:
  explicit Samplers(Deletions& deletions) : deletions_(deletions) {}

  /// The context must be current.
  GLuint nearest() {
    if (!nearest_) nearest_ = made(GL_NEAREST, GL_CLAMP_TO_EDGE);
    return nearest_.get();
  }

  /// Not for Boundary::Border, which programs implement. The context must be current.
  GLuint linear(program::Boundary boundary) {
    constexpr std::array<GLint, 3> wraps = {GL_CLAMP_TO_EDGE, GL_REPEAT, GL_MIRRORED_REPEAT};
    const auto mode = static_cast<std::size_t>(boundary);
    if (!linear_[mode]) linear_[mode] = made(GL_LINEAR, wraps[mode]);
    return linear_[mode].get();
  }

 private:
  using Name = ObjectName<deleteSampler>;

  Name made(GLint filter, GLint wrap) const {
    Name name(deletions_, [] { return generated(glGenSamplers); });
    glSamplerParameteri(name.get(), GL_TEXTURE_MIN_FILTER, filter);
    glSamplerParameteri(name.get(), GL_TEXTURE_MAG_FILTER, filter);
    glSamplerParameteri(name.get(), GL_TEXTURE_WRAP_S, wrap);
    glSamplerParameteri(name.get(), GL_TEXTURE_WRAP_T, wrap);
    return name;
  }

  Deletions& deletions_;
  Name nearest_;
  std::array<Name, 3> linear_;  ///< for Clamp, Wrap, Mirror
};

void deleteFramebuffer(BoundState& bound, GLuint name);

class Framebuffer {
 public:
  Framebuffer() = default;
  /// Attaches one or more `textures` in order: either 2-D textures, or the first layers of array textures.
  Framebuffer(BoundState& bound, std::span<const GLuint> textures, bool isLayered);

  /// Attaches another layer of all textures, which must be array textures.
  void selectLayer(BoundState& bound, GLint layer);

  GLuint name() const { return name_.get(); }
  explicit operator bool() const { return static_cast<bool>(name_); }
  /// Whether the driver can draw to it. It must be the framebuffer created or bound last.
  static bool isComplete() { return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE; }
  /// Reads a rectangle of texels from its first texture, row by row without gaps. Waits for the device.
  void read(BoundState& bound, const Transfer& transfer, GLint x, GLint y, GLsizei width, GLsizei height,
            void* texels) const;
  /// Whether an ES driver can read its first texture with this transfer, in addition to the wide one.
  bool readsOnEs(BoundState& bound, const Transfer& transfer) const;

 private:
  ObjectName<deleteFramebuffer> name_;
  std::vector<GLuint> layered_;  ///< textures whose layers are attached
  GLint layer_ = 0;
};

}  // namespace sk::gl
