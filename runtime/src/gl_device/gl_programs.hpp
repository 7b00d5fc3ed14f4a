// SPDX-License-Identifier: MIT
//
// The programs of a GL device: which stage and which options a call's programs have, what of the device's arithmetic they rely on,
// and the caches that keep them.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "device/unload_watch.hpp"
#include "gl/texture.hpp"
#include "gl_device/append/append_programs.hpp"
#include "gl_device/fuse/tile_trials.hpp"
#include "gl_device/program/made_kernels.hpp"
#include "gl_device/program/program_binaries.hpp"
#include "gl_device/program/program_cache.hpp"
#include "gl_device/sort/device_sort.hpp"
#include "gl_device/transfer/gl_staging.hpp"
#include "probe/target_choice.hpp"
#include "sk/device.hpp"
#include "sk/options.hpp"

namespace sk {

class GlDevice;
struct DeviceChoices;
struct FunctionTable;

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

/// Invariants: a call selects a cache once, and all of its programs of kernels have the same options. Where programs compute with
/// pairs of floats, the device has passed the test of its arithmetic.
class GlPrograms {
 public:
  /// The device's context must exist, and the device must outlive this object. Throws sk::Error if the device lacks the chosen
  /// barrier or target.
  GlPrograms(GlDevice& device, const DeviceChoices& choices);

  /// The profile of fragment programs: the table's row, adapted to the device.
  const assemble::Profile& profile() const { return profile_; }
  /// The profile of compute programs. Nothing uses it if the device has none.
  const assemble::Profile& computeProfile() const { return computeProfile_; }

  /// The profile that the user sees.
  std::string_view profileName() const;

  /// What keeps the driver from simplifying rounding errors away; arithmetic() tests whether it is effective.
  Barrier barrier() const { return barrier_; }
  void setBarrier(Barrier barrier) { barrier_ = barrier; }
  /// Tests the device's arithmetic on first use. No DeviceScope may be open.
  const Arithmetic& arithmetic();
  /// Tests what a kernel relies on. Throws sk::Error if the device fails. No DeviceScope may be open.
  void checkKernel(const program::Kernel& kernel);
  /// Throws sk::Error if the device cannot run the kernel with these options. No DeviceScope may be open.
  void checkOptions(const program::Kernel& kernel, const CallOptions& options);

  /// The stage that runs a kernel, or the fold of a reduction, in a call with these options. May measure
  /// which one is faster. No DeviceScope may be open.
  /// `elements` is the size of the domain, where it counts.
  assemble::Stage stageOf(const program::Kernel& kernel, KernelClass kernels, const CallOptions& options,
                          std::int64_t elements = std::numeric_limits<std::int64_t>::max());
  std::vector<TargetTrial> trialTargets();

  /// Selects the cache for a call with these options.
  void select(const CallOptions& options, assemble::Stage stage);
  /// Selects fragment programs for a call that compute programs cannot run. Throws sk::Error if the kernel has none.
  void selectDrawn(const program::Kernel& kernel, const CallOptions& options);
  /// Throws sk::Error for a call that must be dispatched, and writes what compute programs cannot write.
  [[noreturn]] void failForImages(const program::Kernel& kernel) const;
  ProgramCache& selected() { return *selected_; }
  /// The programs of a pass over elements that writes these planes: the selected ones, or fragment programs with the same options if
  /// those are compute programs and cannot write the planes. Throws sk::Error if the kernel has no fragment programs.
  ProgramCache& selectedFor(const program::Kernel& kernel, std::span<RenderTarget* const> planes);
  /// The same for a pass that writes a plane of this format.
  ProgramCache& selectedFor(const program::Kernel& kernel, const gl::Format& format);
  /// Whether compute programs write images of a format, and of all formats of an element's planes.
  bool mayStore(const gl::Format& format) const { return stored_[format.index]; }
  bool mayStore(const program::Element& element) const;
  bool mayStore(std::span<RenderTarget* const> planes) const;
  /// Whether the selected programs are compute programs.
  bool areDispatched() const { return selected_->stage() == assemble::Stage::Compute; }

  /// Builds a program that contains no kernel, and binds it. Throws sk::Error, which says of `what` it is, if the driver rejects it.
  std::unique_ptr<IntegerProgram> build(gl::ProgramSources sources, std::string_view what);
  AppendPrograms& ofAppends() { return ofAppends_; }
  SortPrograms& ofSorts() { return ofSorts_; }
  StagingPrograms& ofStaging() { return ofStaging_; }

  MadeKernels& scalarKernels() { return scalarKernels_; }
  MadeKernels& mergeKernels() { return mergeKernels_; }
  MadeKernels& fusedKernels() { return fusedKernels_; }
  TileTrials& tileTrials() { return tileTrials_; }
  /// Delete all programs of a kernel or reduction that is about to end.
  void forget(const program::Kernel& kernel) noexcept {
    for (auto& [key, cache] : caches_) cache.forget(kernel);
  }
  void forget(const program::Reduction& reduction) noexcept {
    for (auto& [key, cache] : caches_) cache.forget(reduction);
  }

  const ProgramBinaries& binaries() const { return binaries_; }
  /// The texture of one of the device's tables, created on first use. Binds a texture.
  GLuint textureOf(const FunctionTable& table);

 private:
  bool computesInPairs(const CallOptions& options) const;
  assemble::Stage fasterFor(KernelClass kernels);
  bool mayDispatch(const program::Kernel& kernel) const;
  /// Throws sk::Error if a kernel cannot run on the target that a call requests.
  void checkTarget(const program::Kernel& kernel, const CallOptions& options) const;
  void needExactSums(const program::Kernel& kernel);
  /// The cache with this key, which is made on first use.
  ProgramCache& cacheOf(const ProgramCacheKey& key);
  ProgramCache& selectedIf(bool mayStore, const program::Kernel& kernel);

  GlDevice& device_;
  const assemble::Profile profile_, computeProfile_;
  Barrier barrier_;
  std::optional<Arithmetic> arithmetic_;
  std::array<std::optional<assemble::Stage>, kernelClasses> faster_;
  const ProgramBinaries binaries_;
  AppendPrograms ofAppends_{*this};
  SortPrograms ofSorts_{*this};
  StagingPrograms ofStaging_{*this};
  MadeKernels scalarKernels_{*this};
  MadeKernels mergeKernels_{*this};
  std::array<bool, gl::formatCount> stored_{};  ///< mayStore(), by Format::index
  MadeKernels fusedKernels_{*this};
  TileTrials tileTrials_{device_};
  std::map<ProgramCacheKey, ProgramCache> caches_;
  ProgramCache* selected_ = nullptr;
  ProgramCacheKey selectedKey_;
  std::map<std::uint64_t, gl::Texture> tableTextures_;  ///< by FunctionTable::number
  UnloadWatch unloads_;
};

}  // namespace sk
