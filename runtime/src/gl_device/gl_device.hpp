// SPDX-License-Identifier: MIT
//
// A GL device: its context, the tracked bindings, the pool of render targets, the programs; and the
// list of the streams that live on it. A DeviceScope is open wherever GL is called.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "device/device_state.hpp"
#include "gl/bound_state.hpp"
#include "gl/labels.hpp"
#include "gl/open_context.hpp"
#include "gl/samplers.hpp"
#include "gl/saved_state.hpp"
#include "gl/value_buffer.hpp"
#include "gl/vertex_array.hpp"
#include "gl_device/append/append_programs.hpp"
#include "gl_device/memory/framebuffer_cache.hpp"
#include "gl_device/memory/render_target.hpp"
#include "gl_device/program/program_binaries.hpp"
#include "gl_device/program/program_cache.hpp"
#include "gl_device/program/variant.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"
#include "gl_device/transfer/transfer_buffers.hpp"
#include "native/rest_threads.hpp"
#include "probe/target_choice.hpp"
#include "support/cache_folder.hpp"

namespace sk {

class PassTrace;

/// What a user may choose of a device that is found.
struct DeviceChoices {
  std::int32_t textureLimit = 0;    ///< 0: the device's own
  bool guaranteedLimits = false;
  bool pairs = false;               ///< doubles are pairs of floats even where GLSL has double
  std::optional<Barrier> barrier = {};  ///< none: the one that proves itself
  Target target = Target::Default;  ///< Fragment, Compute, or what is faster
  bool sharesContext = false;  ///< the application draws in the device's own context
  std::optional<bool> sharesTexels = {};  ///< assemble::Profile::sharesTexels; none: on hardware
};

/// What of a call's options is in all of its programs.
struct ProgramChoice {
  assemble::Stage stage = assemble::Stage::Fragment;
  bool accurate = true;
  assemble::Doubles doubles = assemble::Doubles::Native;
  Barrier barrier = Barrier::Xor;
  bool tables = true;
  auto operator<=>(const ProgramChoice&) const = default;
};

class GlDevice final : public DeviceState {
 public:
  GlDevice(gl::OpenedContext&& opened, const DeviceChoices& choices);
  ~GlDevice() override;

  const std::string& name() const override { return capabilities.renderer; }
  const std::string& driver() const override { return capabilities.driver; }
  const std::string& shadingLanguage() const override { return capabilities.shadingLanguage; }
  std::string_view profileName() const override {
    return target == Target::Compute ? computeProfile.name : profile.name;
  }
  bool isSoftware() const override { return capabilities.isSoftware; }
  const Arithmetic& arithmetic() override;
  std::vector<TargetTrial> trialTargets() override;
  bool combinesScattered() const override { return capabilities.blendsFloats; }
  bool takesForms() const override { return true; }
  void checkProgram(const program::Kernel& kernel) override;
  void checkProgram(const program::Reduction& reduction) override;
  std::unique_ptr<StreamState> createStream(const program::Element& element, const Shape& shape,
                                            Storage storage) override;
  void startTrace(const std::string& file) override;
  void finish() override;
  void release() override { context.release(); }
  void makeCurrent() override;
  void run(const ResolvedCall& call) override;
  void reduce(const ResolvedReduction& call) override;

  /// New planes of an element type, with undefined texels. Throws sk::Error saying what for, where
  /// there is no memory.
  std::vector<RenderTarget> takePlanes(const program::Element& element, const assemble::TextureShape& shape,
                                       std::string_view whatFor);
  void givePlanes(std::vector<RenderTarget>& planes) noexcept;
  [[noreturn]] void failForPlanes(const program::Element& element, const gl::Format& format,
                                  const assemble::TextureShape& shape, std::string_view whatFor);
  void countBytes() const noexcept {
    if (trace) trace->countBytes(pool.bytesUsed(), pool.bytesKept());
  }

  /// Whether the application draws in the context, too, so that each call puts its state back.
  bool isGuest() const { return context.isAdopted() || sharesContext_; }

  assemble::TextureLimits textureLimits() const { return {limits.textureSize, limits.textureLayers}; }

  /// Throws sk::Error where the device computes nothing as the options say. No DeviceScope is open.
  void checkOptions(const program::Kernel& kernel, const CallOptions& options);
  /// run() without that check: what the check itself runs.
  void runUnchecked(const ResolvedCall& call);
  void runUnchecked(const program::Kernel& kernel, std::span<const Argument> arguments,
                    const CallOptions& options);
  /// Throws sk::Error where a kernel cannot use a stream that holds its floats as something else. `plan`: the passes that
  /// it takes; null where it takes one.
  void checkStorages(const program::Kernel& kernel, std::span<const Argument> arguments,
                     const program::Plan* plan = nullptr) const;
  /// From here on, the programs are those for a call with these options.
  void choose(const CallOptions& options, assemble::Stage stage);
  /// What runs the kernel, or the fold of a reduction, in a call with these options. No scope of the device is open.
  assemble::Stage stageOf(const program::Kernel& kernel, KernelClass kernels, const CallOptions& options);
  ProgramCache& programs() { return *programs_; }
  /// The texture of a table, made at first. Binds a texture.
  GLuint textureOf(const FunctionTable& table);

  /// Throws sk::Error where the driver has reported an error since it was last asked; the streams that were written meanwhile are
  /// broken then.
  void throwPendingError();
  /// Throws sk::Error where the context is lost. Asks the driver: for after a failure, whose reason this may be.
  void throwIfLost();
  /// The context, unless it is known to be lost, in which case this throws sk::Error.
  const gl::Context& livingContext() const {
    if (bound.errors.isLost()) failAsLost();
    return context;
  }
  /// Between two looks at the driver's errors, streams are written in the same period.
  std::int64_t period() const { return period_; }

  gl::Context context;
  const gl::Capabilities capabilities;
  const assemble::Profile profile;  ///< of fragment programs: that of the table, but for what the device has
  const assemble::Profile computeProfile;  ///< of compute programs; of no meaning where it has none
  const Target target;  ///< Fragment, Compute, or what is faster
  Barrier barrier;  ///< of programs; only arithmetic() tells whether it holds
  gl::BoundState bound;

 private:
  /// Deletes what all members below have left.
  struct LastDeletions {
    GlDevice& device;
    ~LastDeletions();
  };
  LastDeletions lastDeletions_{*this};

 public:
  FramebufferCache framebuffers;
  TexturePool pool;
  AppendPrograms appendPrograms;
  gl::Samplers samplers{bound.deletions};
  gl::ValueBuffer values;
  gl::VertexArray vertexArray;
  const std::shared_ptr<PendingReads> pendingReads = std::make_shared<PendingReads>();
  TransferBuffers transferBuffers{bound.deletions};
  gl::Labels labels;
  const CacheFolder cache;
  ProgramBinaries binaries;
  std::unique_ptr<PassTrace> passes;  ///< null where there is no trace
  std::vector<std::byte> staging;  ///< texels on their way; transfer/transfer.cpp
  std::vector<Operand> operands;  ///< of the call that runs; pass/run_kernel.cpp
  bool hasDrawn = false;  ///< since the last dispatch

 private:
  bool takesPairs(const CallOptions& options) const;
  assemble::Stage fasterFor(KernelClass kernels);
  bool mayDispatch(const program::Kernel& kernel) const;
  /// Throws sk::Error where a kernel cannot run as what a call asks for.
  void checkTarget(const program::Kernel& kernel, Target asked) const;
  void needExactSums(const program::Kernel& kernel);
  [[noreturn]] void failAsLost() const;

  std::int64_t period_ = 1;
  const bool sharesContext_;
  std::map<ProgramChoice, ProgramCache> caches_;
  std::map<const FunctionTable*, gl::Texture> tableTextures_;
  ProgramCache* programs_ = nullptr;  ///< one of them
  ProgramChoice chosen_;  ///< its key
  std::optional<Arithmetic> arithmetic_;
  std::array<std::optional<assemble::Stage>, kernelClasses> faster_;
};

/// Makes a device's context current and ready for passes, for as long as it lives.
class DeviceScope {
 public:
  explicit DeviceScope(GlDevice& device) : current_(device.livingContext()) {
    device.bound.deleteQueued();
    if (device.isGuest()) {
      saved_.emplace(device.capabilities, device.bound);
    }
    device.pool.trim();
    device.transferBuffers.trim();
    if (device.isSoftware()) native::restThreads();
  }

 private:
  gl::CurrentScope current_;
  std::optional<gl::SavedState> saved_;
};

/// Planes from the pool of a device for as long as this lives.
class PlanesLease {
 public:
  explicit PlanesLease(GlDevice& device) : device_(device) {}
  ~PlanesLease() { device_.givePlanes(planes); }
  PlanesLease(const PlanesLease&) = delete;
  PlanesLease& operator=(const PlanesLease&) = delete;

  /// Adds planes, as GlDevice::takePlanes().
  void add(const program::Element& element, const assemble::TextureShape& shape, std::string_view whatFor);

  std::vector<RenderTarget> planes;

 private:
  GlDevice& device_;
};

}  // namespace sk
