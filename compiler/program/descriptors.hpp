// SPDX-License-Identifier: MIT
//
// A compiled module: the descriptors of sk/program.hpp, and the strings and arrays that they refer to. The
// stub prints this object, and --emit=glsl passes it to the assembler.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

/// One kernel or reduce of the module. The whole kernel's Kernel::plans holds the kernels of passes.
struct Unit {
  ir::KernelId id;               ///< index into Module::kernels
  sk::program::Kernel kernel;    ///< the fold of a reduce
  const sk::program::Reduction* reduction =
      nullptr;   ///< set for a reduce and a scan; its `fold` equals `kernel`
  bool isScan = false;
};

/// True if C++ can call the kernel, so that a unit describes it.
inline bool isUnit(const ir::Kernel& kernel) {
  return !kernel.pass && !kernel.isSynthesized && !kernel.isPart;
}

/// What will run the kernels: GLSL programs of both kinds, and native code.
struct Targets {
  bool fragment = true;
  bool compute = true;
  bool native = true;
};

/// The native code of a kernel, or null. Only those who run a Program have it: the stub prints symbols instead.
using CodeOf = std::function<const sk::native::Code*(ir::KernelId)>;

/// Built from a module that has passed runTransforms. Move-only; views into it stay valid.
class Program {
 public:
  explicit Program(const ir::Module& module, Targets targets = {}, const CodeOf& codeOf = {});
  Program(Program&&) noexcept;
  Program& operator=(Program&&) noexcept;
  ~Program();

  /// The units, in the order of the module's kernels.
  std::span<const Unit> units() const;
  /// The tables, in the order of the module's; null for those that no kernel uses.
  std::span<const sk::program::Table* const> tables() const;
  /// The type that an element of this program describes.
  ir::Type typeOf(const sk::program::Element& element) const;
  /// The kernel that a descriptor of this program describes.
  ir::KernelId idOf(const sk::program::Kernel& kernel) const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace skc::emit
