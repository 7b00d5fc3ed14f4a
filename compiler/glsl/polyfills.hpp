// SPDX-License-Identifier: MIT
//
// The functions that programs need because GLSL 3.30 lacks what they compute. legalize adds them to the module: each is a
// Function without a body, whose calls print like all others, and whose GLSL is here.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

struct Polyfill {
  std::string text;  ///< its definition; empty if the assembler defines it
  std::vector<ir::FunctionId> callees = {};  ///< the polyfills that the text calls
  std::optional<sk::program::Intrinsic> ofDouble = {};  ///< the assembler defines it only on request
};

class Polyfills {
 public:
  /// `module` gets the functions, and must outlive this.
  explicit Polyfills(ir::Module& module) : module_(&module) {}

  /// The function with this name and these parameters; adds it if it is new.
  ir::FunctionId add(std::string_view name, ir::Type result, const std::vector<ir::Type>& parameters,
                     Polyfill polyfill = {});
  /// The same for a function that works by component: `scalar` is its polyfill for components. Adds one for vectors,
  /// which calls that one, if a parameter is a vector.
  ir::FunctionId addByComponent(std::string_view name, ir::Type result,
                                const std::vector<ir::Type>& parameters, Polyfill scalar = {});
  ir::ExprPtr call(ir::FunctionId function, std::vector<ir::ExprPtr> args) const;

  const Polyfill& operator[](ir::FunctionId function) const { return polyfills_.at(function); }

  // The functions of the legalized operations, each for arguments of these types.

  /// && or || of bool vectors.
  ir::FunctionId logical(ir::BinaryOp op, ir::Type type);
  /// Componentwise select between vectors of int, uint, bool or double.
  ir::FunctionId select(ir::Type type);
  /// The component of a vector at a computed index, the nearest component to an index outside. Chromium 156 with SwiftShader takes
  /// another component for `c ? u : vec2(v[i], 0)`.
  ir::FunctionId component(ir::Type vector, ir::Type index);
  /// / or % of integers, defined for all operands. GLSL's are undefined if the divisor is 0, the quotient is out of range,
  /// or, for %, an operand is negative.
  ir::FunctionId quotient(ir::BinaryOp op, ir::Type lhs, ir::Type rhs);
  /// The magnitude of ints as in C++; the lowest int is its own. NVIDIA (580) takes `abs(x) < 0` for false.
  ir::FunctionId magnitude(ir::Type type);
  /// True if a float is neither 0 nor -0. NVIDIA (580) takes `bool(floor(x))` for false, and `floor(x) != 0.0`, too, if an
  /// `else` belongs to it; likewise with ceil.
  ir::FunctionId nonzero();
  /// Converts floats to int or uint: truncates, clamps, and makes NaN 0.
  ir::FunctionId truncated(ir::Type to);
  /// Rounds from the arithmetic type to a narrow type.
  ir::FunctionId quantize(ir::Type type);

 private:
  ir::Module* module_;
  std::map<ir::FunctionId, Polyfill> polyfills_;
  std::map<std::string, ir::FunctionId> ids_;  ///< by name and parameters
};

/// The functions that a kernel reaches and skc prints, callees before callers: without polyfills.
std::vector<ir::FunctionId> ownFunctionsOf(const ir::Module& module, const ir::Kernel& kernel);

/// "sk_double3 a, sk_double b", with names from `first` on.
std::string parameterList(const std::vector<ir::Type>& types, char first = 'a');

/// Replaces $T $I $U $F $B $s in a pattern of intrinsics.def by what that file says for this argument.
std::string withTypes(std::string_view pattern, ir::Type argument);

}  // namespace skc::emit
