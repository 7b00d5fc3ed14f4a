// SPDX-License-Identifier: MIT
//
// Copies functions from one module to another, with the functions, constants and types that they name. The copies have no
// source locations, because these would index the other module's files.
#pragma once

#include <map>

#include "ir/ir.hpp"

namespace skc::native {

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

}  // namespace skc::native
