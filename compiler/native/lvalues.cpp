// SPDX-License-Identifier: MIT
//
// Variables of functions in memory, which LLVM promotes to registers, and the lvalues in them.
#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>

#include "analysis/shapes.hpp"
#include "native/arithmetic.hpp"
#include "native/debug_info.hpp"
#include "native/function_code.hpp"

namespace skc::native {

using namespace ir;
using analysis::Shape;

/// Outside arrays, a varying bool is a word unless the CPU has mask registers, so that LLVM keeps it in the
/// form in which comparisons give it.
LeafMemory FunctionCode::memoryOf(const std::string& name, const Leaf& leaf, Shape shape) const {
  llvm::Type* element = leaf.dimensions.empty() ? l.type(leaf.scalar) : l.stored(leaf.scalar);
  const bool isMask = leaf.scalar == Scalar::Bool && leaf.dimensions.empty() && shape == Shape::Varying;
  if (isMask && l.count() > 1 && !l.options().hasMaskRegisters) element = l.int32();
  if (shape == Shape::Varying) element = l.vector(element);
  llvm::Type* type = element;
  if (!leaf.dimensions.empty()) type = llvm::ArrayType::get(element, leaf.count());
  llvm::BasicBlock& entry = b.GetInsertBlock()->getParent()->getEntryBlock();
  llvm::IRBuilder<> allocas(&entry, entry.begin());
  return {allocas.CreateAlloca(type, nullptr, name), element, leaf.scalar, leaf.dimensions, shape};
}

void FunctionCode::declareAll(std::size_t rows) {
  variables_.resize(rows);
  for (VarId var = 0; var < function_.variables.size(); ++var) {
    const Variable& variable = function_.variables[var];
    for (std::size_t row = 0; row < rows; ++row) {
      std::vector<LeafMemory>& memory = variables_[row].emplace_back();
      const bool isStream = variable.role == VarRole::Gather || variable.role == VarRole::AppendOutput;
      if (isStream || (row > 0 && !plan_->isPerRow(var))) continue;
      const std::vector<Leaf> leaves = leavesOf(k.module, variable.type);
      for (std::size_t i = 0; i < leaves.size(); ++i) {
        const Shape shape = k.uniformity == nullptr ? Shape::Uniform : k.uniformity->of(id_, var)[i];
        memory.push_back(memoryOf(variable.name, leaves[i], shape));
      }
    }
    const bool isParameter = var < function_.parameterCount;
    if (k.debug != nullptr) k.debug->declare(b, variable, isParameter ? var + 1 : 0, variables_[0][var]);
  }
  const std::vector<Leaf> leaves = leavesOf(k.module, function_.result);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Shape shape = k.uniformity == nullptr ? Shape::Uniform : k.uniformity->resultOf(id_)[i];
    result_.push_back(memoryOf("result", leaves[i], shape));
  }
}

const std::vector<LeafMemory>& FunctionCode::memoryOf(VarId var) const {
  const bool isPerRow = plan_ != nullptr && plan_->isPerRow(var);
  return variables_[isPerRow ? row_ : 0][var];
}

LValue FunctionCode::variable(VarId var) const {
  LValue lvalue{function_.variables[var].type, {}};
  for (const LeafMemory& memory : memoryOf(var))
    lvalue.leaves.push_back({&memory, {l.integer(l.int32(), 0)}, 0});
  return lvalue;
}

/// The index, clamped to 0 ... length - 1.
Part FunctionCode::indexInside(const Expr& index, std::uint32_t length) {
  Part i = expression(index)[0];
  if (i.isConsecutive) i = {l.broadcast(i)};
  llvm::Type* const type = i.value->getType();
  llvm::Value* const last = l.integer(type, length - 1);
  if (index.type.scalar == Scalar::Uint)
    return {b.CreateBinaryIntrinsic(llvm::Intrinsic::umin, i.value, last)};
  llvm::Value* const low = b.CreateBinaryIntrinsic(llvm::Intrinsic::smax, i.value, l.integer(type, 0));
  return {b.CreateBinaryIntrinsic(llvm::Intrinsic::smin, low, last)};
}

namespace {

/// The value of a Literal index, clamped; nullopt for other indices.
std::optional<std::uint32_t> literalIndex(const Expr& index, std::uint32_t length) {
  const auto* literal = std::get_if<Literal>(&index.node);
  if (literal == nullptr) return std::nullopt;
  const bool isNegative = index.type.scalar == Scalar::Int && static_cast<std::int32_t>(literal->bits) < 0;
  return isNegative ? 0 : std::min(literal->bits, length - 1);
}

}  // namespace

/// Returns nullopt if the expression is not an lvalue, or is a component of a vector or a row of a matrix at
/// a dynamic index.
std::optional<LValue> FunctionCode::lvalueOf(const Expr& expr) {
  if (const auto* n = std::get_if<VarRef>(&expr.node)) return variable(n->var);
  if (const auto* n = std::get_if<Member>(&expr.node)) {
    std::optional<LValue> base = lvalueOf(*n->base);
    if (!base) return std::nullopt;
    const std::uint32_t first = leavesBefore(k.module, n->base->type, n->field);
    const auto begin = base->leaves.begin() + first;
    const auto count = static_cast<std::ptrdiff_t>(analysis::leafCount(k.module, expr.type));
    return LValue{expr.type, {begin, begin + count}};
  }
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    std::optional<LValue> base = lvalueOf(*n->base);
    if (!base) return std::nullopt;
    LValue lvalue{expr.type, {}};
    for (const std::uint8_t component : n->components) lvalue.leaves.push_back(base->leaves[component]);
    return lvalue;
  }
  const auto* n = std::get_if<Index>(&expr.node);
  if (n == nullptr) return std::nullopt;
  std::optional<LValue> lvalue = lvalueOf(*n->base);
  if (!lvalue) return std::nullopt;
  const Type type = n->base->type;
  if (type.kind != Type::Kind::Array) {
    const std::optional<std::uint32_t> row = literalIndex(*n->index, type.width);
    if (!row) return std::nullopt;
    const std::uint32_t width = type.isMatrix() ? type.width : 1;
    const auto begin = lvalue->leaves.begin() + *row * width;
    return LValue{expr.type, {begin, begin + width}};
  }
  const Part index = indexInside(*n->index, k.module.arrays[type.index].length);
  for (LValue::Leaf& leaf : lvalue->leaves) {
    std::uint32_t inner = 1;
    ++leaf.dimensions;
    for (std::size_t d = leaf.dimensions; d < leaf.memory->dimensions.size(); ++d)
      inner *= leaf.memory->dimensions[d];
    const Part scaled = binary(l, BinaryOp::Mul, Scalar::Int, index, {l.integer(l.int32(), inner)});
    leaf.offset = binary(l, BinaryOp::Add, Scalar::Int, leaf.offset, scaled);
  }
  lvalue->type = expr.type;
  return lvalue;
}

/// The address of a component. If lanes have different offsets, a vector of addresses of scalars; isScattered
/// is then set.
llvm::Value* FunctionCode::addressOf(const LValue::Leaf& leaf, std::uint32_t offset, bool* isScattered) {
  const LeafMemory& memory = *leaf.memory;
  *isScattered = false;
  if (memory.dimensions.empty()) return memory.memory;
  llvm::Type* const type = leaf.offset.value->getType();
  llvm::Value* const element = b.CreateAdd(leaf.offset.value, l.integer(type, offset));
  if (!l.isVector(element)) return l.at(memory.element, memory.memory, element);
  *isScattered = true;
  if (memory.shape != Shape::Varying) return l.at(memory.element, memory.memory, element);
  llvm::Value* const scalars = b.CreateMul(element, l.integer(type, l.count()));
  return l.at(l.stored(memory.scalar), memory.memory, b.CreateAdd(scalars, l.laneNumbers(l.int32())));
}

Part FunctionCode::loadComponent(const LValue::Leaf& leaf, std::uint32_t offset) {
  const LeafMemory& memory = *leaf.memory;
  bool isScattered = false;
  llvm::Value* const address = addressOf(leaf, offset, &isScattered);
  const bool isArray = !memory.dimensions.empty();
  if (isScattered) {
    llvm::Value* const value = b.CreateMaskedGather(l.vector(l.stored(memory.scalar)), address,
                                                    llvm::Align(l.storedBytes(memory.scalar)));
    return {l.fromStored(memory.scalar, value)};
  }
  llvm::Value* const value = b.CreateLoad(memory.element, address);
  if (isArray) return {l.fromStored(memory.scalar, value), memory.shape == Shape::Consecutive};
  const bool isWord = memory.scalar == Scalar::Bool && !memory.element->getScalarType()->isIntegerTy(1);
  if (isWord) return {b.CreateICmpSLT(value, llvm::Constant::getNullValue(value->getType()))};
  return {value, memory.shape == Shape::Consecutive};
}

void FunctionCode::storeComponent(const LValue::Leaf& leaf, std::uint32_t offset, const Part& part) {
  const LeafMemory& memory = *leaf.memory;
  bool isScattered = false;
  llvm::Value* const address = addressOf(leaf, offset, &isScattered);
  llvm::Value* value = memory.shape == Shape::Varying ? l.broadcast(part) : part.value;
  if (isScattered) {
    b.CreateMaskedScatter(l.toStored(memory.scalar, value), address,
                          llvm::Align(l.storedBytes(memory.scalar)));
    return;
  }
  if (!memory.dimensions.empty()) {
    value = l.toStored(memory.scalar, value);
  } else if (value->getType() != memory.element) {
    value = b.CreateSExt(value, memory.element);  // a mask of words
  }
  b.CreateStore(value, address);
}

Parts FunctionCode::load(const LValue& lvalue) {
  Parts parts;
  for (const Component& component : componentsOf(k.module, lvalue.type)) {
    parts.push_back(loadComponent(lvalue.leaves[component.leaf], component.offset));
  }
  return parts;
}

void FunctionCode::store(const LValue& lvalue, const Parts& value) {
  const std::vector<Component> components = componentsOf(k.module, lvalue.type);
  for (std::size_t i = 0; i < components.size(); ++i) {
    storeComponent(lvalue.leaves[components[i].leaf], components[i].offset, value[i]);
  }
}

void FunctionCode::assign(const Expr& lvalue, const Parts& value) {
  if (const std::optional<LValue> found = lvalueOf(lvalue)) return store(*found, value);
  if (const auto* n = std::get_if<Swizzle>(&lvalue.node)) {
    Parts whole = expression(*n->base);
    for (std::size_t i = 0; i < n->components.size(); ++i) whole[n->components[i]] = value[i];
    return assign(*n->base, whole);
  }
  assignComponent(std::get<Index>(lvalue.node), value);
}

/// Assigns a component of a vector, or a row of a matrix, at a dynamic index.
void FunctionCode::assignComponent(const Index& lvalue, const Parts& value) {
  Parts whole = expression(*lvalue.base);
  const std::uint32_t length = lvalue.base->type.width;
  const Part index = indexInside(*lvalue.index, length);
  for (std::uint32_t i = 0; i < length; ++i) {
    const Part isHere = binary(l, BinaryOp::Equal, Scalar::Int, index, {l.integer(l.int32(), i)});
    for (std::size_t c = 0; c < value.size(); ++c) {
      Part& part = whole[i * value.size() + c];
      part = l.select(isHere, value[c], part);
    }
  }
  assign(*lvalue.base, whole);
}

}  // namespace skc::native
