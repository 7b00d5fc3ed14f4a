// SPDX-License-Identifier: MIT
//
// Types, expressions and assignments of the IR as C++ on sk/native/native.hpp, inside a template over the real
// type `sk_real`.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "emit/divergence.hpp"
#include "emit/kernel_names.hpp"
#include "emit/type_names.hpp"
#include "ir/ir.hpp"
#include "ir/precedence.hpp"

namespace skc::emit {

/// What the text of an expression depends on.
struct NativeContext {
  const ir::Module& module;
  const TypeNames& types;
  const KernelNames& names;
  const ir::Kernel& kernel;
  const std::map<ir::FunctionId, std::string>&
      functions;  ///< their names, each used once: overloads for float
  ///< and double are alike in the reference
  const Divergence* divergence = nullptr;  ///< in code for lanes, what differs between them
};

/// Beside the variable that holds the values of all lanes: an index of the first of them, or a number that those in a loop have in
/// common (Divergence::isInStep).
inline std::string firstLane(const std::string& variable) { return "sk_first_" + variable; }

/// "sk_real", "native::Vec<native::Int, 2>", "Hit<sk_real>".
std::string nativeType(const ir::Module& module, const TypeNames& types, ir::Type type);

/// "sk_arg_u": the member that stands for a parameter of the kernel.
std::string nativeParameter(const NativeContext& context, std::uint32_t param);

/// The name of a constant's function.
std::string nativeConstant(const NativeContext& context, ir::ConstantId id);

/// `function` is the function that the expression stands in; unset for a constant expression.
std::string nativeExpr(const NativeContext& context, std::optional<ir::FunctionId> function,
                       const ir::Expr& expr, ir::Precedence around = ir::Precedence::Lowest);

/// "place = value", "place = place + value", "native::assign<0, 2>(place, value)".
std::string nativeAssignment(const NativeContext& context, ir::FunctionId function, const ir::Expr& place,
                             std::optional<ir::BinaryOp> op, const ir::Expr& value);
/// The same for a value that is text.
std::string nativeAssignment(const NativeContext& context, ir::FunctionId function, const ir::Expr& place,
                             const std::string& value);

/// "0, 1": the components of a swizzle of swizzles, and what they are of.
struct Components {
  const ir::Expr* base;
  std::vector<std::uint8_t> components;
};
Components flattened(const ir::Swizzle& swizzle);
std::string numbers(const std::vector<std::uint8_t>& components);

/// The name of an intrinsic in sk/native.
std::string nativeIntrinsic(ir::Intrinsic intrinsic);

/// Whether a place is several components of a vector, which no reference can name.
bool isSeveralComponents(const ir::Expr& place);

}  // namespace skc::emit
