// SPDX-License-Identifier: MIT
//
// A compiled module: the descriptors of sk/program.hpp with the strings and arrays behind them.
// What the stub writes as text and what --emit=glsl hands to the assembler is this one object.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

/// One kernel or reduce of the module. The kernels of passes are in Kernel::plans of the whole one.
struct Unit {
  ir::KernelId id;               ///< index into Module::kernels
  sk::program::Kernel kernel;    ///< of a reduce: its fold
  const sk::program::Reduction* reduction = nullptr;   ///< set for a reduce; its `fold` equals `kernel`
};

/// What GLSL programs may be assembled as.
struct GlslTargets {
  bool fragment = true;
  bool compute = true;
};

/// Made from a module that has been through runTransforms. Move-only; views into it stay valid.
class Program {
 public:
  explicit Program(const ir::Module& module, GlslTargets targets = {});
  Program(Program&&) noexcept;
  Program& operator=(Program&&) noexcept;
  ~Program();

  /// In the order of the module's kernels.
  std::span<const Unit> units() const;
  /// In the order of the module's tables; null for those that no kernel uses.
  std::span<const sk::program::Table* const> tables() const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace skc::emit
