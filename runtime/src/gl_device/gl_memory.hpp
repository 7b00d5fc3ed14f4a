// SPDX-License-Identifier: MIT
//
// The memory of a GL device: the textures of streams and calls with the framebuffers that draw to them, and the buffers of
// transfers.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "gl/capabilities.hpp"
#include "gl_device/gl_context.hpp"
#include "gl_device/memory/kept_scratch.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"
#include "trace/trace.hpp"

namespace sk {

/// Invariants: what is acquired here returns here, except for textures that are exchanged for others of the device, and returning
/// neither allocates nor calls GL. The trace, if there is one, knows how many bytes are in use after each change.
class GlMemory {
 public:
  /// `trace` is the device's, which may begin later; it and the context must outlive this object.
  GlMemory(GlContext& context, const std::unique_ptr<Trace>& trace);

  /// Acquires the planes of an element type from the pool, with undefined texels. Throws sk::Error, which names
  /// their purpose `whatFor`, if memory is exhausted.
  std::vector<RenderTarget> acquire(const program::Element& element, const assemble::TextureShape& shape,
                                    std::string_view whatFor);
  void release(std::vector<RenderTarget>& planes) noexcept;

  /// The framebuffer that draws to several planes, at most gl::maxDrawBuffers, all with layers or none. Valid until the next
  /// call. Throws sk::Error if the driver cannot draw to them together.
  gl::Framebuffer& framebufferOf(std::span<RenderTarget* const> planes);

  TexturePool& pool() { return pool_; }
  TransferBuffers& transferBuffers() { return transferBuffers_; }
  const std::shared_ptr<PendingReads>& pendingReads() const { return pendingReads_; }
  /// Texels on their way to or from host memory.
  KeptScratch<std::byte>& staging() { return staging_; }

  /// Deletes what has been idle for a number of calls. Must be called once per call.
  void trim() {
    pool_.trim();
    transferBuffers_.trim();
  }
  /// The context must be current.
  gl::MemoryInfo info() const;

 private:
  friend class PlanesLease;
  void add(std::vector<RenderTarget>& planes, const program::Element& element,
           const assemble::TextureShape& shape, std::string_view whatFor);
  [[noreturn]] void failForPlanes(const program::Element& element, const gl::Format& format,
                                  const assemble::TextureShape& shape, std::string_view whatFor);
  void countBytes() const noexcept {
    if (trace_) trace_->countBytes(pool_.bytesUsed(), pool_.bytesKept());
  }

  GlContext& context_;
  const std::unique_ptr<Trace>& trace_;
  FramebufferCache framebuffers_;
  TexturePool pool_;
  TransferBuffers transferBuffers_{context_.bound().deletions};
  const std::shared_ptr<PendingReads> pendingReads_ = std::make_shared<PendingReads>();
  KeptScratch<std::byte> staging_;
};

/// Holds planes from a device's pool and returns them when it is destroyed.
class PlanesLease {
 public:
  explicit PlanesLease(GlMemory& memory) : memory_(memory) {}
  ~PlanesLease() { memory_.release(planes); }
  PlanesLease(const PlanesLease&) = delete;
  PlanesLease& operator=(const PlanesLease&) = delete;

  /// Adds planes, like GlMemory::acquire().
  void add(const program::Element& element, const assemble::TextureShape& shape, std::string_view whatFor) {
    memory_.add(planes, element, shape, whatFor);
  }

  std::vector<RenderTarget> planes;

 private:
  GlMemory& memory_;
};

}  // namespace sk
