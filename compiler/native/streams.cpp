// SPDX-License-Identifier: MIT
#include "native/streams.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>
#include <llvm/IR/MDBuilder.h>
#include <llvm/IR/Module.h>

#include "native/arithmetic.hpp"
#include "native/leaves.hpp"

namespace skc::native {

using namespace ir;
using sk::native::Argument;
using sk::native::Chunk;
using sk::native::Frame;

// ---- arguments of the function --------------------------------------------------------------------

Streams::Streams(Lanes& lanes, const Module& module, const Kernel& kernel, const SlotPlan& slots,
                 std::function<Parts(const Expr&)> value)
    : l(lanes), module_(module), kernel_(kernel), slots_(slots), value_(std::move(value)) {}

void Streams::begin(llvm::Value* frame, llvm::Value* chunk, llvm::BasicBlock* prologue) {
  frame_ = frame;
  chunk_ = chunk;
  prologue_ = prologue;
  start_ = l.b.getCurrentDebugLocation();
  loads_.clear();
  beginRow(nullptr, prologue);
}

void Streams::beginRow(llvm::Value* row, llvm::BasicBlock* prologue) {
  rowNumber_ = row;
  rowPrologue_ = prologue;
  rowArrays_.clear();
}

llvm::Value* Streams::emitIn(llvm::BasicBlock* prologue, const std::function<llvm::Value*()>& emit) {
  const llvm::IRBuilderBase::InsertPointGuard guard(l.b);
  if (llvm::Instruction* end = prologue->getTerminator()) {
    l.b.SetInsertPoint(end);
  } else {
    l.b.SetInsertPoint(prologue);
  }
  l.b.SetCurrentDebugLocation(start_);  // a breakpoint at the line that needs the value is not to stop here
  return emit();
}

llvm::Value* Streams::load(llvm::Value* base, std::size_t offset, llvm::Type* type) {
  llvm::Value*& known = loads_[{base, offset}];
  if (known != nullptr) return known;
  return known = inPrologue([&]() -> llvm::Value* {
           llvm::Value* const address = l.b.CreateConstGEP1_64(l.b.getInt8Ty(), base, offset);
           llvm::LoadInst* const value = l.b.CreateAlignedLoad(type, address, llvm::Align(8));
           value->setMetadata(llvm::LLVMContext::MD_invariant_load, llvm::MDNode::get(l.b.getContext(), {}));
           return value;
         });
}

llvm::Value* Streams::frameField(std::size_t offset, llvm::Type* type) { return load(frame_, offset, type); }
llvm::Value* Streams::chunkField(std::size_t offset) { return load(chunk_, offset, l.int64()); }
/// The chunks of several rows differ only in y.
llvm::Value* Streams::first(std::size_t dimension) {
  const std::size_t chunk = dimension == 1 ? row_ * sizeof(Chunk) : 0;
  llvm::Value* const index = chunkField(chunk + offsetof(Chunk, first) + dimension * sizeof(std::int64_t));
  if (dimension != 1 || rowNumber_ == nullptr) return index;
  return emitIn(rowPrologue_, [&] { return l.b.CreateAdd(index, rowNumber_, "", true, true); });
}
llvm::Value* Streams::isSilent() { return frameField(offsetof(Frame, isSilent), l.int64()); }
llvm::Value* Streams::tables() { return frameField(offsetof(Frame, tables), l.b.getPtrTy()); }

llvm::Value* Streams::argumentField(std::uint32_t param, std::size_t offset, llvm::Type* type) {
  llvm::Value* const arguments = frameField(offsetof(Frame, arguments), l.b.getPtrTy());
  return load(arguments, param * sizeof(Argument) + offset, type);
}
llvm::Value* Streams::argumentExtent(std::uint32_t param, std::size_t dimension, std::size_t field) {
  return argumentField(param, field + dimension * sizeof(std::int64_t), l.int64());
}
llvm::Value* Streams::component(std::uint32_t param, std::size_t component) {
  llvm::Value* const all = argumentField(param, offsetof(Argument, components), l.b.getPtrTy());
  return load(all, component * sizeof(void*), l.b.getPtrTy());
}
llvm::Value* Streams::array(std::size_t number) {
  llvm::Value* const all = load(chunk_, row_ * sizeof(Chunk) + offsetof(Chunk, arrays), l.b.getPtrTy());
  llvm::Value* const ofFirstRow = load(all, number * sizeof(void*), l.b.getPtrTy());
  if (rowNumber_ == nullptr) return ofFirstRow;
  llvm::Value*& known = rowArrays_[number];
  if (known != nullptr) return known;
  llvm::Value* const steps = load(chunk_, offsetof(Chunk, rowSteps), l.b.getPtrTy());
  return known = emitIn(rowPrologue_, [&] {
           llvm::Value* const at = l.b.CreateConstGEP1_64(l.int64(), steps, number);
           llvm::Value* const step = l.b.CreateAlignedLoad(l.int64(), at, llvm::Align(8));
           return l.b.CreateGEP(l.b.getInt8Ty(), ofFirstRow, l.b.CreateMul(rowNumber_, step));
         });
}

const std::vector<Scalar>& Streams::scalars(std::uint32_t param) {
  std::vector<Scalar>& known = scalars_[param];
  if (known.empty()) known = scalarsOf(module_, kernel_.params[param].type);
  return known;
}

// ---- values, elements and indices -----------------------------------------------------------------

Parts Streams::uniform(std::uint32_t param) {
  Parts parts;
  for (std::size_t c = 0; c < scalars(param).size(); ++c) {
    llvm::Value* const address = component(param, c);
    parts.push_back({inPrologue([&] { return l.loadOne(scalars(param)[c], address).value; })});
  }
  return parts;
}

Parts Streams::input(std::uint32_t param) {
  const SlotPlan::Location location = *slots_.find(param, {});
  Parts parts;
  for (std::size_t c = 0; c < scalars(param).size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    parts.push_back(
        l.loadNeighbors(scalar, l.at(l.stored(scalar), array(location.firstArray + c), element_)));
  }
  return parts;
}

void Streams::storeOutput(std::uint32_t param, const Parts& value) {
  const SlotPlan::Location location = *slots_.find(param, {});
  for (std::size_t c = 0; c < value.size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    l.storeNeighbors(scalar, value[c], l.at(l.stored(scalar), array(location.firstArray + c), element_));
  }
}

void Streams::prefetchOutput(std::uint32_t param) {
  constexpr std::uint32_t line = 64;
  const SlotPlan::Location location = *slots_.find(param, {});
  for (std::size_t c = 0; c < scalars(param).size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    llvm::Value* const first = l.at(l.stored(scalar), array(location.firstArray + c), element_);
    for (std::uint32_t byte = 0; byte < l.count() * l.storedBytes(scalar); byte += line) {
      llvm::Value* const address = l.b.CreateConstGEP1_64(l.b.getInt8Ty(), first, byte);
      // to write, into all levels of caches, data
      l.b.CreateIntrinsic(llvm::Intrinsic::prefetch, {l.b.getPtrTy()},
                          {address, l.b.getInt32(1), l.b.getInt32(3), l.b.getInt32(1)});
    }
  }
}

Parts Streams::index(const StreamRef& stream) {
  const bool isInput =
      stream.space == StreamRef::Space::KernelParameter && kernel_.params[stream.id].role == ParamRole::Input;
  Parts parts;
  for (std::size_t d = 0; d < 4; ++d) {
    llvm::Value* position = first(d);
    if (isInput) {
      llvm::Value* const multiply = argumentExtent(stream.id, d, offsetof(Argument, multiply));
      llvm::Value* const divide = argumentExtent(stream.id, d, offsetof(Argument, divide));
      position =
          emitIn(rowPrologue_, [&] { return l.b.CreateSDiv(l.b.CreateMul(position, multiply), divide); });
    }
    if (d > 0) {
      parts.push_back({l.b.CreateTrunc(position, l.int32())});
    } else if (kernel_.reduction) {
      parts.push_back({l.b.CreateTrunc(foldedPosition(position), l.vector(l.int32()))});
    } else {
      parts.push_back({l.b.CreateTrunc(l.b.CreateAdd(position, element_), l.int32()), true});
    }
  }
  return parts;
}

/// The x of each lane's element; in a fold, elements are `step` apart.
llvm::Value* Streams::foldedPosition(llvm::Value* first) {
  llvm::Value* const elements = l.b.CreateAdd(l.broadcast(element_), l.laneNumbers(l.int64()));
  llvm::Value* const step = l.broadcast(chunkField(offsetof(Chunk, step)));
  return l.b.CreateAdd(l.broadcast(first), l.b.CreateMul(elements, step));
}

Parts Streams::extent(const StreamRef& stream) {
  const bool isDomain = stream.space == StreamRef::Space::Domain;
  Parts parts;
  for (std::size_t d = 0; d < 4; ++d) {
    llvm::Value* const value = isDomain
                                   ? frameField(offsetof(Frame, domain) + d * sizeof(std::int64_t), l.int64())
                                   : argumentExtent(stream.id, d, offsetof(Argument, extent));
    parts.push_back({l.b.CreateTrunc(value, l.int32())});
  }
  return parts;
}

/// As GLSL's sk_ramp() (runtime/src/assemble/glsl/functions.glsl), with the same bits. `way` is the double from begin to end.
llvm::Value* Streams::ramp(llvm::Value* begin, llvm::Value* way, llvm::Value* steps, llvm::Value* k) {
  constexpr double longest = 3e38;
  llvm::Type* const floats = l.vector(l.type(Scalar::Float));
  llvm::Value* const length = l.b.CreateFDiv(way, l.b.CreateSIToFP(steps, way->getType()));
  llvm::Value* const isOne = l.b.CreateICmpEQ(steps, l.integer(l.int64(), 1));
  llvm::Value* const taken = l.b.CreateSelect(isOne, llvm::ConstantFP::get(way->getType(), 0), length);
  llvm::Value* const step = l.broadcast(l.b.CreateFPTrunc(taken, l.type(Scalar::Float)));
  llvm::Value* const start = l.broadcast(begin);
  const auto times = [&](llvm::Value* count) {
    return l.b.CreateFMul(l.b.CreateSIToFP(count, floats), step);
  };
  llvm::Value* const whole = times(k);
  llvm::Value* const half = l.b.CreateAShr(k, 1);
  llvm::Value* const inParts =
      l.b.CreateFAdd(l.b.CreateFAdd(start, times(half)), times(l.b.CreateSub(k, half)));
  llvm::Value* const distance = l.b.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, whole);
  llvm::Value* const isShort = l.b.CreateFCmpOLT(distance, llvm::ConstantFP::get(floats, longest));
  return l.b.CreateSelect(isShort, l.b.CreateFAdd(start, whole), inParts);
}

/// Floats by ramp(); doubles are begin + (end - begin) * k / n, and integers begin + (end - begin) / n * k.
Parts Streams::iterator(std::uint32_t param) {
  const std::size_t width = scalars(param).size();
  llvm::Value* const counts = argumentField(param, offsetof(Argument, countsElements), l.int64());
  llvm::Value* const byNumber = l.b.CreateICmpNE(counts, l.integer(l.int64(), 0));
  const auto domain = [&](std::size_t d) {
    return frameField(offsetof(Frame, domain) + d * sizeof(std::int64_t), l.int64());
  };
  llvm::Value* number = first(3);
  llvm::Value* total = domain(3);
  for (std::size_t d = 3; d-- > 0;) {
    number = l.b.CreateAdd(l.b.CreateMul(number, domain(d)), first(d));
    total = l.b.CreateMul(total, domain(d));
  }
  // elements are consecutive, except in folds
  llvm::Value* const spacing =
      kernel_.reduction ? chunkField(offsetof(Chunk, step)) : l.integer(l.int64(), 1);
  llvm::Value* const moved = l.b.CreateMul(element_, spacing);
  number = l.b.CreateAdd(number, moved);
  Parts parts;
  for (std::size_t c = 0; c < width; ++c) {
    const Scalar scalar = scalars(param)[c];
    const auto end = [&](std::int64_t i) {
      return l.loadOne(scalar, l.at(l.stored(scalar), component(param, c), l.integer(l.int64(), i)));
    };
    llvm::Value* const own = c == 0 ? l.b.CreateAdd(first(0), moved) : first(c);
    llvm::Value* const from = l.b.CreateSelect(byNumber, number, own);
    llvm::Value* const steps = l.b.CreateSelect(byNumber, total, domain(c));
    // from lane to lane, x and the number of the element grow; other indices do not
    llvm::Value* grows = spacing;
    if (c > 0) grows = l.b.CreateSelect(byNumber, spacing, l.integer(l.int64(), 0));
    llvm::Value* const k =
        l.b.CreateAdd(l.broadcast(from), l.b.CreateMul(l.laneNumbers(l.int64()), l.broadcast(grows)));
    const Part begin = end(0), last = end(1);
    if (scalar == Scalar::Int || scalar == Scalar::Uint) {
      const auto widened = [&](const Part& part) {
        return scalar == Scalar::Int ? l.b.CreateSExt(part.value, l.int64())
                                     : l.b.CreateZExt(part.value, l.int64());
      };
      llvm::Value* const step = l.b.CreateSDiv(l.b.CreateSub(widened(last), widened(begin)), steps);
      llvm::Value* const way = l.b.CreateMul(l.broadcast(step), k);
      parts.push_back(
          {l.b.CreateTrunc(l.b.CreateAdd(l.broadcast(widened(begin)), way), l.vector(l.int32()))});
      continue;
    }
    llvm::Type* const wide = l.type(Scalar::Double);
    const auto widened = [&](llvm::Value* value) { return l.b.CreateFPCast(value, wide); };
    llvm::Value* const a = widened(begin.value);
    llvm::Value* const way = l.b.CreateFSub(widened(last.value), a);
    if (scalar == Scalar::Float) {
      parts.push_back({ramp(begin.value, way, steps, k)});
      continue;
    }
    llvm::Value* const offset =
        l.b.CreateFDiv(l.b.CreateFMul(l.broadcast(way), l.b.CreateSIToFP(k, l.vector(wide))),
                       l.broadcast(l.b.CreateSIToFP(steps, wide)));
    parts.push_back({l.b.CreateFPCast(l.b.CreateFAdd(l.broadcast(a), offset), l.vector(l.type(scalar)))});
  }
  return parts;
}

// ---- gathers --------------------------------------------------------------------------------------

Parts Streams::border(std::uint32_t param) { return value_(*kernel_.params[param].border); }

Parts Streams::orBorder(std::uint32_t param, llvm::Value* isOutside, const Parts& value) {
  if (isOutside == nullptr) return value;
  const Parts outside = border(param);
  Parts parts;
  for (std::size_t c = 0; c < value.size(); ++c) parts.push_back(l.select({isOutside}, outside[c], value[c]));
  return parts;
}

/// Reads one element for all lanes, and applies the boundary mode.
Parts Streams::gatherBounded(std::uint32_t param, const Parts& index) {
  llvm::Value* number = argumentField(param, offsetof(Argument, first), l.int64());
  llvm::Value* isOutside = nullptr;
  for (std::size_t d = 0; d < index.size(); ++d) {
    const Inside in = inside(param, d, index[d].value);
    llvm::Value* const stride = argumentExtent(param, d, offsetof(Argument, stride));
    number = l.b.CreateAdd(number, d == 0 ? in.index : l.b.CreateMul(in.index, stride));
    if (in.isOutside != nullptr)
      isOutside = isOutside == nullptr ? in.isOutside : l.b.CreateOr(isOutside, in.isOutside);
  }
  Parts parts;
  for (std::size_t c = 0; c < scalars(param).size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    parts.push_back(l.loadOne(scalar, l.at(l.stored(scalar), component(param, c), number)));
  }
  return orBorder(param, isOutside, parts);
}

Parts Streams::choose(llvm::Value* condition, const std::function<Parts()>& yes,
                      const std::function<Parts()>& no, const std::vector<Scalar>& scalars) {
  llvm::Function* const function = l.b.GetInsertBlock()->getParent();
  const auto block = [&](const char* name) {
    return llvm::BasicBlock::Create(l.b.getContext(), name, function);
  };
  llvm::BasicBlock* const yesBlock = block("inside");
  llvm::BasicBlock* const noBlock = block("anywhere");
  llvm::BasicBlock* const end = block("read");
  l.b.CreateCondBr(condition, yesBlock, noBlock,
                   llvm::MDBuilder(l.b.getContext()).createLikelyBranchWeights());
  l.b.SetInsertPoint(yesBlock);
  Parts a = yes();
  for (Part& part : a) part = {l.broadcast(part)};
  llvm::BasicBlock* const yesEnd = l.b.GetInsertBlock();
  l.b.CreateBr(end);
  l.b.SetInsertPoint(noBlock);
  Parts c = no();
  for (Part& part : c) part = {l.broadcast(part)};
  llvm::BasicBlock* const noEnd = l.b.GetInsertBlock();
  l.b.CreateBr(end);
  l.b.SetInsertPoint(end);
  Parts result;
  for (std::size_t i = 0; i < scalars.size(); ++i) {
    llvm::PHINode* const phi = l.b.CreatePHI(a[i].value->getType(), 2);
    phi->addIncoming(a[i].value, yesEnd);
    phi->addIncoming(c[i].value, noEnd);
    result.push_back({phi});
  }
  return result;
}

/// Likewise. With one lane, it branches on whether the index is in bounds: the CPU predicts the branch and
/// loads without waiting for it.
Parts Streams::gatherOne(std::uint32_t param, const Parts& index) {
  if (l.count() > 1) return gatherBounded(param, index);
  llvm::Value* isInside = l.b.getTrue();
  for (std::size_t d = 0; d < index.size(); ++d) {
    llvm::Value* const i = l.b.CreateSExt(index[d].value, l.int64());
    isInside =
        l.b.CreateAnd(isInside, l.b.CreateICmpULT(l.b.CreateSub(i, low(param, d)), heldCount(param, d)));
  }
  const auto inside = [&] {
    llvm::Value* number = argumentField(param, offsetof(Argument, first), l.int64());
    for (std::size_t d = 0; d < index.size(); ++d) {
      llvm::Value* const i = l.b.CreateSExt(index[d].value, l.int64());
      llvm::Value* const stride = argumentExtent(param, d, offsetof(Argument, stride));
      number = l.b.CreateAdd(number, d == 0 ? i : l.b.CreateMul(i, stride));
    }
    Parts parts;
    for (std::size_t c = 0; c < scalars(param).size(); ++c) {
      const Scalar scalar = scalars(param)[c];
      parts.push_back(l.loadOne(scalar, l.at(l.stored(scalar), component(param, c), number)));
    }
    return parts;
  };
  return choose(isInside, inside, [&] { return gatherBounded(param, index); }, scalars(param));
}

/// Reads neighbours along x with one load if all of them are in bounds.
Parts Streams::gatherNeighbors(std::uint32_t param, const Parts& index) {
  llvm::Value* const x = l.b.CreateSExt(index[0].value, l.int64());
  llvm::Value* const firsts = inPrologue([&] {  // the number of indices from which all lanes are in bounds
    llvm::Value* const less = l.b.CreateSub(heldCount(param, 0), l.integer(l.int64(), l.count() - 1));
    return l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smax, less, l.integer(l.int64(), 0));
  });
  llvm::Value* const isInside = l.b.CreateICmpULT(l.b.CreateSub(x, low(param, 0)), firsts);
  return choose(
      isInside,
      [&] {
        llvm::Value* number = l.b.CreateAdd(argumentField(param, offsetof(Argument, first), l.int64()), x);
        llvm::Value* isOutside = nullptr;
        for (std::size_t d = 1; d < index.size(); ++d) {
          const Inside in = inside(param, d, index[d].value);
          number = l.b.CreateAdd(
              number, l.b.CreateMul(in.index, argumentExtent(param, d, offsetof(Argument, stride))));
          if (in.isOutside != nullptr) {
            isOutside = isOutside == nullptr ? in.isOutside : l.b.CreateOr(isOutside, in.isOutside);
          }
        }
        Parts parts;
        for (std::size_t c = 0; c < scalars(param).size(); ++c) {
          const Scalar scalar = scalars(param)[c];
          parts.push_back(l.loadNeighbors(scalar, l.at(l.stored(scalar), component(param, c), number)));
        }
        return orBorder(param, isOutside, parts);
      },
      [&] { return gatherByLanes(param, index); }, scalars(param));
}

/// Gathers by 32-bit element numbers; only for streams whose numbers all fit.
Parts Streams::gatherByNumbers(std::uint32_t param, const Parts& index) {
  const Boundary boundary = kernel_.params[param].boundary;
  llvm::Value* number = nullptr;
  llvm::Value* isOutside = nullptr;
  for (std::size_t d = 0; d < index.size(); ++d) {
    llvm::Value* i = l.broadcast(index[d]);
    if (boundary == Boundary::Clamp || boundary == Boundary::Border) {
      llvm::Value* const given = i;
      llvm::Value* const end = l.b.CreateTrunc(high(param, d), l.int32());
      llvm::Value* const most = l.broadcast(l.b.CreateSub(end, l.integer(l.int32(), 1)));
      llvm::Value* const least = l.broadcast(l.b.CreateTrunc(low(param, d), l.int32()));
      i = l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smin, i, most);
      i = l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smax, i, least);
      if (boundary == Boundary::Border) {
        llvm::Value* const extent =
            l.b.CreateTrunc(argumentExtent(param, d, offsetof(Argument, extent)), l.int32());
        llvm::Value* const beyond = l.b.CreateICmpUGE(given, l.broadcast(extent));
        isOutside = isOutside == nullptr ? beyond : l.b.CreateOr(isOutside, beyond);
      }
    }
    if (d > 0) {
      llvm::Value* const stride =
          l.b.CreateTrunc(argumentExtent(param, d, offsetof(Argument, stride)), l.int32());
      i = l.b.CreateMul(i, l.broadcast(stride));
    }
    number = number == nullptr ? i : l.b.CreateAdd(number, i);
  }
  llvm::Value* const start = argumentField(param, offsetof(Argument, start), l.int64());
  Parts parts;
  for (std::size_t c = 0; c < scalars(param).size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    parts.push_back(l.gather(scalar, l.at(l.stored(scalar), component(param, c), start), number));
  }
  return orBorder(param, isOutside, parts);
}

Parts Streams::gatherAnywhere(std::uint32_t param, const Parts& index) {
  const Boundary boundary = kernel_.params[param].boundary;
  llvm::Value* isFast =
      l.b.CreateICmpNE(argumentField(param, offsetof(Argument, isSmall), l.int64()), l.integer(l.int64(), 0));
  if (boundary == Boundary::Wrap || boundary == Boundary::Mirror) {
    isFast = l.b.CreateAnd(isFast, areAllHeld(param, index));
  }
  return choose(
      isFast, [&] { return gatherByNumbers(param, index); }, [&] { return gatherByLanes(param, index); },
      scalars(param));
}

/// Reads lane by lane in a function of its own: for rare cases.
Parts Streams::gatherByLanes(std::uint32_t param, const Parts& index) {
  if (l.count() == 1) {
    Parts own;
    for (const Part& part : index) own.push_back({part.value});
    return gatherOne(param, own);
  }
  llvm::Function* const function = laneGather(param);
  llvm::BasicBlock& entry = l.b.GetInsertBlock()->getParent()->getEntryBlock();
  llvm::IRBuilder<> allocas(&entry, entry.begin());
  llvm::Type* const indices = l.vector(l.int32());
  std::vector<llvm::Value*> arguments = {frame_};
  for (const Part& part : index) {
    llvm::Value* const memory = allocas.CreateAlloca(indices);
    l.b.CreateStore(l.broadcast(part), memory);
    arguments.push_back(memory);
  }
  std::vector<llvm::Value*> results;
  for (const Scalar scalar : scalars(param)) {
    results.push_back(allocas.CreateAlloca(l.vector(l.stored(scalar))));
    arguments.push_back(results.back());
  }
  l.b.CreateCall(function, arguments);
  Parts parts;
  for (std::size_t c = 0; c < results.size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    parts.push_back({l.fromStored(scalar, l.b.CreateLoad(l.vector(l.stored(scalar)), results[c]))});
  }
  return parts;
}

/// The function for gatherByLanes(): void(frame, indices for each dimension ..., results for each component
/// ...).
llvm::Function* Streams::laneGather(std::uint32_t param) {
  llvm::Function*& known = laneGathers_[param];
  if (known != nullptr) return known;
  llvm::Function* const around = l.b.GetInsertBlock()->getParent();
  const std::size_t rank = kernel_.params[param].rank;
  const std::vector<llvm::Type*> types(1 + rank + scalars(param).size(), l.b.getPtrTy());
  known = llvm::Function::Create(llvm::FunctionType::get(l.b.getVoidTy(), types, false),
                                 llvm::Function::InternalLinkage, around->getName() + ".lanes",
                                 around->getParent());
  known->copyAttributesFrom(around);
  known->addFnAttr(llvm::Attribute::NoInline);
  known->addFnAttr(llvm::Attribute::Cold);

  const llvm::IRBuilderBase::InsertPointGuard guard(l.b);
  l.b.SetCurrentDebugLocation({});  // which the function around owns
  llvm::LLVMContext& context = l.b.getContext();
  llvm::BasicBlock* const entry = llvm::BasicBlock::Create(context, "entry", known);
  llvm::BasicBlock* const loop = llvm::BasicBlock::Create(context, "lane", known);
  llvm::BasicBlock* const end = llvm::BasicBlock::Create(context, "end", known);
  CodegenOptions options = l.options();
  options.lanes = 1;
  Lanes one(l.b, options);
  Streams streams(one, module_, kernel_, slots_, value_);
  streams.begin(known->getArg(0), nullptr, entry);
  l.b.SetInsertPoint(loop);
  llvm::PHINode* const lane = l.b.CreatePHI(l.int64(), 2);
  lane->addIncoming(l.integer(l.int64(), 0), entry);
  Parts index;
  for (std::size_t d = 0; d < rank; ++d) {
    index.push_back(
        {l.b.CreateLoad(l.int32(), l.at(l.int32(), known->getArg(static_cast<unsigned>(1 + d)), lane))});
  }
  const Parts value = streams.gatherOne(param, index);
  for (std::size_t c = 0; c < value.size(); ++c) {
    const Scalar scalar = scalars(param)[c];
    one.storeOne(scalar, value[c].value,
                 l.at(l.stored(scalar), known->getArg(static_cast<unsigned>(1 + rank + c)), lane));
  }
  llvm::Value* const next = l.b.CreateAdd(lane, l.integer(l.int64(), 1));
  lane->addIncoming(next, l.b.GetInsertBlock());
  l.b.CreateCondBr(l.b.CreateICmpULT(next, l.integer(l.int64(), l.count())), loop, end);
  l.b.SetInsertPoint(end);
  l.b.CreateRetVoid();
  l.b.SetInsertPoint(entry);
  l.b.CreateBr(loop);
  return known;
}

Parts Streams::gather(std::uint32_t param, const Parts& index) {
  const auto areUniformFrom = [&](std::size_t d) {
    return std::all_of(index.begin() + static_cast<std::ptrdiff_t>(d), index.end(),
                       [&](const Part& part) { return l.isUniform(part); });
  };
  if (l.count() == 1 || areUniformFrom(0)) return gatherOne(param, index);
  if (index[0].isConsecutive && areUniformFrom(1)) return gatherNeighbors(param, index);
  return gatherAnywhere(param, index);
}

Parts Streams::neighbor(std::uint32_t param, const Parts& offset,
                        const std::optional<std::vector<std::int32_t>>& constant) {
  if (constant && isNear(*constant) && readsNeighbors(kernel_)) {
    std::int8_t row[3] = {};
    for (std::size_t d = 1; d < constant->size(); ++d) row[d - 1] = static_cast<std::int8_t>((*constant)[d]);
    const SlotPlan::Location location = *slots_.find(param, row);
    llvm::Value* const element = l.b.CreateAdd(element_, l.integer(l.int64(), (*constant)[0]));
    Parts parts;
    for (std::size_t c = 0; c < scalars(param).size(); ++c) {
      const Scalar scalar = scalars(param)[c];
      parts.push_back(
          l.loadNeighbors(scalar, l.at(l.stored(scalar), array(location.firstArray + c), element)));
    }
    return parts;
  }
  const Parts here = index({StreamRef::Space::Domain, 0});
  Parts there;
  for (std::size_t d = 0; d < offset.size(); ++d) there.push_back(moved(param, d, here[d], offset[d]));
  return gather(param, there);
}

}  // namespace skc::native
