// SPDX-License-Identifier: MIT
//
// The programs of a device, assembled and compiled when a variant is first needed and kept in memory
// until the device ends, or a kernel has had too many others since. Descriptors are known by their addresses: they must outlive the device.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "assemble/append/histo_pyramid.hpp"
#include "assemble/reduce/reduce_plan.hpp"
#include "gl/program.hpp"
#include "gl/uniform.hpp"
#include "gl_device/program/layout_uniforms.hpp"
#include "gl_device/program/program_binaries.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

/// One variant of a kernel. Parameters are named by their position.
struct KernelProgram {
  struct Value {
    std::size_t parameter;
    gl::FieldUniform uniform;
  };
  struct Double {
    std::size_t parameter;
    gl::DoubleUniform uniform;
  };
  struct Read {
    std::size_t parameter;
    LayoutUniforms uniforms;
    gl::IntUniform ratio;
    GLuint sampler = 0;  ///< for its only plane; 0: the texture's own settings
  };

  struct Table {
    GLuint texture;
    gl::FieldUniform range;
    std::array<float, 3> values;  ///< of the uniform
  };

  /// Where a list's program finds the tree over the counts (assemble/append/histo_pyramid.hpp).
  struct Tree {
    gl::IntUniform shift, levels;
    std::array<gl::IntUniform, assemble::mostPyramidLevels + 1> rows;

    void set(const assemble::PyramidPlan& plan);
  };

  gl::Program program;
  assemble::Stage stage = assemble::Stage::Fragment;
  gl::IntUniform rect;  ///< of a compute program: the texels that a dispatch writes
  std::array<GLint, 3> workGroup{1, 1, 1};
  bool isGrouped = false;  ///< a work group computes a texel
  bool isPacked = false;  ///< a texel holds as many elements as it has lanes
  LayoutUniforms domain;
  gl::IntUniform domainRow;  ///< of a layered domain: the first row of the layer that is drawn
  LayoutUniforms target;  ///< of the scatter output whose list it makes
  Tree tree;  ///< its textures lie on the units from `units` on
  int units = 0;  ///< what `reads` take
  std::vector<Value> values;
  std::vector<Double> doubles;
  std::vector<Value> steps;  ///< of iterators
  std::vector<Read> reads;  ///< their planes lie on consecutive texture units, from 0, in this order
  std::vector<std::size_t> bundles;  ///< of the plan, on the units after these
  std::vector<Table> tables;  ///< of functions, on the units after those
};

/// One variant of a reduction's passes.
struct ReduceProgram {
  KernelProgram kernel;  ///< with the parameters of the kernel that it calls
  std::vector<std::pair<std::string, gl::IntUniform>> uniforms;

  gl::IntUniform& uniform(const assemble::UniformValue& value);
};

class ProgramCache {
 public:
  /// Of programs for this profile.
  ProgramCache(GlDevice& device, const assemble::Profile& profile);
  ProgramCache(const ProgramCache&) = delete;
  ProgramCache& operator=(const ProgramCache&) = delete;

  /// Both throw sk::Error where the driver refuses the program, with its words. It lives until many others have been asked for.
  KernelProgram& kernelProgram(const program::Kernel& kernel, std::span<const Operand> operands,
                               const assemble::RegionLayout& domain, const assemble::Task& task = {});
  ReduceProgram& reduceProgram(const program::Reduction& reduction, const assemble::ReduceVariant& variant);

  /// Lets the driver begin with what the functions above will be asked for, so that it compiles several programs at once.
  /// False where it is there already.
  bool startKernelProgram(const program::Kernel& kernel, std::span<const Operand> operands,
                          const assemble::RegionLayout& domain);
  bool startReduceProgram(const program::Reduction& reduction, const assemble::ReduceVariant& variant);

  assemble::Stage stage() const { return profile_.stage; }

 private:
  using ReduceKey = std::pair<const program::Reduction*, assemble::ReduceVariant>;

  std::unique_ptr<KernelProgram> makeKernelProgram(const program::Kernel& kernel,
                                                   const assemble::Variant& variant, ProgramBuild&& begun);
  void findParameters(KernelProgram& made, const program::Kernel& kernel, const assemble::SpecValues& specs);
  void findTables(KernelProgram& made, const program::Kernel& kernel, int& unit);
  void findValue(KernelProgram& made, std::size_t number, const program::Parameter& parameter);
  void addDoubles(KernelProgram& made, std::size_t number, const std::string& name,
                  std::span<const program::Field> parts) const;
  void findListUniforms(KernelProgram& made, const program::Parameter& appendOutput);
  bool isCompute() const { return profile_.stage == assemble::Stage::Compute; }
  ProgramBuild begin(const program::Kernel& kernel, const assemble::Variant& variant);
  ProgramBuild begin(const program::Reduction& reduction, const assemble::ReduceVariant& variant);
  /// Throws sk::Error where the driver refuses the program, with its words.
  void finish(KernelProgram& made, const program::Kernel& kernel, ProgramBuild&& begun);
  void bindSamplers(const gl::Program& program, const program::Parameter& parameter, int& unit);

  /// A program, and when it was last asked for.
  template <class Program>
  struct Kept {
    std::unique_ptr<Program> program;
    std::int64_t used = 0;
  };
  /// Makes room for one more of a kernel's programs, of which the one that was not used for longest is deleted.
  template <class Programs, class IsOfKernel>
  void makeRoom(Programs& programs, IsOfKernel&& isOfKernel);

  /// Variants of one kernel or reduction that stay. More than any one call asks for, since each value of a spec parameter makes one.
  static constexpr std::ptrdiff_t mostVariants = 256;

  GlDevice& device_;
  const assemble::Profile profile_;
  std::unordered_map<ProgramKey, Kept<KernelProgram>, ProgramKeyHash> kernels_;
  std::map<ReduceKey, Kept<ReduceProgram>> reductions_;
  std::int64_t clock_ = 0;
  std::unordered_map<ProgramKey, ProgramBuild, ProgramKeyHash> startedKernels_;
  std::map<ReduceKey, ProgramBuild> startedReductions_;
};

}  // namespace sk
