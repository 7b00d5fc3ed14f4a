// SPDX-License-Identifier: MIT
//
// Taking render targets from the pool and giving them back.
#include "gl_device/memory/render_target.hpp"

#include <algorithm>

namespace sk {

gl::Framebuffer& RenderTarget::framebufferIn(gl::BoundState& bound) {
  if (!framebuffer) {
    const GLuint textures[] = {texture.name()};
    framebuffer = gl::Framebuffer(bound, textures, texture.isLayered());
  }
  return framebuffer;
}

void RenderTarget::forget() noexcept {
  texture.forget();
  framebuffer.forget();
}

std::uint64_t TexturePool::key(const gl::Format& format, const assemble::TextureShape& shape) {
  constexpr unsigned sizeBits = 20;
  constexpr unsigned layerBits = 16;
  return ((format.index << layerBits | static_cast<std::uint64_t>(shape.layers)) << sizeBits |
          static_cast<std::uint64_t>(shape.width))
             << sizeBits |
         static_cast<std::uint64_t>(shape.height);
}

RenderTarget TexturePool::take(const gl::Format& format, const assemble::TextureShape& shape) {
  const auto found = idle_.find(key(format, shape));
  if (found != idle_.end() && !found->second.empty()) {
    RenderTarget renderTarget = std::move(found->second.back().renderTarget);
    found->second.pop_back();
    bytes_ -= renderTarget.texture.bytes();
    used_ += static_cast<std::int64_t>(renderTarget.texture.bytes());
    return renderTarget;
  }
  RenderTarget renderTarget{gl::Texture(bound_, format, shape), {}};
  if (!renderTarget && bytes_ > 0) {
    clear();
    renderTarget.texture = gl::Texture(bound_, format, shape);
  }
  if (renderTarget) used_ += static_cast<std::int64_t>(renderTarget.texture.bytes());
  return renderTarget;
}

// Where the host has no memory for the list, the render target is deleted later with its context: its owner
// may be a destructor on a thread that has no context.
void TexturePool::give(RenderTarget&& renderTarget) noexcept {
  const gl::Texture& texture = renderTarget.texture;
  const std::size_t bytes = texture.bytes();
  used_ -= static_cast<std::int64_t>(bytes);
  try {
    std::vector<Idle>& shelf = idle_[key(texture.format(), texture.shape())];
    shelf.reserve(shelf.size() + 1);
    shelf.push_back({std::move(renderTarget), clock_});
    bytes_ += bytes;
  } catch (...) {
    renderTarget.forget();
  }
}

void TexturePool::deleteOlderThan(std::int64_t time) {
  for (auto shelf = idle_.begin(); shelf != idle_.end();) {
    std::erase_if(shelf->second, [&](const Idle& idle) {
      if (idle.since >= time) {
        return false;
      }
      bytes_ -= idle.renderTarget.texture.bytes();
      framebuffers_.dropTexture(idle.renderTarget.texture.name());
      return true;
    });
    shelf = shelf->second.empty() ? idle_.erase(shelf) : std::next(shelf);
  }
  bound_.forget();
}

void TexturePool::forget() noexcept {
  for (auto& [key, shelf] : idle_) {
    for (Idle& idle : shelf) {
      idle.renderTarget.forget();
    }
  }
}

}  // namespace sk
