// SPDX-License-Identifier: MIT
//
// Tests reductions with hand-written object code. They fold every element once and in order. The order in
// which partial results are computed and combined, which must never change for an application, is that of a
// recorded run.
#include "native/fold_code.hpp"

#include <cstring>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "native/fold_state.hpp"
#include "native/object_code_test.hpp"

namespace sk::test {
namespace {

using native::Chunk;
using native::EntryKind;
using native::Extents;
using native::Frame;
using native::Operand;
using program::Boundary;
using program::Role;

/// Calls fold(column, round, element number) for all elements of a fold, in whole groups of columns.
template <class Fold>
void forAll(std::int64_t columns, std::int64_t rounds, std::int64_t leaves, Fold&& fold) {
  std::int64_t reversed = 0;
  for (std::int64_t leaf = 0; leaf < leaves; ++leaf, reversed = nextReversed(reversed, leaves)) {
    const std::int64_t first = reversed * columns;
    for (std::int64_t round = 0; round < rounds; ++round) {
      const std::int64_t element = (leaf * rounds + round) * columns;
      for (std::int64_t k = 0; k < inGroups(columns); ++k) fold(first + k, round, element + k);
    }
  }
}

void sumFold(const Frame*, const Chunk* chunk, void* const* state, std::int64_t columns, std::int64_t rounds,
             std::int64_t leaves, std::int64_t starts) {
  auto* total = static_cast<float*>(state[0]);
  const auto* x = arrayOf<float>(chunk, 0);
  forAll(columns, rounds, leaves, [&](std::int64_t k, std::int64_t round, std::int64_t i) {
    total[k] = (starts != 0 && round == 0 ? 0 : total[k]) + x[i];
  });
}
void sumCombine(const Frame*, void* const* state, void* const* later, std::int64_t columns) {
  for (std::int64_t k = 0; k < inGroups(columns); ++k) {
    static_cast<float*>(state[0])[k] += static_cast<float*>(later[0])[k];
  }
}

void orderFold(const Frame*, const Chunk* chunk, void* const* state, std::int64_t columns,
               std::int64_t rounds, std::int64_t leaves, std::int64_t starts) {
  auto* last = static_cast<float*>(state[0]);
  const auto* x = arrayOf<float>(chunk, 0);
  forAll(columns, rounds, leaves, [&](std::int64_t k, std::int64_t round, std::int64_t i) {
    last[k] = starts != 0 && round == 0 ? x[i] : last[k] * 0.75F + x[i];
  });
}
void orderCombine(const Frame*, void* const* state, void* const* later, std::int64_t columns) {
  for (std::int64_t k = 0; k < inGroups(columns); ++k) {
    float& last = static_cast<float*>(state[0])[k];
    last = last * 0.75F + static_cast<float*>(later[0])[k];
  }
}

void pairFold(const Frame*, const Chunk* chunk, void* const* state, std::int64_t columns, std::int64_t rounds,
              std::int64_t leaves, std::int64_t starts) {
  auto* total = static_cast<float*>(state[0]);
  auto* last = static_cast<float*>(state[1]);
  const auto* x = arrayOf<float>(chunk, 0);
  forAll(columns, rounds, leaves, [&](std::int64_t k, std::int64_t round, std::int64_t i) {
    const bool isNew = starts != 0 && round == 0;
    total[k] = (isNew ? 0 : total[k]) + x[i];
    last[k] = x[i] + 0.5F * (isNew ? 1 : last[k]);
  });
}
void pairCombine(const Frame*, void* const* state, void* const* later, std::int64_t columns) {
  for (std::int64_t k = 0; k < inGroups(columns); ++k) {
    static_cast<float*>(state[0])[k] += static_cast<float*>(later[0])[k];
    float& last = static_cast<float*>(state[1])[k];
    last = static_cast<float*>(later[1])[k] + 0.5F * last;
  }
}

template <class Real>
void zero(const Frame*, void* const* values) {
  *static_cast<Real*>(values[0]) = 0;
}

/// A reduction of floats.
struct TestReduction {
  TestKernel fold, combine;
  program::Reduction reduction{};

  TestReduction(int inputs, int accumulators, bool isCommutative) {
    for (int i = 0; i < inputs; ++i) fold.add(Role::Input);
    for (int i = 0; i < 3; ++i) combine.add(Role::Uniform);  // never read
    for (int i = 0; i < inputs; ++i) fold.slot(static_cast<std::uint8_t>(i));
    for (int i = 0; i < accumulators; ++i) fold.add(Role::Accumulator);
    reduction.commutative = isCommutative;
  }
  const program::Reduction& finish() {
    reduction.fold = fold.finish();
    reduction.combine = combine.finish();
    return reduction;
  }
};

struct Shaped {
  Extents domain, block;
};

/// Blocks of every kind: of one piece and several, of whole rows and parts of rows, with remainders, and
/// narrow.
const Shaped shapes[] = {
    {{1, 1, 1, 1}, {1, 1, 1, 1}},         {{63, 1, 1, 1}, {63, 1, 1, 1}},
    {{1100, 1, 1, 1}, {1100, 1, 1, 1}},   {{200003, 1, 1, 1}, {200003, 1, 1, 1}},
    {{30, 50, 1, 1}, {30, 50, 1, 1}},     {{100, 700, 1, 1}, {100, 700, 1, 1}},
    {{37, 9, 5, 3}, {37, 9, 5, 3}},       {{1093, 20, 1, 1}, {1093, 1, 1, 1}},
    {{20000, 3, 1, 1}, {20000, 1, 1, 1}}, {{333, 70, 1, 1}, {1, 70, 1, 1}},
    {{1000, 40, 1, 1}, {2, 2, 1, 1}},     {{1200, 33, 2, 1}, {4, 3, 2, 1}},
    {{5000, 2, 1, 1}, {8, 1, 1, 1}},      {{90, 60, 1, 1}, {30, 20, 1, 1}},
};

Extents blocksOf(const Shaped& shape) {
  Extents blocks;
  for (std::size_t d = 0; d < 4; ++d) blocks[d] = shape.domain[d] / shape.block[d];
  return blocks;
}

std::int64_t sizeOf(const Extents& extents) { return extents[0] * extents[1] * extents[2] * extents[3]; }

enum class Lie { Dense, Strided, Repeated, InRows };

struct Reduced {
  int inputs = 1;
  int results = 1;
  std::size_t resultBytes = sizeof(float);
  bool holdsFloats = false;
};

/// The bytes of all results.
template <class Reduce>
std::vector<std::vector<std::byte>> results(const Reduced& what, const Shaped& shape, Lie lie,
                                            Reduce&& reduce) {
  const Extents blocks = blocksOf(shape);
  std::vector<std::vector<float>> inputs;
  for (int i = 0; i < what.inputs; ++i) {
    inputs.push_back(someFloats(3 * sizeOf(shape.domain) + 100 * shape.domain[1] * shape.domain[2], i + 1));
    for (float& x : inputs.back()) x *= 0.123F;  // so that sums round
  }
  std::vector<std::vector<std::byte>> outputs(
      static_cast<std::size_t>(what.results),
      std::vector<std::byte>(static_cast<std::size_t>(sizeOf(blocks)) * what.resultBytes));
  TestOperands operands;
  for (std::vector<float>& input : inputs) {
    Operand& operand = operands.add(input, shape.domain);
    operand.holdsFloats = what.holdsFloats;
    if (lie == Lie::Strided) operand.multiply = {3, 1, 1, 1};
    if (lie == Lie::Repeated) operand.multiply[0] = 0;
    if (lie == Lie::InRows) operand.stride[1] += 9;
  }
  for (auto& output : outputs) operands.add(output, blocks);
  const std::vector<Operand> ofCombine(3);
  reduce(native::ReduceCall{operands.call(shape.domain), {ofCombine, {1, 1, 1, 1}, {}}, shape.block});
  return outputs;
}

/// A hash (FNV-1a) of the results for all shapes and all layouts of the inputs.
std::uint64_t hashOfResults(const Reduced& what, const program::Reduction& reduction, RealType real) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const Shaped& shape : shapes) {
    for (const Lie lie : {Lie::Dense, Lie::Strided, Lie::Repeated, Lie::InRows}) {
      const auto all = results(what, shape, lie, [&](const native::ReduceCall& call) {
        foldCode(reduction, call, {.real = real});
      });
      for (const std::vector<std::byte>& bytes : all) {
        for (const std::byte byte : bytes)
          hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3;
      }
    }
  }
  return hash;
}

TEST_CASE("sums of floats have the bits that they had") {
  TestReduction sum(1, 1, true);
  sum.fold.entries = {entry(EntryKind::Fold, &sumFold)};
  sum.combine.entries = {entry(EntryKind::Combine, &sumCombine)};
  CHECK(hashOfResults({}, sum.finish(), RealType::Float) == 0x69a4f8dae40135f2);
}

TEST_CASE("folds in order have the bits that they had") {
  TestReduction order(1, 1, false);
  order.fold.entries = {entry(EntryKind::Fold, &orderFold)};
  order.combine.entries = {entry(EntryKind::Combine, &orderCombine)};
  CHECK(hashOfResults({}, order.finish(), RealType::Float) == 0xd3979e1d495c7279);
}

TEST_CASE("two accumulators have the bits that they had") {
  TestReduction pair(1, 2, true);
  pair.fold.entries = {entry(EntryKind::Fold, &pairFold)};
  pair.combine.entries = {entry(EntryKind::Combine, &pairCombine)};
  CHECK(hashOfResults({.results = 2}, pair.finish(), RealType::Float) == 0x49cf21b90f1c1fd5);
}

TEST_CASE("sums of floats in doubles have the bits that they had") {
  TestReduction sum(1, 1, true);
  sum.fold.entries = {entry(EntryKind::Identity, &zero<double>, native::Real::Double)};
  const std::uint8_t factors[] = {0};
  sum.reduction.term = {.factors = factors};
  const Reduced what{.resultBytes = sizeof(double), .holdsFloats = true};
  CHECK(hashOfResults(what, sum.finish(), RealType::Double) == 0x189f3009a23a7222);
}

TEST_CASE("sums of products of floats in doubles have the bits that they had") {
  TestReduction dot(2, 1, true);
  dot.fold.entries = {entry(EntryKind::Identity, &zero<double>, native::Real::Double)};
  const std::uint8_t factors[] = {0, 1};
  dot.reduction.term = {.factors = factors};
  const Reduced what{.inputs = 2, .resultBytes = sizeof(double), .holdsFloats = true};
  CHECK(hashOfResults(what, dot.finish(), RealType::Double) == 0xe5aeee984fc80e82);
}

TEST_CASE("identities are stored where there is no element, in arrays of their own type") {
  TestReduction sum(1, 1, true);
  sum.fold.entries = {entry(EntryKind::Identity, &zero<float>)};
  std::vector<float> x, r{5};
  TestOperands operands;
  operands.add(x, {0, 1, 1, 1});
  operands.add(r, {1, 1, 1, 1});
  storeIdentities(sum.finish(), operands.call({0, 1, 1, 1}), {});
  CHECK(r[0] == 0);
}

// ---- folds that use indices and neighbours --------------------------------------------------------

/// Sums x * (1 + its index), the neighbour to the right of each element, and five times the one below it, modulo 2^32.
void placeFold(const Frame*, const Chunk* chunk, void* const* state, std::int64_t columns,
               std::int64_t rounds, std::int64_t leaves, std::int64_t starts) {
  auto* total = static_cast<std::uint32_t*>(state[0]);
  const auto* x = arrayOf<float>(chunk, 0);

  forAll(columns, rounds, leaves, [&](std::int64_t k, std::int64_t round, std::int64_t i) {
    const std::int64_t index = chunk->first[0] + i * chunk->step + 1000 * chunk->first[1];
    auto term = static_cast<std::uint32_t>(static_cast<std::int64_t>(x[i]) * (1 + index));
    term += static_cast<std::uint32_t>(static_cast<std::int64_t>(arrayOf<float>(chunk, 1)[i + 1]));
    term += 5 * static_cast<std::uint32_t>(static_cast<std::int64_t>(arrayOf<float>(chunk, 2)[i]));
    total[k] = (starts != 0 && round == 0 ? 0 : total[k]) + term;
  });
}
void addWords(const Frame*, void* const* state, void* const* later, std::int64_t columns) {
  for (std::int64_t k = 0; k < inGroups(columns); ++k) {
    static_cast<std::uint32_t*>(state[0])[k] += static_cast<std::uint32_t*>(later[0])[k];
  }
}

TEST_CASE("a fold knows the index and the neighbours of each element, in blocks of every shape") {
  const Boundary boundary = GENERATE(Boundary::Clamp, Boundary::Wrap);
  TestKernel fold, combine;
  fold.add(Role::Input);
  program::Parameter& gather = fold.add(Role::Gather);
  gather.rank = 2;
  gather.usesNear = true;
  gather.boundary = boundary;
  fold.add(Role::Accumulator, intElement);
  fold.slot(0);
  fold.slot(1, 1);
  fold.slot(1, 0, 1);
  fold.entries = {entry(EntryKind::Fold, &placeFold)};
  combine.entries = {entry(EntryKind::Combine, &addWords)};
  program::Reduction reduction{};
  reduction.commutative = true;
  reduction.fold = fold.finish();
  reduction.combine = combine.finish();
  for (const Shaped& shape : shapes) {
    if (shape.domain[2] > 1) continue;
    const Extents blocks = blocksOf(shape);
    std::vector<float> x = someFloats(sizeOf(shape.domain));
    std::vector<std::uint32_t> r(static_cast<std::size_t>(sizeOf(blocks))), expected(r.size());
    TestOperands operands;
    operands.add(x, shape.domain);
    operands.add(x, shape.domain);
    operands.add(r, blocks);
    foldCode(reduction, {operands.call(shape.domain), {{}, {1, 1, 1, 1}, {}}, shape.block}, {});
    for (std::int64_t row = 0; row < shape.domain[1]; ++row) {
      for (std::int64_t i = 0; i < shape.domain[0]; ++i) {
        const auto inside = [&](std::int64_t k, std::int64_t extent) {
          return boundary == Boundary::Wrap ? k % extent : std::min(k, extent - 1);
        };
        const auto at = [&](std::int64_t k, std::int64_t y) {
          return static_cast<std::int64_t>(x[static_cast<std::size_t>(
              inside(y, shape.domain[1]) * shape.domain[0] + inside(k, shape.domain[0]))]);
        };
        expected[static_cast<std::size_t>(row / shape.block[1] * blocks[0] + i / shape.block[0])] +=
            static_cast<std::uint32_t>(at(i, row) * (1 + i + 1000 * row) + at(i + 1, row) +
                                       5 * at(i, row + 1));
      }
    }
    CAPTURE(shape.domain[0], shape.domain[1], shape.block[0], shape.block[1]);
    CHECK(r == expected);
  }
}

}  // namespace
}  // namespace sk::test
