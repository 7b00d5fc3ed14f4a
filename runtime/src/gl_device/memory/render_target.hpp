// SPDX-License-Identifier: MIT
//
// A texture with the framebuffer that draws to it and reads from it, framebuffers that draw to several, and the pool of idle render
// targets, keyed by size and format. Returning one to the pool does not call GL, so that a stream may be destroyed
// while the context is not current.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "assemble/region_layout.hpp"
#include "gl/bound_state.hpp"
#include "gl/capabilities.hpp"
#include "gl/texture.hpp"

namespace sk {

struct RenderTarget {
  gl::Texture texture;
  gl::Framebuffer framebuffer;  ///< created on first use

  gl::Framebuffer& framebufferIn(gl::BoundState& bound);
  assemble::TextureShape shape() const {
    return {texture.size().width, texture.size().height, texture.size().layers};
  }
  explicit operator bool() const { return texture.name() != 0; }
};

/// Framebuffers that draw to several textures, cached by the textures' names.
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

class TexturePool {
 public:
  /// Idle render targets of `keptBytes` in all stay however long they are idle (kept_bytes.hpp).
  TexturePool(gl::BoundState& bound, FramebufferCache& framebuffers, std::size_t keptBytes)
      : bound_(bound), framebuffers_(framebuffers), keptBytes_(keptBytes) {}

  /// Returns a render target with undefined texels, or an empty one if memory is exhausted. The context must
  /// be current.
  RenderTarget acquire(const gl::Format& format, const assemble::TextureShape& shape);
  /// Returns a render target from acquire() to the pool. Never allocates, and does not call GL.
  void release(RenderTarget&& renderTarget) noexcept;

  /// Render targets that a loop has set aside: no other call draws to them. They count as in use. Small ones are
  /// acquired in the order of their release, and not twice in an iteration, so that an iteration mostly finds what
  /// the one before the last has used; of large ones, the last that was released, so that there are few.
  struct Reserve {
    std::vector<RenderTarget> idle;  ///< in the order of their release
    std::size_t ofEarlier = 0;  ///< how many of them were idle when the iteration began, and still are
    std::vector<RenderTarget> kept;  ///< whose texels stay as they are
    bool hasOverflown = false;  ///< a render target has gone to the pool instead
  };
  /// Has acquire() look in a reserve first, and release() return to it; null: in none.
  void use(Reserve* reserve) noexcept { reserve_ = reserve; }
  Reserve* reserve() const noexcept { return reserve_; }
  /// If there is a reserve, moves render targets to it whose texels must stay.
  void keep(std::vector<RenderTarget>& renderTargets);
  /// Returns the render targets of a reserve to the pool.
  void release(Reserve& reserve) noexcept;

  /// Deletes the render targets that have been idle for a number of calls, if idle ones take much memory.
  /// Must be called once per call.
  void trim() {
    ++clock_;
    if (bytes_ > keptBytes_) {
      deleteOlderThan(clock_ - keptCalls);
    }
  }
  /// The bytes of render targets in use, and of idle ones.
  std::int64_t bytesUsed() const { return used_; }
  std::int64_t bytesKept() const { return static_cast<std::int64_t>(bytes_); }

 private:
  struct Idle {
    RenderTarget renderTarget;
    std::int64_t since;
  };
  struct Bucket {
    std::vector<Idle> idle;  ///< has capacity for the acquired ones as well
    std::size_t acquired = 0;
  };
  static constexpr std::size_t smallBytes = std::size_t{1} << 20;
  static constexpr std::int64_t keptCalls = 16;

  static std::uint64_t key(const gl::Format& format, const assemble::TextureShape& shape);
  RenderTarget acquireReserved(std::uint64_t shapeKey);
  /// Returns an empty render target if no idle one has this key.
  RenderTarget acquireIdle(std::uint64_t shapeKey);
  void deleteOlderThan(std::int64_t time);

  gl::BoundState& bound_;
  FramebufferCache& framebuffers_;
  const std::size_t keptBytes_;
  Reserve* reserve_ = nullptr;
  std::unordered_map<std::uint64_t, Bucket> buckets_;
  std::size_t bytes_ = 0;
  std::int64_t used_ = 0;
  std::int64_t clock_ = 0;
};

/// Leaves the reserve alone as long as this object lives: for what TexturePool::keep() takes.
class UnreservedScope {
 public:
  explicit UnreservedScope(TexturePool& pool) : pool_(pool), reserve_(pool.reserve()) { pool_.use(nullptr); }
  ~UnreservedScope() { pool_.use(reserve_); }
  UnreservedScope(const UnreservedScope&) = delete;
  UnreservedScope& operator=(const UnreservedScope&) = delete;

 private:
  TexturePool& pool_;
  TexturePool::Reserve* reserve_;
};

}  // namespace sk
