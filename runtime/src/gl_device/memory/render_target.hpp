// SPDX-License-Identifier: MIT
//
// A texture together with the framebuffer that draws to it and reads from it, and the pool of those
// that nobody uses, keyed by extent and format. Giving one back touches no GL, so that streams may
// be destroyed anywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "assemble/region_layout.hpp"
#include "gl/bound_state.hpp"
#include "gl/framebuffer.hpp"
#include "gl/texture.hpp"
#include "gl_device/memory/framebuffer_cache.hpp"

namespace sk {

struct RenderTarget {
  gl::Texture texture;
  gl::Framebuffer framebuffer;   ///< made when first needed

  gl::Framebuffer& framebufferIn(gl::BoundState& bound);
  explicit operator bool() const { return texture.name() != 0; }
};

class TexturePool {
 public:
  TexturePool(gl::BoundState& bound, FramebufferCache& framebuffers)
      : bound_(bound), framebuffers_(framebuffers) {}

  /// A render target with undefined texels; an empty one where there is no memory for it. The context is current.
  RenderTarget take(const gl::Format& format, const assemble::TextureShape& shape);
  /// Of a renderTarget that was taken. Allocates nothing.
  void give(RenderTarget&& renderTarget) noexcept;

  /// Deletes what has lain unused for a while, where there is much of it. Once a call.
  void trim() {
    ++clock_;
    if (bytes_ > keptBytes) {
      deleteOlderThan(clock_ - keptCalls);
    }
  }
  /// Of render targets that were taken, and of those that nobody uses.
  std::int64_t bytesUsed() const { return used_; }
  std::int64_t bytesKept() const { return static_cast<std::int64_t>(bytes_); }

 private:
  struct Idle {
    RenderTarget renderTarget;
    std::int64_t since;
  };
  struct Shelf {
    std::vector<Idle> idle;  ///< with room for those that were taken
    std::size_t taken = 0;
  };
  static constexpr std::size_t keptBytes = std::size_t{256} << 20;
  static constexpr std::int64_t keptCalls = 16;

  static std::uint64_t key(const gl::Format& format, const assemble::TextureShape& shape);
  /// Empty where there is none.
  RenderTarget takeIdle(std::uint64_t place);
  void deleteOlderThan(std::int64_t time);

  gl::BoundState& bound_;
  FramebufferCache& framebuffers_;
  std::unordered_map<std::uint64_t, Shelf> shelves_;
  std::size_t bytes_ = 0;
  std::int64_t used_ = 0;
  std::int64_t clock_ = 0;
};

}  // namespace sk
