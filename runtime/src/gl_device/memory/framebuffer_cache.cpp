// SPDX-License-Identifier: MIT
#include "gl_device/memory/framebuffer_cache.hpp"

#include <algorithm>

#include "gl/bound_state.hpp"

namespace sk {

std::size_t FramebufferCache::Hash::operator()(const Key& key) const {
  std::size_t hash = 0;
  for (const GLuint name : key) {
    hash = (hash ^ name) * 0x9E3779B97F4A7C15u;
  }
  return hash ^ hash >> 32;
}

gl::Framebuffer* FramebufferCache::framebufferOf(std::span<const GLuint> textures, bool isLayered) {
  Key key{};
  std::copy(textures.begin(), textures.end(), key.begin());
  if (const auto found = framebuffers_.find(key); found != framebuffers_.end()) {
    return &found->second;
  }
  if (framebuffers_.size() >= capacity) framebuffers_.clear();
  gl::Framebuffer framebuffer(bound_, textures, isLayered);
  if (!gl::Framebuffer::isComplete()) return nullptr;
  return &framebuffers_.emplace(key, std::move(framebuffer)).first->second;
}

void FramebufferCache::dropTexture(GLuint texture) {
  std::erase_if(framebuffers_, [&](const auto& entry) {
    return std::find(entry.first.begin(), entry.first.end(), texture) != entry.first.end();
  });
}

}  // namespace sk
