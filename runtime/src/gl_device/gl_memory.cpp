// SPDX-License-Identifier: MIT
#include "gl_device/gl_memory.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "sk/error.hpp"
#include "support/host_memory.hpp"

namespace sk {

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
  context_.throwIfLost();
  const std::int64_t texels = std::int64_t{shape.width} * shape.height * std::max(shape.layers, 1);
  throw Error(
      fmt::format("'{}' has no memory for {}: {} texture(s) of {} x {}{} texels, one of them of {} MiB",
                  context_.capabilities().renderer, whatFor, element.fields.size(), shape.width, shape.height,
                  shape.layers == 0 ? "" : fmt::format(" x {}", shape.layers),
                  (texels * static_cast<std::int64_t>(format.texelBytes())) >> 20),
      Error::Kind::Memory);
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
