// SPDX-License-Identifier: MIT
//
// Links functions that implement intrinsics. float_functions.sk and double_functions.sk define sin, exp and
// the like in the language itself, so that the back end computes several elements together, as in any kernel.
// For
//
//   kernel void wave(float x<>, out float r<>) { r = sin(x); }
//
// linkLibrary() compiles the library and appends its `float sin(float)` to the module, with all functions and
// constants that this needs. callLibrary() then replaces the kernel's IntrinsicCall by a call. Code that
// computes a kernel's floats in another precision must call the C library instead, because library functions
// are accurate only in their own types. exact_sums.sk does the same for the intrinsics of exact sums.
//
// Replaces intrinsics by calls of the library's functions:
//
//   before   kernel void wave(float2 x<>, out float2 r<>) { r = sin(x); }
//   after    float2 sin_2(float2 a) { return float2(sin(a.x), sin(a.y)); }
//            kernel void wave(float2 x<>, out float2 r<>) { r = sin_2(x); }
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "ir/ir.hpp"

namespace skc::native {

/// The functions of a module that implement intrinsics, by the scalar type of their first argument. Functions
/// of real numbers take scalars: they compute vectors component by component.
class LinkedFunctions {
 public:
  /// Returns nullopt if the module has none: the back end then has an instruction or calls the C library.
  std::optional<ir::FunctionId> find(ir::Intrinsic intrinsic, ir::Scalar scalar) const;
  void add(ir::Intrinsic intrinsic, ir::Scalar scalar, ir::FunctionId function);
  bool empty() const { return functions_.empty(); }

 private:
  std::map<std::pair<ir::Intrinsic, ir::Scalar>, ir::FunctionId> functions_;
};

/// Runs the frontend on a source text, which must be correct.
using CompileLibrary = std::function<ir::Module(std::string_view file, std::string_view text)>;

/// Appends the library's functions for the intrinsics that the module's kernels call. Must follow
/// runTransforms, where remove-unused would remove the functions. All kernels share the functions, which
/// therefore must not be changed for one of them. Calls `compile` only if there is such an intrinsic.
LinkedFunctions linkLibrary(ir::Module& module, const CompileLibrary& compile);

/// Copies functions from one module to another, with the functions, constants and types that they name. The copies have no
/// source locations, because these would index the other module's files.
class FunctionImporter {
 public:
  FunctionImporter(ir::Module& to, const ir::Module& from) : to_(to), from_(from) {}

  /// Returns the copy of a function, which must not take streams; makes it at the first call.
  ir::FunctionId import(ir::FunctionId id);

 private:
  ir::ConstantId importConstant(ir::ConstantId id);
  ir::Type importType(ir::Type type);
  std::uint32_t importStruct(std::uint32_t index);
  void adapt(ir::Expr& expr);
  void adapt(ir::Block& block);

  ir::Module& to_;
  const ir::Module& from_;
  std::map<ir::FunctionId, ir::FunctionId> functions_;
  std::map<ir::ConstantId, ir::ConstantId> constants_;
  std::map<std::uint32_t, std::uint32_t> structs_;
};

/// Each kernel gets its own copies of the functions, as after specialize-gathers.
void callLibrary(ir::Module& module, const LinkedFunctions& linked);

}  // namespace skc::native
