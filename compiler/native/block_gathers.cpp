// SPDX-License-Identifier: MIT
//
// Reads gathers in blocks (block_gathers.hpp): each lane loads consecutive elements of its row, and a
// transpose turns these into one vector per iteration. It transposes 4 x 4 elements at a time, which every
// CPU can do within 128 bits of a register.
#include "native/block_gathers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>

#include "ir/counted_loop.hpp"
#include "ir/walk.hpp"
#include "native/leaves.hpp"
#include "native/loop_indices.hpp"
#include "native/streams.hpp"

namespace skc::native {

using namespace ir;
using analysis::Shape;
using analysis::Uniformity;
using sk::native::Argument;

namespace {

constexpr std::size_t mostComponents = 4;

/// True if all components of an element take 32 bits.
bool holdsWords(const Module& module, const Kernel& kernel, const GatherRead& read) {
  const std::vector<Scalar> scalars = scalarsOf(module, kernel.params[read.stream.id].type);
  return std::ranges::all_of(scalars, [](Scalar scalar) {
    return scalar == Scalar::Float || scalar == Scalar::Int || scalar == Scalar::Uint;
  });
}

/// True if lanes read neither the same element nor consecutive ones.
bool isScattered(const Uniformity& uniformity, FunctionId function, const Expr& index) {
  const std::vector<Shape> shapes = uniformity.leavesOf(function, index);
  const bool isRow =
      std::all_of(shapes.begin() + 1, shapes.end(), [](Shape shape) { return shape == Shape::Uniform; });
  return shapes[0] == Shape::Varying || !isRow;
}

/// True if x grows by one in each iteration and the other indices are invariant.
bool advances(const LoopIndices& indices, const Expr& index) {
  if (index.type.isScalar()) return indices.growsByOne(index);
  const auto* n = std::get_if<Construct>(&index.node);
  if (n == nullptr || n->args.size() < 2 || !indices.growsByOne(*n->args.front())) return false;
  return std::all_of(n->args.begin() + 1, n->args.end(),
                     [&](const ExprPtr& arg) { return indices.isInvariant(*arg); });
}

}  // namespace

std::vector<BlockGather> blockGathers(const Module& module, const Kernel& kernel,
                                      const Uniformity& uniformity, FunctionId function, const Loop& loop) {
  const std::optional<std::int64_t> iterations = tripCount(module, loop);
  if (iterations && *iterations < Streams::blockLength) return {};
  std::optional<LoopIndices> indices = LoopIndices::of(module, uniformity, function, loop);
  if (!indices) return {};
  std::vector<BlockGather> found;
  std::size_t components = 0;
  walkExprs(loop.body, [&](const Expr& expr) {
    const auto* read = std::get_if<GatherRead>(&expr.node);
    if (read == nullptr || !holdsWords(module, kernel, *read) ||
        !isScattered(uniformity, function, *read->index))
      return;
    ExprPtr index = indices->beforeBody(*read->index);
    if (!advances(*indices, *index)) return;
    components += componentCount(module, expr.type);
    found.push_back({&expr, std::move(index)});
  });
  if (components > mostComponents || !isBodySmall(module, loop)) return {};
  return found;
}

namespace {

/// Shuffles each segment of 4 entries in the same way: 0 to 3 are entries of `a`, 4 to 7 entries of `c`.
llvm::Value* shuffleSegments(Lanes& l, llvm::Value* a, llvm::Value* c, const std::array<int, 4>& from) {
  const auto width = static_cast<int>(llvm::cast<llvm::FixedVectorType>(a->getType())->getNumElements());
  std::vector<int> mask;
  for (int segment = 0; segment < width; segment += 4) {
    for (const int i : from) mask.push_back(segment + (i < 4 ? i : width + i - 4));
  }
  return l.b.CreateShuffleVector(a, c, mask);
}

/// Transposes four vectors within each segment of 4 entries.
std::array<llvm::Value*, 4> transposeSegments(Lanes& l, const std::array<llvm::Value*, 4>& rows) {
  const auto low = [&](llvm::Value* a, llvm::Value* c) { return shuffleSegments(l, a, c, {0, 4, 1, 5}); };
  const auto high = [&](llvm::Value* a, llvm::Value* c) { return shuffleSegments(l, a, c, {2, 6, 3, 7}); };
  const auto first = [&](llvm::Value* a, llvm::Value* c) { return shuffleSegments(l, a, c, {0, 1, 4, 5}); };
  const auto last = [&](llvm::Value* a, llvm::Value* c) { return shuffleSegments(l, a, c, {2, 3, 6, 7}); };
  llvm::Value* const low01 = low(rows[0], rows[1]);
  llvm::Value* const low23 = low(rows[2], rows[3]);
  llvm::Value* const high01 = high(rows[0], rows[1]);
  llvm::Value* const high23 = high(rows[2], rows[3]);
  return {first(low01, low23), last(low01, low23), first(high01, high23), last(high01, high23)};
}

/// Concatenates vectors of equal length, a power of 2 of them.
llvm::Value* concatenate(Lanes& l, std::vector<llvm::Value*> vectors) {
  while (vectors.size() > 1) {
    const auto width = llvm::cast<llvm::FixedVectorType>(vectors[0]->getType())->getNumElements();
    std::vector<int> mask;
    for (unsigned i = 0; i < 2 * width; ++i) mask.push_back(static_cast<int>(i));
    for (std::size_t i = 0; i < vectors.size() / 2; ++i)
      vectors[i] = l.b.CreateShuffleVector(vectors[2 * i], vectors[2 * i + 1], mask);
    vectors.resize(vectors.size() / 2);
  }
  return vectors[0];
}

}  // namespace

llvm::Value* Streams::isBlockInside(std::uint32_t param, const Parts& index) {
  llvm::Value* isInside =
      l.b.CreateICmpEQ(argumentField(param, offsetof(Argument, isSmall), l.int64()), l.integer(l.int64(), 1));
  const auto require = [&](llvm::Value* condition) {
    isInside = l.b.CreateAnd(isInside, l.isVector(condition) ? l.b.CreateAndReduce(condition) : condition);
  };
  for (std::size_t d = 0; d < index.size(); ++d) {
    const bool isClamped = kernel_.params[param].boundary == Boundary::Clamp;
    if (d > 0 && isClamped) continue;  // laneOffsets clamps it
    llvm::Value* const count = l.b.CreateTrunc(heldCount(param, d), l.int32());
    llvm::Value* const least = l.b.CreateTrunc(low(param, d), l.int32());
    const std::uint32_t needed = d == 0 ? blockLength : 1;
    llvm::Value* const last = l.b.CreateSub(count, l.integer(l.int32(), needed));
    llvm::Value* const i = l.value(index[d]);
    const auto like = [&](llvm::Value* one) { return l.isVector(i) ? l.broadcast(one) : one; };
    require(l.b.CreateICmpSGE(last, l.integer(l.int32(), 0)));
    require(l.b.CreateICmpULE(l.b.CreateSub(i, like(least)), like(last)));
  }
  return isInside;
}

/// The element number at an index in each lane, minus the counter; invariant in the loop.
llvm::Value* Streams::laneOffsets(std::uint32_t param, const Parts& index, llvm::Value* counter) {
  llvm::Value* const x = l.value(index[0]);
  llvm::Value* offsets = l.broadcast(l.b.CreateSub(x, l.isVector(x) ? l.broadcast(counter) : counter));
  for (std::size_t d = 1; d < index.size(); ++d) {
    llvm::Value* i = l.value(index[d]);
    if (kernel_.params[param].boundary == Boundary::Clamp) {
      const auto like = [&](llvm::Value* one) { return l.isVector(i) ? l.broadcast(one) : one; };
      llvm::Value* const end = l.b.CreateTrunc(high(param, d), l.int32());
      llvm::Value* const most = l.b.CreateSub(end, l.integer(l.int32(), 1));
      llvm::Value* const least = l.b.CreateTrunc(low(param, d), l.int32());
      i = l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smin, i, like(most));
      i = l.b.CreateBinaryIntrinsic(llvm::Intrinsic::smax, i, like(least));
    }
    llvm::Value* const stride =
        l.b.CreateTrunc(argumentExtent(param, d, offsetof(Argument, stride)), l.int32());
    offsets =
        l.b.CreateAdd(offsets, l.broadcast(l.b.CreateMul(i, l.isVector(i) ? l.broadcast(stride) : stride)));
  }
  return offsets;
}

/// Loads a block of elements from each lane's address on and stores it transposed. Handles the lanes of one
/// register at a time, so that few rows compete for the cache's ways.
void Streams::storeTransposed(llvm::Type* element, const std::vector<llvm::Value*>& addresses,
                              llvm::Value* block) const {
  llvm::Type* const four = llvm::FixedVectorType::get(element, 4);
  const llvm::Align align(element->getPrimitiveSizeInBits() / 8);
  const std::uint32_t width = l.options().blockWidth;
  for (std::uint32_t group = 0; group < l.count(); group += width) {
    for (std::uint32_t first = 0; first < blockLength; first += 4) {
      std::array<llvm::Value*, 4> rows{};
      for (std::uint32_t i = 0; i < 4; ++i) {
        std::vector<llvm::Value*> segments;
        for (std::uint32_t lane = group + i; lane < group + width; lane += 4) {
          llvm::Value* const address = l.at(element, addresses[lane], l.integer(l.int64(), first));
          segments.push_back(l.b.CreateAlignedLoad(four, address, align));
        }
        rows[i] = concatenate(l, std::move(segments));
      }
      const std::array<llvm::Value*, 4> transposed = transposeSegments(l, rows);
      for (std::uint32_t i = 0; i < 4; ++i) {
        llvm::Value* const to = l.integer(l.int64(), (first + i) * l.count() + group);
        l.b.CreateAlignedStore(transposed[i], l.at(element, block, to), llvm::Align(4 * width));
      }
    }
  }
}

Streams::Block Streams::readBlock(std::uint32_t param, const Parts& index, llvm::Value* counter) {
  llvm::BasicBlock& entry = l.b.GetInsertBlock()->getParent()->getEntryBlock();
  llvm::IRBuilder<> allocas(&entry, entry.begin());
  llvm::Value* const offsets = laneOffsets(param, index, counter);
  llvm::Value* const start = argumentField(param, offsetof(Argument, first), l.int64());
  llvm::Value* const first = l.b.CreateSExt(counter, l.int64());
  Block block{param, {}};
  for (std::size_t c = 0; c < scalars(param).size(); ++c) {
    llvm::Type* const element = l.stored(scalars(param)[c]);
    std::vector<llvm::Value*> addresses;
    for (std::uint32_t lane = 0; lane < l.count(); ++lane) {
      llvm::Value* const offset = l.b.CreateSExt(l.lane(offsets, lane), l.int64());
      llvm::Value* const row = l.at(element, component(param, c), l.b.CreateAdd(start, offset));
      addresses.push_back(l.at(element, row, first));
    }
    block.components.push_back(
        allocas.CreateAlloca(llvm::ArrayType::get(l.vector(element), blockLength), nullptr, "block"));
    storeTransposed(element, addresses, block.components.back());
  }
  return block;
}

Parts Streams::elementOf(const Block& block, llvm::Value* number) {
  Parts element;
  for (std::size_t c = 0; c < block.components.size(); ++c) {
    const Scalar scalar = scalars(block.param)[c];
    llvm::Type* const type = l.vector(l.stored(scalar));
    element.push_back({l.b.CreateLoad(type, l.at(type, block.components[c], number))});
  }
  return element;
}

}  // namespace skc::native
