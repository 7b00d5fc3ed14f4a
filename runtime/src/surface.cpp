// SPDX-License-Identifier: MIT
//
// Taking surfaces from the pool and giving them back.
#include "surface.hpp"

#include <algorithm>

namespace sk {

gl::Framebuffer& Surface::framebufferIn(gl::BoundState& bound) {
  if (!framebuffer) {
    const GLuint textures[] = {texture.name()};
    framebuffer = gl::Framebuffer(bound, textures, texture.isLayered());
  }
  return framebuffer;
}

void Surface::forget() noexcept {
  texture.forget();
  framebuffer.forget();
}

std::uint64_t SurfacePool::key(const gl::Format& format, const assemble::TextureShape& shape) {
  constexpr unsigned sizeBits = 20;
  constexpr unsigned layerBits = 16;
  return ((format.index << layerBits | static_cast<std::uint64_t>(shape.layers)) << sizeBits |
          static_cast<std::uint64_t>(shape.width))
             << sizeBits |
         static_cast<std::uint64_t>(shape.height);
}

Surface SurfacePool::take(const gl::Format& format, const assemble::TextureShape& shape) {
  const auto found = idle_.find(key(format, shape));
  if (found != idle_.end() && !found->second.empty()) {
    Surface surface = std::move(found->second.back().surface);
    found->second.pop_back();
    bytes_ -= surface.texture.bytes();
    used_ += static_cast<std::int64_t>(surface.texture.bytes());
    return surface;
  }
  Surface surface{gl::Texture(bound_, format, shape), {}};
  if (!surface && bytes_ > 0) {
    clear();
    surface.texture = gl::Texture(bound_, format, shape);
  }
  if (surface) used_ += static_cast<std::int64_t>(surface.texture.bytes());
  return surface;
}

// Where the host has no memory for the list, the surface is deleted later with its context: its owner
// may be a destructor on a thread that has no context.
void SurfacePool::give(Surface&& surface) noexcept {
  const gl::Texture& texture = surface.texture;
  const std::size_t bytes = texture.bytes();
  used_ -= static_cast<std::int64_t>(bytes);
  try {
    std::vector<Idle>& shelf = idle_[key(texture.format(), texture.shape())];
    shelf.reserve(shelf.size() + 1);
    shelf.push_back({std::move(surface), clock_});
    bytes_ += bytes;
  } catch (...) {
    surface.forget();
  }
}

void SurfacePool::deleteOlderThan(std::int64_t time) {
  for (auto shelf = idle_.begin(); shelf != idle_.end();) {
    std::erase_if(shelf->second, [&](const Idle& idle) {
      if (idle.since >= time) {
        return false;
      }
      bytes_ -= idle.surface.texture.bytes();
      framebuffers_.dropTexture(idle.surface.texture.name());
      return true;
    });
    shelf = shelf->second.empty() ? idle_.erase(shelf) : std::next(shelf);
  }
  bound_.forget();
}

void SurfacePool::forget() noexcept {
  for (auto& [key, shelf] : idle_) {
    for (Idle& idle : shelf) {
      idle.surface.forget();
    }
  }
}

}  // namespace sk
