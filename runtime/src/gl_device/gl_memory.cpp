// SPDX-License-Identifier: MIT
#include "gl_device/gl_memory.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include "gl_device/memory/kept_bytes.hpp"
#include "sk/error.hpp"
#include "support/checked_size.hpp"
#include "support/host_limits.hpp"

namespace sk {

namespace {

/// Makes glibc keep free memory at the end of the heap instead of returning it to the system. llvmpipe
/// allocates tens of KiB for each draw whose uniforms have changed, and frees them after drawing. By default,
/// glibc trims the heap from 128 KiB on, so that every draw faults in new pages, which takes several times as
/// long as the rest of a call. When a program frees a large block, glibc raises the limit to twice the
/// block's size (mallopt(3), M_TRIM_THRESHOLD): this function frees one whose pages were never touched. It
/// has no effect with other C libraries, or if MALLOC_TRIM_THRESHOLD_ or mallopt() sets the limit.
void keepHeap() noexcept {
  // the largest block from which glibc adapts its thresholds (M_MMAP_THRESHOLD), less room for its header
  constexpr std::size_t bytes = (std::size_t{32} << 20) - (std::size_t{64} << 10);
  void* volatile block = std::malloc(bytes);  // volatile: a compiler may remove an unused allocation
  std::free(block);
}

}  // namespace

GlMemory::GlMemory(GlContext& context, const std::unique_ptr<Trace>& trace)
    : context_(context),
      trace_(trace),
      framebuffers_(context.bound()),
      pool_(context.bound(), framebuffers_, keptBytesOn(context.handle(), context.capabilities())) {
  if (context.capabilities().isSoftware) keepHeap();
}

std::vector<RenderTarget> GlMemory::acquire(const program::Element& element,
                                            const assemble::TextureShape& shape, std::string_view whatFor) {
  PlanesLease lease(*this);
  lease.add(element, shape, whatFor);
  return std::exchange(lease.planes, {});
}

void GlMemory::add(std::vector<RenderTarget>& planes, const program::Element& element,
                   const assemble::TextureShape& shape, std::string_view whatFor) {
  planes.reserve(planes.size() + element.fields.size());
  for (const program::Field& field : element.fields) {
    const gl::Format& format = gl::formatOf(field);
    RenderTarget plane = pool_.acquire(format, shape);
    if (!plane) failForPlanes(element, format, shape, whatFor);
    planes.push_back(std::move(plane));
    context_.labels().texture(planes.back().texture.name(), whatFor);
  }
  countBytes();
}

void GlMemory::failForPlanes(const program::Element& element, const gl::Format& format,
                             const assemble::TextureShape& shape, std::string_view whatFor) {
  const std::int64_t texels = std::int64_t{shape.width} * shape.height * std::max(shape.layers, 1);
  context_.failForMemory(fmt::format("{}: {} texture(s) of {} x {}{} texels, one of them of {}", whatFor,
                                     element.fields.size(), shape.width, shape.height,
                                     shape.layers == 0 ? "" : fmt::format(" x {}", shape.layers),
                                     bytesText(texels * static_cast<std::int64_t>(format.texelBytes()))));
}

void GlMemory::release(std::vector<RenderTarget>& planes) noexcept {
  for (RenderTarget& plane : planes) {
    pool_.release(std::move(plane));
  }
  planes.clear();
  countBytes();
}

gl::Framebuffer& GlMemory::framebufferOf(std::span<RenderTarget* const> planes) {
  std::array<GLuint, gl::maxDrawBuffers> names{};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    names[i] = planes[i]->texture.name();
  }
  gl::Framebuffer* const framebuffer =
      framebuffers_.framebufferOf(std::span(names).first(planes.size()), planes.front()->texture.isLayered());
  if (framebuffer == nullptr) {
    context_.throwIfLost();
    throw Error("the driver cannot draw to these textures at once; write fewer outputs in one kernel",
                Error::Kind::Device);
  }
  return *framebuffer;
}

gl::MemoryInfo GlMemory::info() const {
  if (!context_.capabilities().isSoftware) return gl::readMemoryInfo();
  const HostMemory host = hostMemory();
  return {host.whole, host.available};
}

}  // namespace sk
