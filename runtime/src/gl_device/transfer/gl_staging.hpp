// SPDX-License-Identifier: MIT
//
// Staging memory of a GL device: buffers that stay mapped, and compute programs.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "assemble/region_layout.hpp"
#include "device/device_state.hpp"
#include "gl/buffer.hpp"
#include "gl/format.hpp"
#include "gl/queue_points.hpp"
#include "gl_device/program/program_binaries.hpp"

namespace sk {

class GlDevice;
class GlPrograms;
class GlStream;

/// Its programs, which are compiled on first use and kept as long as the device.
class StagingPrograms {
 public:
  explicit StagingPrograms(GlPrograms& owner) : owner_(owner) {}
  /// Throws sk::Error if the driver rejects it.
  IntegerProgram& of(Staging::Way way, const gl::Format& format, bool isLayered);

 private:
  GlPrograms& owner_;
  std::map<std::pair<std::size_t, bool>, std::unique_ptr<IntegerProgram>> programs_[2];
};

class GlStaging final : public Staging {
 public:
  GlStaging(GlDevice& device, Way way);
  /// Whether a device has what it takes: GL 4.4, or 4.3 with GL_ARB_buffer_storage.
  static bool isPossible(const GlDevice& device);

  std::size_t bytesOf(const StreamRegion& box) const override;
  std::byte* room(std::size_t bytes) override;
  void copy(const StreamRegion& box, std::size_t offset) override;
  void flush() override;
  void wait() override;

 private:
  /// A box of one plane.
  struct PlaneBox {
    GlStream* stream;
    std::size_t plane;
    int channels;  ///< of an element
    assemble::RegionLayout place;
    std::int32_t firstWord;

    bool isOfPlane(const PlaneBox& other) const { return stream == other.stream && plane == other.plane; }
  };

  void copyBoxes(std::span<const PlaneBox> boxes);

  GlDevice& device_;
  const Way way_;
  gl::StorageBuffer buffer_;
  std::vector<PlaneBox> boxes_;  ///< to be copied by flush()
  gl::Fence fence_;
};

}  // namespace sk
