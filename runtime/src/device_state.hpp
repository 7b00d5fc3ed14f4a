// SPDX-License-Identifier: MIT
//
// What a device owns: its context, the tracked bindings, the pool of surfaces, the programs; and the
// list of the streams that live on it. A DeviceScope is open wherever GL is called.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "framebuffer_cache.hpp"
#include "gl/bound_state.hpp"
#include "gl/linear_samplers.hpp"
#include "gl/open_context.hpp"
#include "gl/saved_state.hpp"
#include "gl/vertex_array.hpp"
#include "program_cache.hpp"
#include "sink_programs.hpp"
#include "sk/device.hpp"
#include "surface.hpp"
#include "variant.hpp"

namespace sk {

/// What a user may choose of a device that is found.
struct DeviceChoices {
  std::int32_t textureLimit = 0;    ///< 0: the device's own
  bool guaranteedLimits = false;
  bool pairs = false;               ///< doubles are pairs of floats even where GLSL has double
};

class DeviceState {
 public:
  DeviceState(gl::OpenedContext&& opened, const DeviceChoices& choices);
  ~DeviceState();
  DeviceState(const DeviceState&) = delete;
  DeviceState& operator=(const DeviceState&) = delete;

  /// Puts a stream on the list of those that must be told of the device's end, and takes it off.
  void add(StreamState& stream) noexcept;
  void remove(StreamState& stream) noexcept;

  /// New planes of an element type, with undefined texels. Throws sk::Error saying what for, where
  /// there is no memory.
  std::vector<Surface> takePlanes(const program::Element& element, const assemble::TextureShape& shape,
                                  std::string_view whatFor);
  void givePlanes(std::vector<Surface>& planes) noexcept;

  assemble::TextureLimits textureLimits() const { return {limits.textureSize, limits.textureLayers}; }

  /// Throws sk::Error where the driver has reported an error since it was last asked.
  void throwPendingError();

  gl::Context context;
  const gl::Capabilities capabilities;
  const assemble::Profile profile;       ///< of the table, but for what the device has of doubles
  DeviceLimits limits;
  gl::BoundState bound;
  FramebufferCache framebuffers;
  SurfacePool pool;
  ProgramCache programs;
  SinkPrograms sinkPrograms;
  gl::LinearSamplers samplers;
  gl::VertexArray vertexArray;
  std::vector<std::byte> staging;        ///< texels on their way; transfer.cpp's
  std::vector<Operand> operands;         ///< of the call that runs; run.cpp's

 private:
  void forgetObjects() noexcept;

  StreamState* firstStream_ = nullptr;
};

/// Makes a device's context current and ready for passes, for as long as it lives.
class DeviceScope {
 public:
  explicit DeviceScope(DeviceState& device) : current_(device.context) {
    if (device.context.isAdopted()) {
      saved_.emplace(device.capabilities, device.bound);
    }
    device.pool.trim();
  }

 private:
  gl::CurrentScope current_;
  std::optional<gl::SavedState> saved_;
};

/// Planes from the pool of a device for as long as this lives.
class PlanesLease {
 public:
  explicit PlanesLease(DeviceState& device) : device_(device) {}
  ~PlanesLease() { device_.givePlanes(planes); }
  PlanesLease(const PlanesLease&) = delete;
  PlanesLease& operator=(const PlanesLease&) = delete;

  std::vector<Surface> planes;

 private:
  DeviceState& device_;
};

}  // namespace sk
