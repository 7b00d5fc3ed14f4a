// SPDX-License-Identifier: MIT
//
// Pushes to variable outputs and stores to scatter outputs. The active lanes append records, which are
// carried out later; without an append buffer, stores are carried out immediately.
#include <algorithm>
#include <cstddef>

#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>
#include <llvm/IR/IntrinsicsX86.h>

#include "native/arithmetic.hpp"
#include "native/intrinsics.hpp"
#include "native/streams.hpp"

namespace skc::native {

using namespace ir;
using sk::native::AppendBuffer;
using sk::native::Argument;

/// One array of an AppendBuffer, and the value that each lane appends to it.
struct Streams::Column {
  std::size_t field;  ///< offset in AppendBuffer
  std::size_t component;  ///< index in AppendBuffer::arrays
  llvm::Value* values;
  llvm::Value* array = nullptr;
};

namespace {

/// Sizes, in bits, of the vectors that AVX-512 can compress.
constexpr std::uint32_t leastCompressed = 128;
constexpr std::uint32_t mostCompressed = 512;

llvm::Value* lanesFrom(Lanes& l, llvm::Value* vector, std::uint32_t first, std::uint32_t count) {
  std::vector<int> numbers;
  for (std::uint32_t i = 0; i < count; ++i) numbers.push_back(static_cast<int>(first + i));
  return l.b.CreateShuffleVector(vector, numbers);
}

/// Moves the entries whose mask bit is set to the front. The entries behind them are unspecified.
llvm::Value* compressed(Lanes& l, llvm::Value* vector, llvm::Value* mask) {
  llvm::Type* const type = vector->getType();
  return l.b.CreateIntrinsic(llvm::Intrinsic::x86_avx512_mask_compress, {type},
                             {vector, llvm::Constant::getNullValue(type), mask});
}

llvm::Value* maskOfBits(Lanes& l, llvm::Value* bits) {
  return l.b.CreateBitCast(bits, l.vector(l.b.getInt1Ty()));
}

/// Stores the values of the active lanes consecutively from array[count] on. May overwrite entries behind
/// them.
void storeCompressed(Lanes& l, llvm::Value* values, llvm::Value* array, llvm::Value* bits,
                     llvm::Value* count) {
  llvm::Type* const stored = values->getType()->getScalarType();
  const bool isNarrow = stored->getScalarSizeInBits() < 32;
  if (isNarrow) values = l.b.CreateZExt(values, l.vector(l.int32()));
  const std::uint32_t width = values->getType()->getScalarSizeInBits();
  const std::uint32_t together = std::min(l.count(), mostCompressed / width);
  for (std::uint32_t first = 0; first < l.count(); first += together) {
    llvm::Value* part = compressed(l, lanesFrom(l, values, first, together),
                                   lanesFrom(l, maskOfBits(l, bits), first, together));
    if (isNarrow) part = l.b.CreateTrunc(part, llvm::FixedVectorType::get(stored, together));
    llvm::Value* const before = l.b.CreateAnd(
        bits, llvm::ConstantInt::get(bits->getType(), llvm::APInt::getLowBitsSet(l.count(), first)));
    llvm::Value* const skipped =
        l.b.CreateZExt(l.b.CreateUnaryIntrinsic(llvm::Intrinsic::ctpop, before), l.int64());
    l.b.CreateAlignedStore(part, l.at(stored, array, l.b.CreateAdd(count, skipped)),
                           llvm::Align(stored->getScalarSizeInBits() / 8));
  }
}

}  // namespace

llvm::Value* Streams::loadField(llvm::Value* record, std::size_t offset, llvm::Type* type) {
  return l.b.CreateLoad(type, l.b.CreateConstGEP1_64(l.b.getInt8Ty(), record, offset));
}

void Streams::push(std::uint32_t param, const Parts& value, llvm::Value* mask) {
  std::vector<Column> columns;
  for (std::size_t c = 0; c < value.size(); ++c)
    columns.push_back(
        {offsetof(AppendBuffer, arrays), c, l.toStored(scalars(param)[c], l.broadcast(value[c]))});
  record(param, mask, std::move(columns));
}

void Streams::scatter(std::uint32_t param, const Parts& index, const Parts& value, llvm::Value* mask) {
  llvm::Value* number = l.broadcast(argumentField(param, offsetof(Argument, first), l.int64()));
  for (std::size_t d = 0; d < index.size(); ++d) {
    llvm::Value* const i = l.broadcast(index[d]);
    // compared as unsigned, a negative index is 2^31 or more, and so never in bounds
    llvm::Value* const extent =
        l.b.CreateBinaryIntrinsic(llvm::Intrinsic::umin, argumentExtent(param, d, offsetof(Argument, extent)),
                                  l.integer(l.int64(), std::int64_t{1} << 31));
    mask = l.b.CreateAnd(mask, l.b.CreateICmpULT(i, l.broadcast(l.b.CreateTrunc(extent, l.int32()))));
    llvm::Value* step = l.b.CreateSExt(i, l.vector(l.int64()));
    if (d > 0) step = l.b.CreateMul(step, l.broadcast(argumentExtent(param, d, offsetof(Argument, stride))));
    number = l.b.CreateAdd(number, step);
  }
  Parts stored;
  for (std::size_t c = 0; c < value.size(); ++c)
    stored.push_back({l.toStored(scalars(param)[c], l.broadcast(value[c]))});
  const auto logged = [&] {
    std::vector<Column> columns = {{offsetof(AppendBuffer, targets), 0, number}};
    for (std::size_t c = 0; c < stored.size(); ++c)
      columns.push_back({offsetof(AppendBuffer, arrays), c, stored[c].value});
    record(param, mask, std::move(columns));
  };
  if (numbersRecords_) return logged();
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  const auto block = [&](const char* name) {
    return llvm::BasicBlock::Create(l.b.getContext(), name, function);
  };
  llvm::BasicBlock* const log = block("log");
  llvm::BasicBlock* const direct = block("direct");
  llvm::BasicBlock* const end = block("scattered");
  llvm::Value* const appendBuffer = argumentField(param, offsetof(Argument, appendBuffer), l.b.getPtrTy());
  l.b.CreateCondBr(l.b.CreateIsNotNull(appendBuffer), log, direct);
  l.b.SetInsertPoint(log);
  logged();
  l.b.CreateBr(end);
  l.b.SetInsertPoint(direct);
  applyLanes(param, number, stored, mask);
  l.b.CreateBr(end);
  l.b.SetInsertPoint(end);
}

/// Carries out the stores of the active lanes immediately, in the order of lanes.
void Streams::applyLanes(std::uint32_t param, llvm::Value* number, const Parts& stored, llvm::Value* mask) {
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  const auto block = [&](const char* name) {
    return llvm::BasicBlock::Create(l.b.getContext(), name, function);
  };
  llvm::BasicBlock* const given = block("given");
  llvm::BasicBlock* const every = block("every");
  llvm::BasicBlock* const some = block("some");
  llvm::BasicBlock* const end = block("stored");
  llvm::Value* const all = argumentField(param, offsetof(Argument, components), l.b.getPtrTy());
  llvm::Value* const bits = l.b.CreateBitCast(mask, l.b.getIntNTy(l.count()));
  l.b.CreateCondBr(l.b.CreateAnd(l.b.CreateIsNotNull(all), l.b.CreateIsNotNull(bits)), given, end);
  l.b.SetInsertPoint(given);
  const std::vector<llvm::Value*> to = componentsNow(param);
  l.b.CreateCondBr(l.b.CreateICmpEQ(bits, llvm::Constant::getAllOnesValue(bits->getType())), every, some);
  l.b.SetInsertPoint(every);
  const auto inLane = [&](llvm::Value* lanes, std::uint32_t lane) {
    return l.isVector(lanes) ? l.lane(lanes, lane) : lanes;
  };
  for (std::uint32_t lane = 0; lane < l.count(); ++lane) {
    Parts value;
    for (std::size_t c = 0; c < stored.size(); ++c)
      value.push_back({l.fromStored(scalars(param)[c], inLane(stored[c].value, lane))});
    applyOne(param, inLane(number, lane), value, to);
  }
  l.b.CreateBr(end);
  l.b.SetInsertPoint(some);
  applySomeLanes(param, number, stored, bits, to);
  l.b.CreateBr(end);
  l.b.SetInsertPoint(end);
}

/// Loops over the active lanes; there is at least one.
void Streams::applySomeLanes(std::uint32_t param, llvm::Value* number, const Parts& stored, llvm::Value* bits,
                             const std::vector<llvm::Value*>& to) {
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  llvm::IRBuilder<> allocas(&function->getEntryBlock(), function->getEntryBlock().begin());
  const auto inMemory = [&](llvm::Value* lanes) {
    llvm::Value* const memory = allocas.CreateAlloca(lanes->getType());
    l.b.CreateStore(lanes, memory);
    return memory;
  };
  llvm::BasicBlock* const before = l.b.GetInsertBlock();
  llvm::BasicBlock* const one = llvm::BasicBlock::Create(l.b.getContext(), "lane", function);
  llvm::BasicBlock* const end = llvm::BasicBlock::Create(l.b.getContext(), "lanes", function);
  llvm::Value* const targets = inMemory(number);
  std::vector<llvm::Value*> from;
  for (const Part& part : stored) from.push_back(inMemory(part.value));
  llvm::Value* const set = l.b.CreateZExt(bits, l.int64());
  l.b.CreateBr(one);
  l.b.SetInsertPoint(one);
  llvm::PHINode* const left = l.b.CreatePHI(l.int64(), 2);
  left->addIncoming(set, before);
  llvm::Value* const lane = l.b.CreateBinaryIntrinsic(llvm::Intrinsic::cttz, left, l.b.getTrue());
  applyRecord(param, targets, from, to, lane);
  llvm::Value* const rest = l.b.CreateAnd(left, l.b.CreateSub(left, l.integer(l.int64(), 1)));
  left->addIncoming(rest, l.b.GetInsertBlock());
  l.b.CreateCondBr(l.b.CreateIsNotNull(rest), one, end);
  l.b.SetInsertPoint(end);
}

/// Loads the arrays of a parameter; not in the prologue, because an omitted stream has none.
std::vector<llvm::Value*> Streams::componentsNow(std::uint32_t param) {
  llvm::Value* const all = argumentField(param, offsetof(Argument, components), l.b.getPtrTy());
  std::vector<llvm::Value*> arrays;
  for (std::size_t c = 0; c < scalars(param).size(); ++c)
    arrays.push_back(loadField(all, c * sizeof(void*), l.b.getPtrTy()));
  return arrays;
}

/// Carries out record `i`; `targets` and `from` are the arrays of the records' targets and components.
void Streams::applyRecord(std::uint32_t param, llvm::Value* targets, const std::vector<llvm::Value*>& from,
                          const std::vector<llvm::Value*>& to, llvm::Value* i) {
  Parts value;
  for (std::size_t c = 0; c < from.size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    value.push_back(l.loadOne(scalar, l.at(l.stored(scalar), from[c], i)));
  }
  applyOne(param, l.b.CreateLoad(l.int64(), l.at(l.int64(), targets, i)), value, to);
}

void Streams::applyOne(std::uint32_t param, llvm::Value* target, const Parts& value,
                       const std::vector<llvm::Value*>& to) {
  std::vector<llvm::Value*> addresses;
  Parts old;
  for (std::size_t c = 0; c < to.size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    addresses.push_back(l.at(l.stored(scalar), to[c], target));
    old.push_back(l.loadOne(scalar, addresses[c]));
  }
  const Parts result = combined(param, old, value);
  for (std::size_t c = 0; c < to.size(); ++c) l.storeOne(scalars(param)[c], result[c].value, addresses[c]);
}

/// The new value of an element of a scatter output.
Parts Streams::combined(std::uint32_t param, const Parts& old, const Parts& value) {
  Parts result;
  for (std::size_t c = 0; c < value.size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    const Type type = Type::of(scalar);
    const std::vector<IntrinsicArgument> both = {{type, {old[c]}}, {type, {value[c]}}};
    switch (kernel_.params[param].scatter) {
      case ScatterOp::Store: result.push_back(value[c]); break;
      case ScatterOp::Add: result.push_back(binary(l, BinaryOp::Add, scalar, old[c], value[c])); break;
      case ScatterOp::Min: result.push_back(intrinsic(l, Intrinsic::Min, both)[0]); break;
      case ScatterOp::Max: result.push_back(intrinsic(l, Intrinsic::Max, both)[0]); break;
    }
  }
  return result;
}

void Streams::record(std::uint32_t param, llvm::Value* mask, std::vector<Column> columns) {
  if (numbersRecords_ && l.count() > 1) {
    llvm::Value* const first = l.b.CreateTrunc(element_, l.int32());
    columns.push_back({offsetof(AppendBuffer, elements), 0, l.broadcast({first, /*isConsecutive=*/true})});
  }
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  llvm::BasicBlock* const some = llvm::BasicBlock::Create(l.b.getContext(), "record", function);
  llvm::BasicBlock* const end = llvm::BasicBlock::Create(l.b.getContext(), "recorded", function);
  llvm::Value* const appendBuffer = argumentField(param, offsetof(Argument, appendBuffer), l.b.getPtrTy());
  llvm::Value* const bits = l.b.CreateBitCast(mask, l.b.getIntNTy(l.count()));
  l.b.CreateCondBr(l.b.CreateAnd(l.b.CreateIsNotNull(appendBuffer), l.b.CreateIsNotNull(bits)), some, end);
  l.b.SetInsertPoint(some);
  makeRoom(appendBuffer);
  for (Column& column : columns) {
    column.array = loadField(appendBuffer, column.field, l.b.getPtrTy());
    if (column.field == offsetof(AppendBuffer, arrays))
      column.array = loadField(column.array, column.component * sizeof(void*), l.b.getPtrTy());
  }
  llvm::Value* const count = loadField(appendBuffer, offsetof(AppendBuffer, count), l.int64());
  llvm::Value* const next = storeRecords(columns, bits, count);
  l.b.CreateStore(next, l.b.CreateConstGEP1_64(l.b.getInt8Ty(), appendBuffer, offsetof(AppendBuffer, count)));
  l.b.CreateBr(end);
  l.b.SetInsertPoint(end);
}

void Streams::makeRoom(llvm::Value* appendBuffer) {
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  llvm::BasicBlock* const grow = llvm::BasicBlock::Create(l.b.getContext(), "grow", function);
  llvm::BasicBlock* const append = llvm::BasicBlock::Create(l.b.getContext(), "append", function);
  llvm::Value* const count = loadField(appendBuffer, offsetof(AppendBuffer, count), l.int64());
  llvm::Value* const capacity = loadField(appendBuffer, offsetof(AppendBuffer, capacity), l.int64());
  l.b.CreateCondBr(l.b.CreateICmpSGE(count, capacity), grow, append);
  l.b.SetInsertPoint(grow);
  llvm::Value* const more = loadField(appendBuffer, offsetof(AppendBuffer, grow), l.b.getPtrTy());
  l.b.CreateCall(llvm::FunctionType::get(l.b.getVoidTy(), {l.b.getPtrTy()}, false), more, {appendBuffer});
  l.b.CreateBr(append);
  l.b.SetInsertPoint(append);
}

/// Stores the records of the active lanes from number `count` on; returns the new count.
llvm::Value* Streams::storeRecords(const std::vector<Column>& columns, llvm::Value* bits,
                                   llvm::Value* count) {
  const auto addressAt = [&](const Column& column, llvm::Value* number) {
    return l.at(column.values->getType()->getScalarType(), column.array, number);
  };
  const auto store = [&](llvm::Value* value, llvm::Value* address) {
    l.b.CreateAlignedStore(value, address, llvm::Align(value->getType()->getScalarSizeInBits() / 8));
  };
  const auto storeAll = [&] {
    for (const Column& column : columns) store(column.values, addressAt(column, count));
    return l.b.CreateAdd(count, l.integer(l.int64(), l.count()));
  };
  if (l.count() == 1) return storeAll();
  if (l.options().hasMaskRegisters && l.count() * 32 >= leastCompressed) {
    for (const Column& column : columns) storeCompressed(l, column.values, column.array, bits, count);
    llvm::Value* const added = l.b.CreateUnaryIntrinsic(llvm::Intrinsic::ctpop, bits);
    return l.b.CreateAdd(count, l.b.CreateZExt(added, l.int64()));
  }
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  const auto block = [&](const char* name) {
    return llvm::BasicBlock::Create(l.b.getContext(), name, function);
  };
  llvm::BasicBlock* const all = block("all");
  llvm::BasicBlock* const some = block("some");
  llvm::BasicBlock* const end = block("stored");
  l.b.CreateCondBr(l.b.CreateICmpEQ(bits, llvm::Constant::getAllOnesValue(bits->getType())), all, some);
  l.b.SetInsertPoint(all);
  llvm::Value* const afterAll = storeAll();
  l.b.CreateBr(end);
  // every lane stores; the next lane overwrites the record of an inactive one
  l.b.SetInsertPoint(some);
  llvm::Value* const mask = l.b.CreateZExt(bits, l.int64());
  llvm::Value* next = count;
  for (std::uint32_t lane = 0; lane < l.count(); ++lane) {
    for (const Column& column : columns) store(l.lane(column.values, lane), addressAt(column, next));
    next = l.b.CreateAdd(next, l.b.CreateAnd(l.b.CreateLShr(mask, lane), 1));
  }
  l.b.CreateBr(end);
  l.b.SetInsertPoint(end);
  llvm::PHINode* const after = l.b.CreatePHI(l.int64(), 2);
  after->addIncoming(afterAll, all);
  after->addIncoming(next, some);
  return after;
}

void Streams::apply(std::uint32_t param, llvm::Value* appendBuffer) {
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  llvm::BasicBlock* const before = l.b.GetInsertBlock();
  llvm::BasicBlock* const one = llvm::BasicBlock::Create(l.b.getContext(), "apply", function);
  llvm::BasicBlock* const end = llvm::BasicBlock::Create(l.b.getContext(), "applied", function);
  llvm::Value* const count = loadField(appendBuffer, offsetof(AppendBuffer, count), l.int64());
  llvm::Value* const targets = loadField(appendBuffer, offsetof(AppendBuffer, targets), l.b.getPtrTy());
  llvm::Value* const arrays = loadField(appendBuffer, offsetof(AppendBuffer, arrays), l.b.getPtrTy());
  std::vector<llvm::Value*> from;
  for (std::size_t c = 0; c < scalars(param).size(); ++c)
    from.push_back(loadField(arrays, c * sizeof(void*), l.b.getPtrTy()));
  const std::vector<llvm::Value*> to = componentsNow(param);
  llvm::Value* const zero = l.integer(l.int64(), 0);
  l.b.CreateCondBr(l.b.CreateICmpSLT(zero, count), one, end);
  l.b.SetInsertPoint(one);
  llvm::PHINode* const i = l.b.CreatePHI(l.int64(), 2);
  i->addIncoming(zero, before);
  applyRecord(param, targets, from, to, i);
  llvm::Value* const next = l.b.CreateAdd(i, l.integer(l.int64(), 1), "", true, true);
  i->addIncoming(next, l.b.GetInsertBlock());
  l.b.CreateCondBr(l.b.CreateICmpSLT(next, count), one, end);
  l.b.SetInsertPoint(end);
}

}  // namespace skc::native
