// SPDX-License-Identifier: MIT
//
// The few kinds of GL objects that drawing needs, each owned by one value and deleted with it. A context must be current.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>

#include <epoxy/gl.h>

namespace examples {

/// A GL name and how it is deleted.
template <void (*remove)(GLuint)>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint name) : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ != 0) remove(name_);
  }
  GLuint get() const { return name_; }

 private:
  GLuint name_ = 0;
};

namespace gl_remove {
inline void buffer(GLuint name) { glDeleteBuffers(1, &name); }
inline void texture(GLuint name) { glDeleteTextures(1, &name); }
inline void framebuffer(GLuint name) { glDeleteFramebuffers(1, &name); }
inline void vertexArray(GLuint name) { glDeleteVertexArrays(1, &name); }
inline void program(GLuint name) { glDeleteProgram(name); }
}  // namespace gl_remove

using GlBuffer = GlName<gl_remove::buffer>;
using GlTexture = GlName<gl_remove::texture>;
using GlFramebuffer = GlName<gl_remove::framebuffer>;
using GlVertexArray = GlName<gl_remove::vertexArray>;
using GlProgram = GlName<gl_remove::program>;

/// A buffer of `bytes` bytes, with undefined contents if `data` is null.
GlBuffer makeBuffer(std::int64_t bytes, const void* data, GLenum usage);
GlVertexArray makeVertexArray();
/// One level, linear, clamped to its edges. A depth texture compares, as a sampler2DShadow wants it, and is 1 outside.
GlTexture makeTexture(GLenum internalFormat, GLenum format, GLenum type, int width, int height);
GlTexture makeDepthTexture(int width, int height);
/// A texture of a buffer's texels, for samplerBuffer.
GlTexture makeBufferTexture(GLenum internalFormat, GLuint buffer);
/// A framebuffer with a colour texture (0: none) and a depth texture. Throws std::runtime_error if the driver cannot draw to them.
GlFramebuffer makeFramebuffer(GLuint colour, GLuint depth);
/// GLSL 3.30; every part is put behind the #version line. Throws std::runtime_error with the driver's message.
GlProgram makeProgram(std::string_view vertex, std::string_view fragment);

/// A fragment program that covers a viewport. It gets `in vec2 at`, which is (0, 0) in the lower left corner and (1, 1) in the upper right one.
class FullView {
 public:
  explicit FullView(std::string_view fragment);
  /// Makes the program current, so that its uniforms can be set.
  void use() const { glUseProgram(program_.get()); }
  /// The place of a uniform.
  GLint operator[](const char* name) const { return glGetUniformLocation(program_.get(), name); }
  /// Binds a texture to a unit for a sampler.
  void bind(const char* name, int unit, GLuint texture) const;
  /// Draws, and leaves no program behind.
  void draw() const;

 private:
  GlProgram program_;
  GlVertexArray nothing_ = makeVertexArray();
};

}  // namespace examples
