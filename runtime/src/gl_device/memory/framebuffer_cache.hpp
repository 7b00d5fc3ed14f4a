// SPDX-License-Identifier: MIT
//
// Framebuffers that draw to several textures, cached by the textures' names.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <unordered_map>

#include "gl/capabilities.hpp"
#include "gl/framebuffer.hpp"

namespace sk {

class FramebufferCache {
 public:
  explicit FramebufferCache(gl::BoundState& bound) : bound_(bound) {}

  /// The framebuffer that draws to `textures`: 1 to gl::maxDrawBuffers, all with layers or none. Null if the
  /// driver cannot draw to them together. Valid until the next call.
  gl::Framebuffer* framebufferOf(std::span<const GLuint> textures, bool isLayered);

  /// Deletes the framebuffers of a texture that is about to be deleted.
  void dropTexture(GLuint texture);

 private:
  using Key = std::array<GLuint, gl::maxDrawBuffers>;
  struct Hash {
    std::size_t operator()(const Key& key) const;
  };
  static constexpr std::size_t capacity = 256;

  gl::BoundState& bound_;
  std::unordered_map<Key, gl::Framebuffer, Hash> framebuffers_;
};

}  // namespace sk
