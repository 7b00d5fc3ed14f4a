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
  const gl::TextureSize size{shape.width, shape.height, shape.layers};
  if (!renderTarget) renderTarget.texture = gl::Texture(bound_, format, size);
  if (!renderTarget && bytes_ > 0) {
    deleteOlderThan(clock_ + 1);
    bound_.deleteQueued();
    renderTarget.texture = gl::Texture(bound_, format, size);
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
    return key(one.texture.format(), one.shape()) == shapeKey;
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
  const std::size_t bytes = renderTarget.texture.bytes();
  Bucket& bucket = buckets_.find(key(renderTarget.texture.format(), renderTarget.shape()))->second;
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
