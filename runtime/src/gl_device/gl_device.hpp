// SPDX-License-Identifier: MIT
//
// A GL device: its context, the tracked bindings, the pool of render targets, the programs, and the list of
// the streams that live on it. Code that calls GL must be inside a DeviceScope.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/condition.hpp"
#include "device/device_state.hpp"
#include "device/unload_watch.hpp"
#include "gl/open_context.hpp"
#include "gl_device/append/append_programs.hpp"
#include "gl_device/gl_context.hpp"
#include "gl_device/gl_memory.hpp"
#include "gl_device/gl_passes.hpp"
#include "gl_device/program/made_kernels.hpp"
#include "gl_device/program/program_binaries.hpp"
#include "gl_device/program/program_cache.hpp"
#include "gl_device/program/variant.hpp"
#include "gl_device/sort/device_sort.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"
#include "gl_device/transfer/gl_staging.hpp"
#include "probe/target_choice.hpp"
#include "support/cache_folder.hpp"

namespace sk {

/// The user's choices for a device that has been found.
struct DeviceChoices {
  std::int32_t textureLimit = 0;    ///< largest texture size; 0: the device's own limit
  bool guaranteedLimits = false;
  bool pairs = false;               ///< doubles are pairs of floats even if GLSL has double
  std::optional<Barrier> barrier = {};  ///< nullopt: chosen by testing the device's arithmetic
  Target target = Target::Default;  ///< Fragment or Compute; Default: whichever is faster
  bool sharesContext = false;  ///< the application draws in the device's own context
  gl::TraitChoices traits = {};
  std::optional<std::int32_t> scanPatience = {};  ///< ScanAccess::patience of scans in one pass
};

/// The options of a call that affect all of its programs: a program cache's key.
struct ProgramCacheKey {
  assemble::Stage stage = assemble::Stage::Fragment;
  bool accurate = true;
  assemble::Doubles doubles = assemble::Doubles::Native;
  Barrier barrier = Barrier::Xor;
  bool asWritten = true;  ///< assemble::Profile::asWritten
  bool tables = true;
  auto operator<=>(const ProgramCacheKey&) const = default;
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
  std::string_view kind() const override { return gl::nameOf(capabilities.kind); }
  std::vector<DeviceTrait> traitValues() const override;
  std::vector<TargetTrial> trialTargets() override;
  bool hasQueue() const override { return true; }
  bool placesDomains() const override { return true; }
  bool combinesScattered() const override { return capabilities.blendsFloats; }
  bool usesPrecisionVariants() const override { return true; }
  void checkProgram(const program::Kernel& kernel) override;
  void checkProgram(const program::Reduction& reduction) override;
  std::unique_ptr<StreamState> createStream(const program::Element& element, const Shape& shape,
                                            Storage storage) override;
  void startTrace(const std::string& file) override;
  std::optional<std::int64_t> availableMemory() override;
  void finish() override;
  void release() override { context_.any().release(); }
  void makeCurrent() override;
  void run(const ResolvedCall& call) override;
  std::unique_ptr<RecordedCall> prepareScalars(ScalarPass pass) override;
  std::unique_ptr<LoopRunner> makeLoopRunner() override;
  bool needsDense(const program::Kernel& kernel, std::span<const Argument> arguments, std::size_t i) override;
  bool needsDense(const StreamRegion& region) override;
  void reduce(const ResolvedReduction& call) override;
  bool foldsBesideOutputs(const ResolvedReduction& call) override;
  std::optional<std::int64_t> reorder(const Reordering& reordering) override;
  std::unique_ptr<Staging> makeStaging(Staging::Way way) override;

  GlContext& context() { return context_; }
  /// What is bound in the context.
  gl::BoundState& bound() { return context_.bound(); }
  GlMemory& memory() { return memory_; }
  GlPasses& passes() { return passes_; }

  assemble::TextureLimits textureLimits() const {
    return {limits.textureSize, limits.textureLayers, capabilities.hasCompute && traits.narrowTextures};
  }

  /// Throws sk::Error if the device cannot run the kernel with these options. No DeviceScope may be open.
  void checkOptions(const program::Kernel& kernel, const CallOptions& options);
  /// run() without checkOptions(), whose tests of the device call this.
  void runUnchecked(const ResolvedCall& call);
  void runUnchecked(const program::Kernel& kernel, std::span<const Argument> arguments,
                    const CallOptions& options);
  /// Throws sk::Error if a kernel cannot use a stream because of its storage. Streams that the kernel does not
  /// need may be of any storage and device. `plan` has the passes of the kernel; null if one pass is enough.
  void checkStorages(const program::Kernel& kernel, std::span<const Argument> arguments,
                     const assemble::SpecValues& specs, const program::Plan* plan = nullptr) const;
  /// Selects the program cache for a call with these options, which programs() then returns.
  void selectPrograms(const CallOptions& options, assemble::Stage stage);
  /// The stage that runs a kernel, or the fold of a reduction, in a call with these options. May measure
  /// which one is faster. No DeviceScope may be open.
  /// `elements` is the size of the domain, where it counts.
  assemble::Stage stageOf(const program::Kernel& kernel, KernelClass kernels, const CallOptions& options,
                          std::int64_t elements = std::numeric_limits<std::int64_t>::max());
  ProgramCache& programs() { return *programs_; }
  /// Deletes all programs of a kernel that is about to end.
  void forget(const program::Kernel& kernel) noexcept {
    for (auto& [key, programs] : caches_) programs.forget(kernel);
  }
  /// Selects fragment programs for a call that compute programs cannot run. Throws sk::Error if the kernel has none.
  void selectDrawnPrograms(const program::Kernel& kernel, const CallOptions& options);
  /// The texture of one of the device's tables, created on first use. Binds a texture.
  GLuint textureOf(const FunctionTable& table);

  /// Throws sk::Error if the driver has reported an error since the last call. The streams that were written
  /// since then are marked as broken.
  void throwPendingError();

  const gl::Capabilities capabilities;
  const gl::DeviceTraits traits;
  const assemble::Profile profile;  ///< of fragment programs: the table's row, adapted to the device
  const assemble::Profile computeProfile;  ///< of compute programs; unused if the device has none
  const Target target;  ///< Fragment or Compute; Default: whichever is faster
  const std::optional<std::int32_t> scanPatience;
  Barrier barrier;  ///< of programs; arithmetic() tests whether it is effective

 private:
  GlContext context_;
  GlMemory memory_{context_, trace};
  GlPasses passes_{context_};

 public:
  AppendPrograms appendPrograms;
  SortPrograms sortPrograms;
  StagingPrograms stagingPrograms;
  MadeKernels scalarKernels{*this};
  MadeKernels mergeKernels{*this};
  const CacheFolder cache;
  ProgramBinaries binaries;

 private:
  bool computesInPairs(const CallOptions& options) const;
  assemble::Stage fasterFor(KernelClass kernels);
  bool mayDispatch(const program::Kernel& kernel) const;
  /// Throws sk::Error if a kernel cannot run on the target that a call requests.
  void checkTarget(const program::Kernel& kernel, const CallOptions& options) const;
  void needExactSums(const program::Kernel& kernel);

  std::map<ProgramCacheKey, ProgramCache> caches_;
  std::map<std::uint64_t, gl::Texture> tableTextures_;  ///< by FunctionTable::number
  UnloadWatch unloads_;
  ProgramCache* programs_ = nullptr;  ///< the selected cache
  ProgramCacheKey cacheKey_;  ///< the key of the selected cache
  std::optional<Arithmetic> arithmetic_;
  std::array<std::optional<assemble::Stage>, kernelClasses> faster_;
};

/// The scope of a call on a device (GlContext::Scope).
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
