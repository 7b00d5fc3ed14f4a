// SPDX-License-Identifier: MIT
#include "gl_device/memory/render_target.hpp"

#include <algorithm>
#include <iterator>

namespace sk {

gl::Framebuffer& RenderTarget::framebufferIn(gl::BoundState& bound) {
  if (!framebuffer) {
    const GLuint textures[] = {texture.name()};
    framebuffer = gl::Framebuffer(bound, textures, texture.isLayered());
  }
  return framebuffer;
}

std::uint64_t TexturePool::key(const gl::Format& format, const assemble::TextureShape& shape) {
  constexpr unsigned sizeBits = 20;
  constexpr unsigned layerBits = 16;
  return ((format.index << layerBits | static_cast<std::uint64_t>(shape.layers)) << sizeBits |
          static_cast<std::uint64_t>(shape.width))
             << sizeBits |
         static_cast<std::uint64_t>(shape.height);
}

RenderTarget TexturePool::acquire(const gl::Format& format, const assemble::TextureShape& shape) {
  const std::uint64_t shapeKey = key(format, shape);
  if (reserve_ != nullptr) {
    if (RenderTarget reserved = acquireReserved(shapeKey)) return reserved;
  }
  RenderTarget renderTarget = acquireIdle(shapeKey);
  if (!renderTarget) renderTarget.texture = gl::Texture(bound_, format, shape);
  if (!renderTarget && bytes_ > 0) {
    deleteOlderThan(clock_ + 1);
    bound_.deleteQueued();
    renderTarget.texture = gl::Texture(bound_, format, shape);
  }
  if (!renderTarget) return renderTarget;
  Bucket& bucket = buckets_[shapeKey];
  bucket.idle.reserve(bucket.idle.size() + bucket.acquired + 1);
  ++bucket.acquired;
  used_ += static_cast<std::int64_t>(renderTarget.texture.bytes());
  return renderTarget;
}

RenderTarget TexturePool::acquireReserved(std::uint64_t shapeKey) {
  std::vector<RenderTarget>& idle = reserve_->idle;
  const auto fits = [&](const RenderTarget& one) {
    return key(one.texture.format(), one.texture.shape()) == shapeKey;
  };
  const auto last = std::find_if(idle.rbegin(), idle.rend(), fits);
  auto found = last == idle.rend() ? idle.end() : std::prev(last.base());
  if (found != idle.end() && found->texture.bytes() <= smallBytes) {
    const auto end = idle.begin() + static_cast<std::ptrdiff_t>(reserve_->ofEarlier);
    const auto first = std::find_if(idle.begin(), end, fits);
    found = first == end ? idle.end() : first;
  }
  if (found == idle.end()) {
    idle.reserve(idle.capacity() + 2);  // for its release, and that of what it replaces
    return {};
  }
  RenderTarget renderTarget = std::move(*found);
  if (found - idle.begin() < static_cast<std::ptrdiff_t>(reserve_->ofEarlier)) --reserve_->ofEarlier;
  idle.erase(found);
  return renderTarget;
}

void TexturePool::keep(std::vector<RenderTarget>& renderTargets) {
  if (reserve_ == nullptr) return;
  std::ranges::move(renderTargets, std::back_inserter(reserve_->kept));
  renderTargets.clear();
}

void TexturePool::release(Reserve& reserve) noexcept {
  for (std::vector<RenderTarget>* const list : {&reserve.idle, &reserve.kept}) {
    for (RenderTarget& renderTarget : *list) release(std::move(renderTarget));
    list->clear();
  }
  reserve.hasOverflown = false;
}

RenderTarget TexturePool::acquireIdle(std::uint64_t shapeKey) {
  const auto found = buckets_.find(shapeKey);
  if (found == buckets_.end() || found->second.idle.empty()) return {};
  std::vector<Idle>& idle = found->second.idle;
  RenderTarget renderTarget = std::move(idle.back().renderTarget);
  idle.pop_back();
  bytes_ -= renderTarget.texture.bytes();
  return renderTarget;
}

void TexturePool::release(RenderTarget&& renderTarget) noexcept {
  if (reserve_ != nullptr) {
    if (reserve_->idle.size() < reserve_->idle.capacity()) {
      reserve_->idle.push_back(std::move(renderTarget));
      return;
    }
    reserve_->hasOverflown = true;
  }
  const gl::Texture& texture = renderTarget.texture;
  const std::size_t bytes = texture.bytes();
  Bucket& bucket = buckets_.find(key(texture.format(), texture.shape()))->second;
  bucket.idle.push_back({std::move(renderTarget), clock_});
  --bucket.acquired;
  used_ -= static_cast<std::int64_t>(bytes);
  bytes_ += bytes;
}

void TexturePool::deleteOlderThan(std::int64_t time) {
  for (auto bucket = buckets_.begin(); bucket != buckets_.end();) {
    std::vector<Idle>& idle = bucket->second.idle;
    std::erase_if(idle, [&](const Idle& one) {
      if (one.since >= time) {
        return false;
      }
      bytes_ -= one.renderTarget.texture.bytes();
      framebuffers_.dropTexture(one.renderTarget.texture.name());
      return true;
    });
    const bool isUsed = !idle.empty() || bucket->second.acquired > 0;
    bucket = isUsed ? std::next(bucket) : buckets_.erase(bucket);
  }
}

}  // namespace sk
