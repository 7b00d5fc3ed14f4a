// SPDX-License-Identifier: MIT
#include "native/lanes.hpp"

#include <algorithm>

#include <llvm/ADT/APFloat.h>
#include <llvm/IR/Constants.h>
#include <llvm/IR/Module.h>

namespace skc::native {

using ir::Scalar;
using sk::native::Real;

// ---- types ----------------------------------------------------------------------------------------

llvm::Type* Lanes::type(Scalar scalar) const {
  if (scalar == Scalar::Float && options_.real == Real::Float) return b.getFloatTy();
  if (!isReal(scalar)) return b.getIntNTy(row(scalar).bits);
  return options_.real == Real::Quad ? llvm::Type::getFP128Ty(b.getContext()) : b.getDoubleTy();
}

llvm::Type* Lanes::stored(Scalar scalar) const {
  if (options_.holdsFloats && scalar == Scalar::Float) return b.getFloatTy();
  return scalar == Scalar::Bool ? b.getInt8Ty() : type(scalar);
}

std::uint32_t Lanes::storedBytes(Scalar scalar) const { return stored(scalar)->getPrimitiveSizeInBits() / 8; }

llvm::Type* Lanes::vector(llvm::Type* scalar) const {
  return count() == 1 ? scalar : llvm::FixedVectorType::get(scalar, count());
}

llvm::Type* Lanes::sameShape(const llvm::Value* like, llvm::Type* scalar) const {
  return isVector(like) ? vector(scalar) : scalar;
}

// ---- constants and shapes -------------------------------------------------------------------------

llvm::Value* Lanes::constant(Scalar scalar, std::int64_t value) const {
  llvm::Type* const t = type(scalar);
  return t->isFloatingPointTy() ? number(t, static_cast<double>(value)) : integer(t, value);
}

llvm::Value* Lanes::number(llvm::Type* type, double value) const {
  llvm::APFloat exact(value);
  bool isInexact = false;
  exact.convert(type->getScalarType()->getFltSemantics(), llvm::APFloat::rmNearestTiesToEven, &isInexact);
  return llvm::ConstantFP::get(type, exact);
}

llvm::Value* Lanes::integer(llvm::Type* type, std::int64_t value) const {
  return llvm::ConstantInt::getSigned(type, value);
}

llvm::Value* Lanes::laneNumbers(llvm::Type* integer) const {
  if (count() == 1) return llvm::ConstantInt::get(integer, 0);
  std::vector<llvm::Constant*> numbers;
  for (std::uint32_t i = 0; i < count(); ++i) numbers.push_back(llvm::ConstantInt::get(integer, i));
  return llvm::ConstantVector::get(numbers);
}

llvm::Value* Lanes::broadcast(llvm::Value* scalar) const {
  return count() == 1 || isVector(scalar) ? scalar : b.CreateVectorSplat(count(), scalar);
}

llvm::Value* Lanes::broadcast(const Part& part) const {
  llvm::Value* const all = broadcast(part.value);
  return part.isConsecutive ? b.CreateAdd(all, laneNumbers(part.value->getType())) : all;
}

void Lanes::unify(std::vector<Part*> parts) const {
  const bool areUniform = std::ranges::all_of(parts, [&](const Part* part) { return isUniform(*part); });
  if (areUniform) return;
  for (Part* part : parts) *part = {broadcast(*part)};
}

void Lanes::unify(Part& a, Part& c) const { unify({&a, &c}); }

Part Lanes::select(const Part& cond, const Part& yes, const Part& no) const {
  Part c = cond, y = yes, n = no;
  if (isUniform(c) && y.isConsecutive == n.isConsecutive && isVector(y.value) == isVector(n.value)) {
    return {b.CreateSelect(c.value, y.value, n.value), y.isConsecutive};
  }
  if (isUniform(c)) {
    unify(y, n);
    return {b.CreateSelect(c.value, y.value, n.value)};
  }
  return {b.CreateSelect(broadcast(c), broadcast(y), broadcast(n))};
}

llvm::Value* Lanes::any(const Part& mask) const {
  return isVector(mask.value) ? b.CreateOrReduce(mask.value) : mask.value;
}

Part Lanes::perLane(const std::vector<Part>& parts, llvm::Type* result,
                    llvm::function_ref<llvm::Value*(llvm::ArrayRef<llvm::Value*>)> function) const {
  std::vector<llvm::Value*> arguments;
  if (std::ranges::all_of(parts, [&](const Part& part) { return isUniform(part); })) {
    for (const Part& part : parts) arguments.push_back(part.value);
    return {function(arguments)};
  }
  std::vector<llvm::Value*> vectors;
  for (const Part& part : parts) vectors.push_back(broadcast(part));
  if (count() == 1) return {function(vectors)};
  llvm::Value* all = llvm::PoisonValue::get(vector(result));
  for (std::uint32_t i = 0; i < count(); ++i) {
    arguments.clear();
    for (llvm::Value* vector : vectors) arguments.push_back(lane(vector, i));
    all = b.CreateInsertElement(all, function(arguments), i);
  }
  return {all};
}

Part Lanes::callPerLane(std::string_view name, llvm::Type* result, const std::vector<Part>& parts) const {
  std::vector<llvm::Type*> types;
  for (const Part& part : parts) types.push_back(part.value->getType()->getScalarType());
  llvm::Module& module = *b.GetInsertBlock()->getModule();
  llvm::FunctionCallee callee =
      module.getOrInsertFunction(llvm::StringRef(name), llvm::FunctionType::get(result, types, false));
  auto* const function = llvm::cast<llvm::Function>(callee.getCallee());
  function->setDoesNotThrow();
  function->setDoesNotAccessMemory();  // nobody reads errno
  function->setWillReturn();
  return perLane(parts, result,
                 [&](llvm::ArrayRef<llvm::Value*> arguments) { return b.CreateCall(callee, arguments); });
}

// ---- memory ---------------------------------------------------------------------------------------

llvm::Value* Lanes::at(llvm::Type* element, llvm::Value* base, llvm::Value* index) const {
  return b.CreateGEP(element, base, index);
}

llvm::Value* Lanes::toStored(Scalar scalar, llvm::Value* value) const {
  if (options_.holdsFloats && scalar == Scalar::Float)
    return b.CreateFPTrunc(value, sameShape(value, b.getFloatTy()));
  return scalar == Scalar::Bool ? b.CreateZExt(value, sameShape(value, b.getInt8Ty())) : value;
}

llvm::Value* Lanes::fromStored(Scalar scalar, llvm::Value* value) const {
  if (options_.holdsFloats && scalar == Scalar::Float)
    return b.CreateFPExt(value, sameShape(value, type(scalar)));
  return scalar == Scalar::Bool ? b.CreateICmpNE(value, llvm::Constant::getNullValue(value->getType()))
                                : value;
}

Part Lanes::loadOne(Scalar scalar, llvm::Value* address) const {
  const llvm::Align align(storedBytes(scalar));
  return {fromStored(scalar, b.CreateAlignedLoad(stored(scalar), address, align))};
}

void Lanes::storeOne(Scalar scalar, llvm::Value* value, llvm::Value* address) const {
  b.CreateAlignedStore(toStored(scalar, value), address, llvm::Align(storedBytes(scalar)));
}

Part Lanes::loadNeighbors(Scalar scalar, llvm::Value* address) const {
  const llvm::Align align(storedBytes(scalar));
  return {fromStored(scalar, b.CreateAlignedLoad(vector(stored(scalar)), address, align))};
}

void Lanes::storeNeighbors(Scalar scalar, const Part& part, llvm::Value* address) const {
  b.CreateAlignedStore(toStored(scalar, broadcast(part)), address, llvm::Align(storedBytes(scalar)));
}

Part Lanes::gather(Scalar scalar, llvm::Value* base, llvm::Value* index) const {
  llvm::Type* const element = stored(scalar);
  llvm::Value* const addresses = at(element, base, index);
  if (count() == 1) return loadOne(scalar, addresses);
  return {
      fromStored(scalar, b.CreateMaskedGather(vector(element), addresses, llvm::Align(storedBytes(scalar))))};
}

void Lanes::scatter(Scalar scalar, const Part& part, llvm::Value* base, llvm::Value* index) const {
  llvm::Value* const addresses = at(stored(scalar), base, index);
  if (count() == 1) return storeOne(scalar, part.value, addresses);
  b.CreateMaskedScatter(toStored(scalar, broadcast(part)), addresses, llvm::Align(storedBytes(scalar)));
}

}  // namespace skc::native
