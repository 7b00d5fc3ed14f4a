// SPDX-License-Identifier: MIT
//
// A GL device: what every kind of device does, in terms of its four parts. Code that calls GL must be inside a DeviceScope.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/condition.hpp"
#include "assemble/program/tile_program.hpp"
#include "device/device_state.hpp"
#include "gl/open_context.hpp"
#include "gl/queue_points.hpp"
#include "gl_device/gl_context.hpp"
#include "gl_device/gl_memory.hpp"
#include "gl_device/gl_passes.hpp"
#include "gl_device/gl_programs.hpp"
#include "support/cache_folder.hpp"

namespace sk {

/// The user's choices for a device that has been found.
struct DeviceChoices {
  std::int32_t textureLimit = 0;  ///< largest texture size; 0: the device's own limit
  bool guaranteedLimits = false;
  bool pairs = false;  ///< doubles are pairs of floats even if GLSL has double
  std::optional<Barrier> barrier = {};  ///< nullopt: chosen by testing the device's arithmetic
  Target target = Target::Default;  ///< Fragment or Compute; Default: whichever is faster
  bool sharesContext = false;  ///< the application draws in the device's own context
  gl::TraitChoices traits = {};
  std::optional<std::int32_t> scanPatience = {};  ///< ScanAccess::patience of scans in one pass
};

/// A device on OpenGL. Its parts state their invariants where they are declared. Its own: once the driver has reported an error, all
/// streams that were written in the same period are marked as lost.
class GlDevice final : public DeviceState {
 public:
  GlDevice(gl::OpenedContext&& opened, const DeviceChoices& choices);
  ~GlDevice() override;

  const std::string& name() const override { return capabilities.renderer; }
  const std::string& driver() const override { return capabilities.driver; }
  const std::string& shadingLanguage() const override { return capabilities.shadingLanguage; }
  std::string_view profileName() const override { return programs_.profileName(); }
  bool isSoftware() const override { return capabilities.isSoftware; }
  const Arithmetic& arithmetic() override { return programs_.arithmetic(); }
  std::string_view kind() const override { return gl::nameOf(capabilities.kind); }
  std::vector<DeviceTrait> traitValues() const override;
  std::vector<TargetTrial> trialTargets() override { return programs_.trialTargets(); }
  bool hasQueue() const override { return true; }
  bool placesDomains() const override { return true; }
  bool combinesScattered() const override { return capabilities.blendsFloats; }
  bool usesPrecisionVariants() const override { return true; }
  void checkProgram(const program::Kernel& kernel) override { programs_.checkKernel(kernel); }
  void checkProgram(const program::Reduction& reduction) override {
    programs_.checkKernel(reduction.fold);
    programs_.checkKernel(reduction.combine);
  }
  std::unique_ptr<StreamState> createStream(const program::Element& element, const Shape& shape,
                                            Storage storage) override;
  void startTrace(const std::string& file) override;
  std::optional<std::int64_t> availableMemory() override;
  void finish() override;
  bool beginMeasuring() override;
  std::int64_t endMeasuring() override;
  void release() override { context_.handle().release(); }
  void makeCurrent() override;
  void checkProcess() const override { context_.handle().checkProcess(); }
  void run(const ResolvedCall& call) override;
  std::unique_ptr<RecordedCall> prepare(const ResolvedCall& call) override;  // fuse/gl_call.cpp
  std::unique_ptr<RecordedCall> prepareScalars(ScalarPass pass) override;
  std::unique_ptr<LoopRunner> makeLoopRunner() override;
  bool needsDense(const program::Kernel& kernel, std::span<const Argument> arguments, std::size_t i) override;
  bool needsDense(const StreamRegion& region) override;
  void reduce(const ResolvedReduction& call) override;
  void forget(const program::Reduction& reduction) override {
    const GlContext::Scope scope(context_);
    programs_.forget(reduction);
  }
  bool foldsBesideOutputs(const ResolvedReduction& call) override;
  std::optional<std::int64_t> reorder(const Reordering& reordering) override;
  std::unique_ptr<Staging> makeStaging(Staging::Way way) override;

  GlContext& context() { return context_; }
  /// What is bound in the context.
  gl::BoundState& bound() { return context_.bound(); }
  GlMemory& memory() { return memory_; }
  GlPrograms& programs() { return programs_; }
  const GlPrograms& programs() const { return programs_; }
  GlPasses& passes() { return passes_; }

  assemble::TextureLimits textureLimits() const {
    return {limits.textureSize, limits.textureLayers, capabilities.hasCompute && traits.narrowTextures};
  }

  /// Runs a kernel that computes its domain by tiles. The call has no plan and no box.
  void runTiles(const ResolvedCall& call, const assemble::TilePlan& plan);
  /// run() without GlPrograms::checkOptions(), whose tests of the device call this.
  void runUnchecked(const ResolvedCall& call);
  void runUnchecked(const program::Kernel& kernel, std::span<const Argument> arguments,
                    const CallOptions& options);
  /// Throws sk::Error if a kernel cannot use a stream because of its storage. Streams that the kernel does not
  /// need may be of any storage and device. `plan` has the passes of the kernel; null if one pass is enough.
  void checkStorages(const program::Kernel& kernel, std::span<const Argument> arguments,
                     const assemble::SpecValues& specs, const program::Plan* plan = nullptr) const;
  /// Throws sk::Error if the driver has reported an error since the last call, or has ended loops early. The streams that were
  /// written since then are marked as broken.
  void throwPendingError();

  const gl::Capabilities capabilities;
  const gl::DeviceTraits traits;
  const Target target;  ///< Fragment or Compute; Default: whichever is faster
  const std::optional<std::int32_t> scanPatience;
  const CacheFolder cache;  ///< what was measured of the device, and its programs

 private:
  void loseStreamsSince(std::int64_t period);

  GlContext context_;
  GlMemory memory_{context_, trace};
  GlPrograms programs_;
  GlPasses passes_{context_};
  gl::Timestamp begun_, ended_;  ///< of beginMeasuring() and endMeasuring(), made when they are needed
};

/// The scope of a call, in which GL may be called (GlContext::Scope). There is one at a time.
class DeviceScope {
 public:
  explicit DeviceScope(GlDevice& device) : scope_(device.context()) {
    device.memory().trim();
    device.passes().beginCall();
  }

 private:
  const GlContext::Scope scope_;
};

}  // namespace sk
