// SPDX-License-Identifier: MIT
//
// Prints IR expressions as GLSL that 3.30 and ESSL 3.00 accept, with as few brackets as a person would write.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "analysis/copied_values.hpp"
#include "glsl/kernel_names.hpp"
#include "glsl/polyfills.hpp"
#include "glsl/type_names.hpp"
#include "ir/ir.hpp"
#include "ir/operators.hpp"

namespace skc::emit {

/// The inputs for printing: a module after legalize.
struct GlslContext {
  const ir::Module& module;
  const TypeNames& types;
  const KernelNames& names;
  const ir::Kernel& kernel;
  const Polyfills& polyfills;
  /// Write the marks of sk/arithmetic_marks.hpp where floats are computed.
  bool marks = false;
  /// Expressions that need no marks of operations, because their values are only copied; null: none.
  const analysis::CopiedValues* copied = nullptr;
};

/// True if a variable of this type holds floats, which GLSL's `precise` is for.
bool holdsFloats(const ir::Module& module, ir::Type type);
/// True unless the variable is a parameter that is passed by value, for which GLSL has no `precise`.
bool isDeclaredPrecise(const ir::Function& function, ir::VarId var);
/// The mark in front of the declaration of a variable, or nothing.
std::string_view declarationMark(const GlslContext& context, ir::Type type);

/// `function` is the function that contains the expression; unset for a constant expression. `isStored`: its value goes to a
/// variable of the function that has a declarationMark().
std::string glslExpr(const GlslContext& context, std::optional<ir::FunctionId> function, const ir::Expr& expr,
                     ir::Precedence around = ir::Precedence::Lowest, bool isStored = false);

/// "place = value", "place += value".
std::string glslAssignment(const GlslContext& context, ir::FunctionId function, const ir::Expr& place,
                           std::optional<ir::BinaryOp> op, const ir::Expr& value);

}  // namespace skc::emit
