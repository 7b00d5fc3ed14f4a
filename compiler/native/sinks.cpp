// SPDX-License-Identifier: MIT
//
// Pushes to variable outputs and stores to scatter outputs, of one element at a time.
#include <cstddef>

#include <llvm/IR/Constants.h>

#include "native/streams.hpp"

namespace skc::native {

using namespace ir;
using sk::native::Argument;
using sk::native::Sink;

llvm::Value* Streams::isGiven(std::uint32_t param) {
  llvm::Value* const all = argumentField(param, offsetof(Argument, components), l.b.getPtrTy());
  return l.b.CreateIsNotNull(all);
}

void Streams::push(std::uint32_t param, const Parts& value) {
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  const auto block = [&](const char* name) {
    return llvm::BasicBlock::Create(l.b.getContext(), name, function);
  };
  llvm::BasicBlock* const given = block("push");
  llvm::BasicBlock* const grow = block("grow");
  llvm::BasicBlock* const store = block("append");
  llvm::BasicBlock* const end = block("pushed");
  llvm::Value* const sink = argumentField(param, offsetof(Argument, sink), l.b.getPtrTy());
  const auto field = [&](std::size_t offset) {
    return l.b.CreateConstGEP1_64(l.b.getInt8Ty(), sink, offset);
  };
  l.b.CreateCondBr(l.b.CreateIsNotNull(sink), given, end);
  l.b.SetInsertPoint(given);
  llvm::Value* const count = l.b.CreateLoad(l.int64(), field(offsetof(Sink, count)));
  llvm::Value* const capacity = l.b.CreateLoad(l.int64(), field(offsetof(Sink, capacity)));
  l.b.CreateCondBr(l.b.CreateICmpEQ(count, capacity), grow, store);
  l.b.SetInsertPoint(grow);
  llvm::Value* const more = l.b.CreateLoad(l.b.getPtrTy(), field(offsetof(Sink, grow)));
  l.b.CreateCall(llvm::FunctionType::get(l.b.getVoidTy(), {l.b.getPtrTy()}, false), more, {sink});
  l.b.CreateBr(store);
  l.b.SetInsertPoint(store);
  llvm::Value* const arrays = l.b.CreateLoad(l.b.getPtrTy(), field(offsetof(Sink, arrays)));
  for (std::size_t c = 0; c < value.size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    llvm::Value* const slot =
        l.at(l.b.getPtrTy(), arrays, l.integer(l.int64(), static_cast<std::int64_t>(c)));
    llvm::Value* const array = l.b.CreateLoad(l.b.getPtrTy(), slot);
    l.storeOne(scalar, value[c].value, l.at(l.stored(scalar), array, count));
  }
  l.b.CreateStore(l.b.CreateAdd(count, l.integer(l.int64(), 1)), field(offsetof(Sink, count)));
  l.b.CreateBr(end);
  l.b.SetInsertPoint(end);
}

void Streams::scatter(std::uint32_t param, const Parts& index,
                      const std::function<Parts(const Parts&)>& combined) {
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  llvm::BasicBlock* const inside = llvm::BasicBlock::Create(l.b.getContext(), "put", function);
  llvm::BasicBlock* const end = llvm::BasicBlock::Create(l.b.getContext(), "scattered", function);
  llvm::Value* isInside = isGiven(param);
  llvm::Value* number = argumentField(param, offsetof(Argument, first), l.int64());
  for (std::size_t d = 0; d < index.size(); ++d) {
    llvm::Value* const i = l.b.CreateSExt(index[d].value, l.int64());
    isInside =
        l.b.CreateAnd(isInside, l.b.CreateICmpULT(i, argumentExtent(param, d, offsetof(Argument, extent))));
    number = l.b.CreateAdd(number, l.b.CreateMul(i, argumentExtent(param, d, offsetof(Argument, stride))));
  }
  l.b.CreateCondBr(isInside, inside, end);
  l.b.SetInsertPoint(inside);
  llvm::Value* const all = argumentField(param, offsetof(Argument, components), l.b.getPtrTy());
  std::vector<llvm::Value*> addresses;
  Parts old;
  for (std::size_t c = 0; c < scalars(param).size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    // not in the prologue: a stream that is left out has no arrays
    llvm::Value* const array = l.b.CreateLoad(
        l.b.getPtrTy(), l.at(l.b.getPtrTy(), all, l.integer(l.int64(), static_cast<std::int64_t>(c))));
    addresses.push_back(l.at(l.stored(scalar), array, number));
    old.push_back(l.loadOne(scalar, addresses.back()));
  }
  const Parts value = combined(old);
  for (std::size_t c = 0; c < value.size(); ++c) l.storeOne(scalars(param)[c], value[c].value, addresses[c]);
  l.b.CreateBr(end);
  l.b.SetInsertPoint(end);
}

}  // namespace skc::native
