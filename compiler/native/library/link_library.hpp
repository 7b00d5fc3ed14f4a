// SPDX-License-Identifier: MIT
//
// Functions in place of intrinsics. What float_functions.sk says of sin, exp and their like is an ordinary program of the
// language, so that the back end computes several elements together as it does in any kernel:
//
//   kernel void wave(float x<>, out float r<>) { r = sin(x); }
//
// makes linkLibrary() compile the library and append to the module its `float sin(float)`, all that this calls, and their
// constants. The kernel keeps its IntrinsicCall; the back end calls the function that LinkedFunctions names for it.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "ir/ir.hpp"

namespace skc::native {

/// Functions of the module that compute an intrinsic of scalar arguments of one type. Components of vectors are computed
/// one by one.
class LinkedFunctions {
 public:
  /// Empty where the module has none: the back end has an instruction or calls the C library.
  std::optional<ir::FunctionId> find(ir::Intrinsic intrinsic, ir::Scalar scalar) const;
  void add(ir::Intrinsic intrinsic, ir::Scalar scalar, ir::FunctionId function);
  bool empty() const { return functions_.empty(); }

 private:
  std::map<std::pair<ir::Intrinsic, ir::Scalar>, ir::FunctionId> functions_;
};

/// Compiles a text of the language, which must be right, to what the frontend gives.
using CompileLibrary = std::function<ir::Module(std::string_view file, std::string_view text)>;

/// Appends to the module the library's functions for the intrinsics that its kernels call. It is for the module as
/// runTransforms leaves it: earlier, remove-unused would take the functions out. They are shared by all kernels, so that nobody
/// may change them for one of these. `compile` is called only if there is such an intrinsic.
LinkedFunctions linkLibrary(ir::Module& module, const CompileLibrary& compile);

}  // namespace skc::native
