// SPDX-License-Identifier: MIT
//
// Indices of gathers: which elements a stream holds, and what boundary modes give for all other indices.
#include <cstddef>

#include <llvm/IR/Intrinsics.h>
#include <llvm/IR/MDBuilder.h>

#include "native/arithmetic.hpp"
#include "native/streams.hpp"

namespace skc::native {

using namespace ir;
using sk::native::Argument;

llvm::Value* Streams::low(std::uint32_t param, std::size_t dimension) {
  return argumentExtent(param, dimension, offsetof(Argument, low));
}
llvm::Value* Streams::high(std::uint32_t param, std::size_t dimension) {
  return argumentExtent(param, dimension, offsetof(Argument, high));
}

/// The number of indices whose elements are held.
llvm::Value* Streams::heldCount(std::uint32_t param, std::size_t dimension) {
  return inPrologue([&] { return l.b.CreateSub(high(param, dimension), low(param, dimension)); });
}

/// The nearest index whose element is held.
llvm::Value* Streams::clamped(std::uint32_t param, std::size_t dimension, llvm::Value* index) {
  llvm::Value* const most = l.b.CreateSub(high(param, dimension), l.integer(l.int64(), 1));
  return l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smax,
                                   l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smin, index, most),
                                   low(param, dimension));
}

Streams::Inside Streams::inside(std::uint32_t param, std::size_t dimension, llvm::Value* index) {
  llvm::Value* const n = argumentExtent(param, dimension, offsetof(Argument, extent));
  llvm::Value* const i = l.b.CreateSExt(index, l.int64());
  llvm::Value* const zero = l.integer(l.int64(), 0);
  llvm::Value* const one = l.integer(l.int64(), 1);
  const auto modulo = [&](llvm::Value* number, llvm::Value* period) {
    llvm::Value* const rest = l.b.CreateSRem(number, period);
    return l.b.CreateSelect(l.b.CreateICmpSLT(rest, zero), l.b.CreateAdd(rest, period), rest);
  };
  switch (kernel_.params[param].boundary) {
    case Boundary::Clamp: return {clamped(param, dimension, i), nullptr};
    case Boundary::Border: return {clamped(param, dimension, i), l.b.CreateICmpUGE(i, n)};
    case Boundary::Wrap:
      return {unlessHeld(param, dimension, i,
                         [&] {
                           llvm::Value* const first = low(param, dimension);
                           return l.b.CreateAdd(first, modulo(l.b.CreateSub(i, first), n));
                         }),
              nullptr};
    case Boundary::Mirror: break;
  }
  return {unlessHeld(param, dimension, i,
                     [&] {
                       llvm::Value* const period = l.b.CreateShl(n, 1);
                       llvm::Value* const rest = modulo(i, period);
                       llvm::Value* const back = l.b.CreateSub(l.b.CreateSub(period, one), rest);
                       return l.b.CreateSelect(l.b.CreateICmpSLT(rest, n), rest, back);
                     }),
          nullptr};
}

/// The index itself if its element is held, which CPUs predict; else what `remap` computes, which takes a division.
llvm::Value* Streams::unlessHeld(std::uint32_t param, std::size_t dimension, llvm::Value* index,
                                 const std::function<llvm::Value*()>& remap) {
  llvm::BasicBlock* const before = l.b.GetInsertBlock();
  const auto block = [&](const char* name) {
    return llvm::BasicBlock::Create(l.b.getContext(), name, before->getParent());
  };
  llvm::BasicBlock* const outside = block("outside");
  llvm::BasicBlock* const end = block("held");
  llvm::Value* const isHeld =
      l.b.CreateICmpULT(l.b.CreateSub(index, low(param, dimension)), heldCount(param, dimension));
  l.b.CreateCondBr(isHeld, end, outside, llvm::MDBuilder(l.b.getContext()).createLikelyBranchWeights());
  l.b.SetInsertPoint(outside);
  llvm::Value* const remapped = clamped(param, dimension, remap());
  llvm::BasicBlock* const outsideEnd = l.b.GetInsertBlock();
  l.b.CreateBr(end);
  l.b.SetInsertPoint(end);
  llvm::PHINode* const phi = l.b.CreatePHI(l.int64(), 2);
  phi->addIncoming(index, before);
  phi->addIncoming(remapped, outsideEnd);
  return phi;
}

/// True if the elements at the indices of all lanes are held as they are.
llvm::Value* Streams::areAllHeld(std::uint32_t param, const Parts& index) {
  llvm::Value* all = nullptr;
  for (std::size_t d = 0; d < index.size(); ++d) {
    llvm::Value* const least = l.b.CreateTrunc(low(param, d), l.int32());
    llvm::Value* const count = l.b.CreateTrunc(heldCount(param, d), l.int32());
    llvm::Value* const from = l.b.CreateSub(l.broadcast(index[d]), l.broadcast(least));
    llvm::Value* const in = l.b.CreateICmpULT(from, l.broadcast(count));
    all = all == nullptr ? in : l.b.CreateAnd(all, in);
  }
  return l.isVector(all) ? l.b.CreateAndReduce(all) : all;
}

/// The sum of an index and an offset; if it could overflow, another index at which the gather has the same
/// element.
Part Streams::moved(std::uint32_t param, std::size_t dimension, const Part& index, const Part& offset) {
  const Boundary boundary = kernel_.params[param].boundary;
  if (boundary == Boundary::Wrap || boundary == Boundary::Mirror) {
    const Part extent{
        l.b.CreateTrunc(argumentExtent(param, dimension, offsetof(Argument, extent)), l.int32())};
    if (boundary == Boundary::Wrap) {
      return binary(l, BinaryOp::Add, Scalar::Int, index,
                    binary(l, BinaryOp::Rem, Scalar::Int, offset, extent));
    }
    const Part period{l.b.CreateShl(extent.value, 1)};
    const Part rest = binary(l, BinaryOp::Rem, Scalar::Int, offset, period);
    // The sum of an index and an extent is an int; that of an index and a period may exceed it.
    const Part isNear = binary(l, BinaryOp::Less, Scalar::Int, rest, extent);
    const Part near = l.select(isNear, rest, binary(l, BinaryOp::Sub, Scalar::Int, rest, period));
    return binary(l, BinaryOp::Add, Scalar::Int, index, near);
  }
  if (l.isUniform(offset)) {  // so that consecutive indices stay consecutive
    llvm::Value* const most = l.integer(l.int32(), 1 << 30);
    llvm::Value* const least = l.integer(l.int32(), -(1 << 30));
    llvm::Value* const low = l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smax, offset.value, least);
    return binary(l, BinaryOp::Add, Scalar::Int, index,
                  {l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smin, low, most)});
  }
  Part a = index, c = offset;
  l.unify(a, c);
  return {l.b.CreateBinaryIntrinsic(llvm::Intrinsic::sadd_sat, a.value, c.value)};
}

}  // namespace skc::native
