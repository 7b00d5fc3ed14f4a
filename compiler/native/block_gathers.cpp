// SPDX-License-Identifier: MIT
//
// Reads gathers in blocks (block_gathers.hpp): each lane loads consecutive elements of its row, and a
// transpose turns these into one vector per iteration. It transposes 4 x 4 elements at a time, which every
// CPU can do within 128 bits of a register.
#include "native/block_gathers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>

#include <llvm/IR/Constants.h>
#include <llvm/IR/Intrinsics.h>

#include "ir/build.hpp"
#include "ir/counted_loop.hpp"
#include "ir/lvalue.hpp"
#include "ir/op_weight.hpp"
#include "ir/walk.hpp"
#include "native/leaves.hpp"
#include "native/streams.hpp"

namespace skc::native {

using namespace ir;
using analysis::Shape;
using analysis::Uniformity;
using sk::native::Argument;

namespace {

/// The largest body that is emitted twice.
constexpr std::uint32_t mostExpressions = 100;
constexpr std::size_t mostComponents = 4;

class LoopGathers {
 public:
  LoopGathers(const Module& module, const Kernel& kernel, const Uniformity& uniformity, FunctionId function,
              const Loop& loop)
      : module_(module), kernel_(kernel), uniformity_(uniformity), function_(function), loop_(loop) {}

  std::vector<BlockGather> find() {
    const std::optional<VarId> counter = findCounter();
    if (!counter) return {};
    counter_ = *counter;
    walkStmts(loop_.body, [&](const Stmt& stmt) {
      if (const auto* n = std::get_if<Declare>(&stmt.node)) declared_[n->var] = n->init.get();
    });
    std::vector<BlockGather> found;
    std::size_t components = 0;
    walkExprs(loop_.body, [&](const Expr& expr) {
      const auto* read = std::get_if<GatherRead>(&expr.node);
      if (read == nullptr || !holdsWords(*read) || !isScattered(*read->index)) return;
      ExprPtr index = beforeBody(*read->index);
      if (!advances(*index)) return;
      components += componentCount(module_, expr.type);
      found.push_back({&expr, std::move(index)});
    });
    if (components > mostComponents) return {};
    return found;
  }

 private:
  /// The uniform variable that the loop's step increments by one, if the body does not assign it.
  std::optional<VarId> findCounter() const {
    if (loop_.kind != LoopKind::For || loop_.step.size() != 1) return std::nullopt;
    const auto* step = std::get_if<Assign>(&loop_.step.front().node);
    if (step == nullptr || step->op != BinaryOp::Add) return std::nullopt;
    const auto* stepped = std::get_if<VarRef>(&step->place->node);
    const auto* by = std::get_if<Literal>(&step->value->node);
    if (stepped == nullptr || by == nullptr || by->bits != 1) return std::nullopt;
    const Type type = step->place->type;
    const bool isUniform = uniformity_.of(function_, *step->place) == Shape::Uniform;
    if (!type.isScalar() || !type.isInteger() || !isUniform || assigns(module_, loop_.body, stepped->var))
      return std::nullopt;
    return stepped->var;
  }

  /// True if all components of an element take 32 bits.
  bool holdsWords(const GatherRead& read) const {
    const std::vector<Scalar> scalars = scalarsOf(module_, kernel_.params[read.stream.id].type);
    return std::ranges::all_of(scalars, [](Scalar scalar) {
      return scalar == Scalar::Float || scalar == Scalar::Int || scalar == Scalar::Uint;
    });
  }

  /// True if lanes read neither the same element nor consecutive ones.
  bool isScattered(const Expr& index) const {
    const std::vector<Shape> shapes = uniformity_.leavesOf(function_, index);
    const bool isRow =
        std::all_of(shapes.begin() + 1, shapes.end(), [](Shape shape) { return shape == Shape::Uniform; });
    return shapes[0] == Shape::Varying || !isRow;
  }

  /// Replaces variables that the body declares and never reassigns by their initial values.
  ExprPtr beforeBody(const Expr& expr) {
    ExprPtr result = clone(expr);
    rewriteExprs(result, [&](ExprPtr& slot) {
      const auto* n = std::get_if<VarRef>(&slot->node);
      if (n == nullptr) return;
      const auto declared = declared_.find(n->var);
      if (declared == declared_.end() || declared->second == nullptr || assigns(module_, loop_.body, n->var))
        return;
      if (replaced_++ < mostExpressions) slot = beforeBody(*declared->second);
    });
    return result;
  }

  bool isInvariant(const Expr& expr) const {
    bool is = true;
    walkExprs(expr, [&](const Expr& inner) {
      const auto* n = std::get_if<VarRef>(&inner.node);
      if (n == nullptr) return;
      is = is && n->var != counter_ && !declared_.contains(n->var) && !assigns(module_, loop_.body, n->var);
    });
    return is;
  }

  /// True if an integer grows by one in each iteration: it is the counter, plus or minus invariant values.
  bool growsByOne(const Expr& expr) const {
    if (!expr.type.isScalar() || !expr.type.isInteger()) return false;
    if (const auto* n = std::get_if<VarRef>(&expr.node)) return n->var == counter_;
    if (const auto* n = std::get_if<Convert>(&expr.node)) return growsByOne(*n->operand);
    const auto* n = std::get_if<Binary>(&expr.node);
    if (n == nullptr) return false;
    if (n->op == BinaryOp::Sub) return growsByOne(*n->lhs) && isInvariant(*n->rhs);
    if (n->op != BinaryOp::Add) return false;
    return (growsByOne(*n->lhs) && isInvariant(*n->rhs)) || (isInvariant(*n->lhs) && growsByOne(*n->rhs));
  }

  /// True if x grows by one in each iteration and the other indices are invariant.
  bool advances(const Expr& index) const {
    if (index.type.isScalar()) return growsByOne(index);
    const auto* n = std::get_if<Construct>(&index.node);
    if (n == nullptr || n->args.size() < 2 || !growsByOne(*n->args.front())) return false;
    return std::all_of(n->args.begin() + 1, n->args.end(),
                       [&](const ExprPtr& arg) { return isInvariant(*arg); });
  }

  const Module& module_;
  const Kernel& kernel_;
  const Uniformity& uniformity_;
  FunctionId function_;
  const Loop& loop_;
  VarId counter_ = 0;
  std::map<VarId, const Expr*> declared_;  ///< variables of the body; initial values or null
  std::size_t replaced_ = 0;
};

}  // namespace

std::vector<BlockGather> blockGathers(const Module& module, const Kernel& kernel,
                                      const Uniformity& uniformity, FunctionId function, const Loop& loop) {
  const std::optional<std::int64_t> iterations = tripCount(module, loop);
  if (iterations && *iterations < Streams::blockLength) return {};
  std::vector<BlockGather> found = LoopGathers(module, kernel, uniformity, function, loop).find();
  // a body with a loop weighs as much as the limit
  if (weigh(module, loop.body, {.node = 1}, mostExpressions + 1) > mostExpressions) found.clear();
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
