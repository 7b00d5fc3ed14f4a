// SPDX-License-Identifier: MIT
//
// The programs of a device: assembled and compiled when a variant is first used, and kept as long as the
// device, unless a kernel has too many variants, or its library is unloaded. Descriptors are identified by their addresses:
// those in other memory must outlive the device, or be forgotten before they end. Also the uniforms of these programs.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "assemble/append/histo_pyramid.hpp"
#include "assemble/program/tile_program.hpp"
#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/region_layout.hpp"
#include "device/unload_watch.hpp"
#include "gl/program.hpp"
#include "gl_device/program/program_binaries.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/program.hpp"

namespace sk {

/// The uniforms that hold the region layout of a parameter or of the domain.
class LayoutUniforms {
 public:
  LayoutUniforms() = default;
  /// `names` is the pattern of the uniforms' names, in which `*` stands for origin, shape, stride, shift, low,
  /// high and whole.
  LayoutUniforms(const gl::Program& program, std::string_view names) {
    const std::size_t star = names.find('*');
    const auto location = [&](std::string_view part) {
      std::string name(names);
      name.replace(star, 1, part);
      return program.location(name);
    };
    origin_ = {location("origin"), true};
    shape_ = {location("shape"), true};
    stride_ = {location("stride"), true};
    shift_ = {location("shift"), false};
    low_ = {location("low"), true};
    high_ = {location("high"), true};
    whole_ = {location("whole"), true};
  }

  /// The program must be bound.
  void set(gl::BoundState& bound, const assemble::RegionLayout& regionLayout) {
    origin_.set(bound, regionLayout.origin);
    shape_.set(bound, regionLayout.extent);
    stride_.set(bound, regionLayout.stride);
    shift_.set(bound, regionLayout.shift);
    if (!regionLayout.placed) return;
    low_.set(bound, regionLayout.place.low);
    high_.set(bound, regionLayout.place.high);
    whole_.set(bound, regionLayout.place.whole);
  }

 private:
  gl::IntUniform origin_, shape_, stride_, shift_, low_, high_, whole_;
};

class GlDevice;

/// The program of one variant of a kernel. Parameters are identified by their indices.
struct KernelProgram {
  struct Value {
    std::size_t parameter;
    gl::FieldUniform uniform;
  };
  struct Wide {
    std::size_t parameter;
    gl::WideUniform uniform;
  };
  struct Read {
    std::size_t parameter;
    LayoutUniforms uniforms;
    gl::IntUniform ratio;
    GLuint sampler = 0;  ///< a linear sampler for its only plane; 0: the nearest one
  };

  /// A scatter output: its shape is what extentof() says, and the list's program needs its layout.
  struct Target {
    std::size_t parameter;
    LayoutUniforms uniforms;
  };

  struct Table {
    GLuint texture;
    gl::FieldUniform range;
    std::array<float, 3> values;  ///< the value of `range`
  };

  /// The uniforms of a list's program for the pyramid (assemble/append/histo_pyramid.hpp).
  struct Pyramid {
    gl::IntUniform shift, levels;
    std::array<gl::IntUniform, assemble::mostPyramidLevels + 1> rows;

    void set(gl::BoundState& bound, const assemble::PyramidPlan& plan);
  };

  /// The uniforms of an append output in a compute program (assemble/append/append_groups.hpp).
  struct Append {
    std::size_t parameter;
    LayoutUniforms layout;  ///< of the list, or of the scatter output
    gl::IntUniform room;  ///< the entries that the list has room for
    gl::IntUniform listShift;  ///< log2 of the width of a list of records
    gl::IntUniform owners;  ///< the first owner in the buffer of states, and the texels in a row
  };

  gl::Program program;
  assemble::Stage stage = assemble::Stage::Fragment;
  gl::IntUniform rect;  ///< compute programs: the texels that a dispatch writes
  std::array<GLint, 3> workGroup{1, 1, 1};  ///< the texels of a work group
  gl::IntUniform foldGroups, foldResult;  ///< of programs that fold (assemble/reduce/group_fold.hpp)
  bool isGrouped = false;  ///< each work group computes one texel
  std::int32_t loopNumber =
      0;  ///< by which it reports loops that were ended early (LoopReports); 0: it does not
  gl::IntUniform loopNumberUniform;  ///< likewise
  bool isPacked = false;  ///< a texel of the domain holds assemble::lanes elements
  LayoutUniforms domain;
  gl::IntUniform domainRow;  ///< layered domains: the first row of the drawn layer
  std::vector<Target> targets;  ///< of fragment programs that count or list what a kernel scatters
  std::vector<Append> appends;
  Pyramid pyramid;  ///< its textures are on the units from `units` on
  int units = 0;  ///< the number of units of reads, stacks and tables
  std::vector<Value> values;
  std::vector<Wide> wide;
  std::vector<Value> steps;  ///< steps of iterators
  std::vector<Read> reads;  ///< their planes are on consecutive texture units from 0, in this order
  std::vector<std::size_t> stacks;  ///< of the plan, on the next units
  std::vector<Table> tables;  ///< of functions, on the next units
};

/// The program of one variant of a reduction's passes.
struct ReduceProgram {
  KernelProgram kernel;  ///< its parameters are those of the fold or of the combining kernel
  std::deque<std::pair<std::string, gl::IntUniform>> uniforms;  ///< a loop's commands refer to them

  gl::IntUniform& uniform(const assemble::UniformValue& value);
};

class ProgramCache {
 public:
  /// Creates programs for this profile.
  ProgramCache(GlDevice& device, const assemble::Profile& profile);
  ProgramCache(const ProgramCache&) = delete;
  ProgramCache& operator=(const ProgramCache&) = delete;

  /// Return the program, which is compiled on first use. The reference is valid until mostVariants other
  /// programs of the kernel have been used. Throw sk::Error, with the driver's messages, if the driver
  /// rejects the program.
  KernelProgram& kernelProgram(const program::Kernel& kernel, std::span<const Operand> operands,
                               const assemble::RegionLayout& domain, const assemble::Task& task = {}) {
    return kernelProgram(kernel, {}, operands, domain, task);
  }
  /// The program that computes a domain by tiles (assemble::Work::Tiles); `kernel` belongs to this plan alone.
  KernelProgram& tileProgram(const program::Kernel& kernel, const assemble::TilePlan& plan,
                             std::span<const Operand> operands, const assemble::RegionLayout& domain) {
    return kernelProgram(kernel, {.tiles = &plan}, operands, domain, {.work = assemble::Work::Tiles});
  }
  /// The program that folds beside the outputs of a reduction's fold (assemble::Work::Folds).
  KernelProgram& foldProgram(const program::Reduction& reduction, std::span<const Operand> operands,
                             const assemble::RegionLayout& domain) {
    return kernelProgram(reduction.fold, {.reduction = &reduction}, operands, domain,
                         {.work = assemble::Work::Folds});
  }
  ReduceProgram& reduceProgram(const program::Reduction& reduction, const assemble::ReduceVariant& variant);

  /// Make the driver start compiling a program that will be needed, so that it can compile several at a time.
  /// False if the program exists already.
  bool startKernelProgram(const program::Kernel& kernel, std::span<const Operand> operands,
                          const assemble::RegionLayout& domain);
  bool startReduceProgram(const program::Reduction& reduction, const assemble::ReduceVariant& variant);

  /// Delete the programs of a kernel or reduction that is about to end.
  void forget(const program::Kernel& kernel) noexcept;
  void forget(const program::Reduction& reduction) noexcept;

  assemble::Stage stage() const { return profile_.stage; }

 private:
  /// What a program depends on besides its kernel and variant.
  struct Whole {
    const program::Reduction* reduction = nullptr;  ///< Work::Folds
    const assemble::TilePlan* tiles = nullptr;  ///< Work::Tiles
  };
  using ReduceKey = std::pair<const program::Reduction*, assemble::ReduceVariant>;

  /// The key of a kernel's program for these operands. It is good until the next look().
  const ProgramKey& look(const program::Kernel& kernel, std::span<const Operand> operands,
                         const assemble::RegionLayout& domain, const assemble::Task& task);
  KernelProgram& kernelProgram(const program::Kernel& kernel, const Whole& whole,
                               std::span<const Operand> operands, const assemble::RegionLayout& domain,
                               const assemble::Task& task);
  std::unique_ptr<KernelProgram> makeKernelProgram(const program::Kernel& kernel,
                                                   const assemble::Variant& variant, ProgramBuild&& begun);
  /// Throws sk::Error if a program of the kernel takes more texture units than the device has.
  void checkUnits(const program::Kernel& kernel, const assemble::SpecValues& specs,
                  std::span<const assemble::StreamAccess> access, const assemble::Task& task) const;
  void findParameters(KernelProgram& result, const program::Kernel& kernel, const assemble::SpecValues& specs,
                      std::span<const assemble::StreamAccess> access);
  void findTables(KernelProgram& result, const program::Kernel& kernel, int& unit);
  void findValue(KernelProgram& result, std::size_t number, const program::Parameter& parameter);
  void addWide(KernelProgram& result, std::size_t number, const std::string& name,
               std::span<const program::Field> parts) const;
  void findAppendUniforms(KernelProgram& result, const program::Kernel& kernel);
  void findTargetUniforms(KernelProgram& result, const program::Kernel& kernel);
  void findListUniforms(KernelProgram& result);
  bool isCompute() const { return profile_.stage == assemble::Stage::Compute; }
  ProgramBuild begin(const program::Kernel& kernel, const assemble::Variant& variant, const Whole& whole);
  ProgramBuild begin(const program::Reduction& reduction, const assemble::ReduceVariant& variant);
  /// Throws sk::Error, with the driver's messages, if the driver rejects the program.
  void finish(KernelProgram& result, const program::Kernel& kernel, ProgramBuild&& begun);
  void bindSamplers(const gl::Program& program, const program::Parameter& parameter, int& unit);

  /// A program, the time of its last use, and which loaded object has its descriptor (LinkedFile::objectOf()).
  template <class Program>
  struct Kept {
    std::unique_ptr<Program> program;
    std::int64_t used = 0;
    std::uint64_t object = 0;
  };
  /// Deletes the programs of libraries that have been unloaded since the last call.
  void forgetUnloaded() {
    if (unloads_.hasChanged()) forgetUnloadedNow();
  }
  void forgetUnloadedNow();
  /// Makes room for one more program of a kernel: if it has mostVariants, deletes the least recently used
  /// one.
  template <class Programs, class IsOfKernel>
  void makeRoom(Programs& programs, IsOfKernel&& isOfKernel);

  /// The most programs per kernel or reduction, which each value of a spec parameter multiplies. It is more
  /// than a single call uses.
  static constexpr std::ptrdiff_t mostVariants = 256;

  GlDevice& device_;
  const assemble::Profile profile_;
  std::unordered_map<ProgramKey, Kept<KernelProgram>, ProgramKeyHash> kernels_;
  std::map<ReduceKey, Kept<ReduceProgram>> reductions_;
  std::int64_t clock_ = 0;
  UnloadWatch unloads_;
  ProgramKey looked_;  ///< of look(), which so needs no memory
  std::unordered_map<ProgramKey, ProgramBuild, ProgramKeyHash> startedKernels_;
  std::map<ReduceKey, ProgramBuild> startedReductions_;
};

}  // namespace sk
