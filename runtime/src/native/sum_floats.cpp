// SPDX-License-Identifier: MIT
#include "native/sum_floats.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include "native/components.hpp"
#include "native/float_vectors.hpp"
#include "native/fold_program.hpp"
#include "native/scan_blocks.hpp"
#include "support/rounds_as_written.hpp"

namespace sk {

namespace {

using native::Chunk;
using native::Frame;

constexpr std::int64_t scannedTogether = 2 * doublesPerVector;

/// The sum of each element and those before it. -0 changes no sum.
[[gnu::always_inline]] inline void sumsOf(Doubles& x) {
  constexpr Doubles nothing{-0.0, -0.0, -0.0, -0.0};
  x += __builtin_shufflevector(x, nothing, 4, 0, 1, 2);
  x += __builtin_shufflevector(x, nothing, 4, 5, 0, 1);
}

/// Scans eight terms from `carry` on, which becomes the sum of all. In an exclusive scan, the sums are those before each.
template <bool isExclusive>
[[gnu::always_inline]] inline void scanEight(Doubles& first, Doubles& second, Doubles& carry) {
  sumsOf(first);
  sumsOf(second);
  second += __builtin_shufflevector(first, first, 3, 3, 3, 3);
  const Doubles before = carry;
  carry += __builtin_shufflevector(second, second, 3, 3, 3, 3);
  first += before;
  second += before;
  if constexpr (isExclusive) {
    second = __builtin_shufflevector(first, second, 3, 4, 5, 6);
    first = __builtin_shufflevector(before, first, 3, 4, 5, 6);
  }
}

/// How CPUs with 256-bit vectors read terms and store sums.
struct WideVectors {
  SK_FOR_V3 static void read(Doubles& terms, std::int64_t i, const float* x) { widen(x + i, terms); }
  SK_FOR_V3 static void read(Doubles& terms, std::int64_t i, const float* x, const float* y) {
    Doubles other;
    widen(x + i, terms);
    widen(y + i, other);
    terms *= other;
  }
  SK_FOR_V3 static void store(const Doubles& sums, double* to) { std::memcpy(to, &sums, sizeof sums); }
  SK_FOR_V3 static void store(const Doubles& sums, float* to) { narrow(sums, to); }
};

/// How others do.
struct AnyVectors {
  template <class... Factors>
  static void read(Doubles& terms, std::int64_t i, const Factors*... factors) {
    for (int lane = 0; lane < doublesPerVector; ++lane) terms[lane] = (double{factors[i + lane]} * ...);
  }
  template <class Result>
  static void store(const Doubles& sums, Result* to) {
    for (int lane = 0; lane < doublesPerVector; ++lane) to[lane] = static_cast<Result>(sums[lane]);
  }
};

/// The last terms, fewer than eight, and -0 behind them.
template <class... Factors>
[[gnu::always_inline]] inline void readLast(double* terms, std::int64_t i, std::int64_t count,
                                            const Factors*... factors) {
  std::fill_n(terms, scannedTogether, -0.0);
  for (std::int64_t k = 0; i + k < count; ++k) terms[k] = (double{factors[i + k]} * ...);
}

/// All terms are read before the sums of their places are stored, which may be in the same array.
template <class Vectors, bool isExclusive, class Result, class... Factors>
[[gnu::always_inline]] inline double scanAll(double start, std::int64_t count, Result* results,
                                             const Factors*... factors) {
  Doubles carry{start, start, start, start}, first, second;
  std::int64_t i = 0;
  for (; i + scannedTogether <= count; i += scannedTogether) {
    Vectors::read(first, i, factors...);
    Vectors::read(second, i + doublesPerVector, factors...);
    scanEight<isExclusive>(first, second, carry);
    Vectors::store(first, results + i);
    Vectors::store(second, results + i + doublesPerVector);
  }
  if (i < count) {
    double terms[scannedTogether];
    Result sums[scannedTogether];
    readLast(terms, i, count, factors...);
    std::memcpy(&first, terms, sizeof first);
    std::memcpy(&second, terms + doublesPerVector, sizeof second);
    scanEight<isExclusive>(first, second, carry);
    AnyVectors::store(first, sums);
    AnyVectors::store(second, sums + doublesPerVector);
    std::copy_n(sums, count - i, results + i);
  }
  return carry[0];
}

template <bool isExclusive, class Result, class... Factors>
SK_FOR_V3 double scanWide(double start, std::int64_t count, Result* results, const Factors*... factors) {
  return scanAll<WideVectors, isExclusive>(start, count, results, factors...);
}
template <bool isExclusive, class Result, class... Factors>
double scanAny(double start, std::int64_t count, Result* results, const Factors*... factors) {
  return scanAll<AnyVectors, isExclusive>(start, count, results, factors...);
}

template <bool isWide, class Result, class... Factors>
double scan(double start, bool isExclusive, std::int64_t count, Result* results, const Factors*... factors) {
  if constexpr (isWide) {
    return isExclusive ? scanWide<true>(start, count, results, factors...)
                       : scanWide<false>(start, count, results, factors...);
  } else {
    return isExclusive ? scanAny<true>(start, count, results, factors...)
                       : scanAny<false>(start, count, results, factors...);
  }
}

template <std::size_t factors, class Result, bool isWide>
void scanTerms(const Frame* frame, const Chunk* chunk, void* const* state, void* const* results,
               std::int64_t starts, std::int64_t isExclusive) {
  const auto& sums = *static_cast<const SumFrame*>(frame);
  double& carry = *static_cast<double*>(state[0]);
  auto* const to = static_cast<Result*>(results[0]);
  const auto* const x = static_cast<const float*>(chunk->arrays[0]);
  const double start = starts != 0 ? sums.start : carry;
  if constexpr (factors == 1) {
    carry = scan<isWide>(start, isExclusive != 0, chunk->count, to, x);
  } else {
    const auto* const y = static_cast<const float*>(chunk->arrays[1]);
    carry = scan<isWide>(start, isExclusive != 0, chunk->count, to, x, y);
  }
  if (starts != 0 && isExclusive != 0) to[0] = static_cast<Result>(sums.identity);
}

template <class Result, bool isWide>
native::ScanFunction* scanOf(std::size_t factors) {
  return factors == 1 ? &scanTerms<1, Result, isWide> : &scanTerms<2, Result, isWide>;
}

}  // namespace

native::ScanFunction* floatScan(std::size_t factors, bool storesFloats, bool isWide) {
  if (isWide) return storesFloats ? scanOf<float, true>(factors) : scanOf<double, true>(factors);
  return storesFloats ? scanOf<float, false>(factors) : scanOf<double, false>(factors);
}

void storeIdentity(const Frame* frame, void* const* values) {
  *static_cast<double*>(values[0]) = static_cast<const SumFrame*>(frame)->identity;
}

FactorKernel::FactorKernel(const program::Kernel& fold, std::span<const std::uint8_t> factors,
                           const native::Call& call)
    : call_(call) {
  for (const std::uint8_t parameter : factors) {
    operands_.push_back(call.operands[parameter]);
    operands_.back().holdsFloats = false;  // read as floats, without widening
    parameters_.push_back(fold.parameters[parameter]);
    const auto number = static_cast<std::uint8_t>(slots_.size());
    slots_.push_back({.parameter = number, .row = {}, .reach = 0, .isOutput = 0});
  }
  call_.operands = operands_;
  code_.slots = slots_.data();
  code_.slotCount = static_cast<std::uint32_t>(slots_.size());
  kernel_.parameters = parameters_;
  kernel_.code = &code_;
}

}  // namespace sk

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

namespace sk {

namespace {

using native::Level;

/// The columns of a leaf: sideOf() for one double.
constexpr std::int64_t side = 32;

/// How many elements ahead to prefetch. Converting elements takes so many operations that otherwise few loads
/// are in flight at once.
constexpr std::int64_t fetchedAhead = 384;

template <class... Factors>
double termAt(std::int64_t i, const Factors*... factors) {
  return (double{factors[i]} * ...);
}

SK_FOR_V3 void addTerm(Doubles& sum, std::int64_t i, const float* x) {
  Doubles wide;
  widen(x + i, wide);
  addProduct(wide, Doubles{1, 1, 1, 1}, sum);
}
SK_FOR_V3 void addTerm(Doubles& sum, std::int64_t i, const float* x, const float* y) {
  Doubles first, second;
  widen(x + i, first);
  widen(y + i, second);
  addProduct(first, second, sum);
}

/// How many doubles the code for a CPU adds together.
enum class Width { One, Four, Eight };

#if defined(__x86_64__) && defined(__GNUC__)
/// Marks functions that are called only on CPUs of x86-64-v4.
#define SK_FOR_V4 [[gnu::target("arch=x86-64-v4")]]

/// GCC 12 warns about the intrinsic without a mask.
SK_FOR_V4 inline __m512d widenEight(const float* at) {
  return _mm512_maskz_cvtps_pd(static_cast<__mmask8>(0xff), _mm256_loadu_ps(at));
}
SK_FOR_V4 inline void addEight(__m512d& sum, std::int64_t i, const float* x) {
  sum = _mm512_add_pd(widenEight(x + i), sum);
}
/// The product is exact, so that there is one rounding, fused or not.
SK_FOR_V4 inline void addEight(__m512d& sum, std::int64_t i, const float* x, const float* y) {
  sum = _mm512_fmadd_pd(widenEight(x + i), widenEight(y + i), sum);
}

/// Sums a leaf of whole columns, on CPUs with 512-bit vectors: in half the operations that 256 bits take.
template <class... Factors>
SK_FOR_V4 void sumWideLeaf(double* columns, double start, std::int64_t rounds, const Factors*... factors) {
  constexpr std::int64_t vectors = side / 8;
  __m512d sums[vectors];
#pragma GCC unroll 16
  for (__m512d& sum : sums) sum = _mm512_set1_pd(start);
  for (std::int64_t round = 0; round < rounds; ++round) {
    const std::int64_t first = round * side;
    for (std::int64_t ahead = 0; ahead < side; ahead += 16) {
      (__builtin_prefetch(factors + first + ahead + fetchedAhead), ...);
    }
#pragma GCC unroll 16
    for (std::int64_t v = 0; v < vectors; ++v) addEight(sums[v], first + v * 8, factors...);
  }
  std::memcpy(columns, sums, sizeof sums);
}
#endif

/// Sums a leaf of whole columns, on CPUs with 256-bit vectors.
template <class... Factors>
SK_FOR_V3 void sumLeaf(double* columns, double start, std::int64_t rounds, const Factors*... factors) {
  constexpr std::int64_t vectors = side / doublesPerVector;
  Doubles sums[vectors];
#pragma GCC unroll 16
  for (Doubles& sum : sums) sum = Doubles{start, start, start, start};
  for (std::int64_t round = 0; round < rounds; ++round) {
    const std::int64_t first = round * side;
    for (std::int64_t ahead = 0; ahead < side; ahead += 16) {
      (__builtin_prefetch(factors + first + ahead + fetchedAhead), ...);
    }
#pragma GCC unroll 16
    for (std::int64_t v = 0; v < vectors; ++v) addTerm(sums[v], first + v * doublesPerVector, factors...);
  }
  std::memcpy(columns, sums, sizeof sums);
}

template <class... Factors>
void sumAny(double* columns, std::int64_t count, std::int64_t rounds, const Factors*... factors) {
  for (std::int64_t round = 0; round < rounds; ++round) {
    for (std::int64_t k = 0; k < count; ++k) columns[k] += termAt(round * count + k, factors...);
  }
}

/// The parameters of a fold other than its chunk and its state.
struct Division {
  std::int64_t columns, rounds, leaves, starts;
};

template <Width width, class... Factors>
void sum(const Frame* frame, double* sums, const Division& division, const Factors*... factors) {
  const double start = static_cast<const SumFrame*>(frame)->start;
  const auto [columns, rounds, leaves, starts] = division;
  std::int64_t reversed = 0;
  for (std::int64_t leaf = 0; leaf < leaves; ++leaf, reversed = nextReversed(reversed, leaves)) {
    double* const own = sums + reversed * columns;
    const std::int64_t first = leaf * rounds * columns;
    if (width != Width::One && columns == side && starts != 0) {
#if defined(__x86_64__) && defined(__GNUC__)
      if constexpr (width == Width::Eight) {
        sumWideLeaf(own, start, rounds, factors + first...);
        continue;
      }
#endif
      sumLeaf(own, start, rounds, factors + first...);
      continue;
    }
    if (starts != 0) std::fill_n(own, columns, start);
    sumAny(own, columns, rounds, factors + first...);
  }
}

/// The floats of a factor.
const float* factorOf(const Chunk* chunk, std::size_t number) {
  return static_cast<const float*>(chunk->arrays[number]);
}

template <Width width>
void sumOfOne(const Frame* frame, const Chunk* chunk, void* const* state, std::int64_t columns,
              std::int64_t rounds, std::int64_t leaves, std::int64_t starts) {
  sum<width>(frame, static_cast<double*>(state[0]), {columns, rounds, leaves, starts}, factorOf(chunk, 0));
}
template <Width width>
void sumOfProducts(const Frame* frame, const Chunk* chunk, void* const* state, std::int64_t columns,
                   std::int64_t rounds, std::int64_t leaves, std::int64_t starts) {
  sum<width>(frame, static_cast<double*>(state[0]), {columns, rounds, leaves, starts}, factorOf(chunk, 0),
             factorOf(chunk, 1));
}

/// The widest functions that run on this CPU.
Width widthOfCpu() {
#if defined(__x86_64__) && defined(__GNUC__)
  if (levelOfCpu() >= Level::V3) return levelOfCpu() >= Level::V4 ? Width::Eight : Width::Four;
#endif
  return Width::One;
}
/// True if the functions for 256-bit vectors run on this CPU.
bool hasWideVectors() { return widthOfCpu() != Width::One; }

template <Width width>
native::FoldFunction* sumOf(std::size_t factors) {
  return factors == 1 ? &sumOfOne<width> : &sumOfProducts<width>;
}
native::FoldFunction* sumOf(std::size_t factors) {
  switch (widthOfCpu()) {
    case Width::One: break;
    case Width::Four: return sumOf<Width::Four>(factors);
    case Width::Eight: return sumOf<Width::Eight>(factors);
  }
  return sumOf<Width::One>(factors);
}

void addColumns(const Frame*, void* const* state, void* const* later, std::int64_t columns) {
  auto* const sums = static_cast<double*>(state[0]);
  const auto* const others = static_cast<const double*>(later[0]);
  for (std::int64_t k = 0; k < columns; ++k) sums[k] += others[k];
}
/// Adds whole vectors, on CPUs with 256-bit vectors.
SK_FOR_V3 void addVectors(const Frame*, void* const* state, void* const* later, std::int64_t columns) {
  auto* const sums = static_cast<double*>(state[0]);
  const auto* const others = static_cast<const double*>(later[0]);
  for (std::int64_t k = 0; k < columns; k += doublesPerVector) {
    Doubles sum, other;
    std::memcpy(&sum, sums + k, sizeof sum);
    std::memcpy(&other, others + k, sizeof other);
    sum += other;
    std::memcpy(sums + k, &sum, sizeof sum);
  }
}

Bound<native::CombineFunction> combination() {
  if (hasWideVectors()) return {&addVectors, doublesPerVector, nullptr};
  return {&addColumns, 1, nullptr};
}

double identityOf(const program::Reduction& reduction, const CodeFrame& frame, const CodeChoice& choice) {
  double identity = 0;
  void* const values[] = {&identity};
  const native::Entry& entry = entryOf(reduction.fold, native::EntryKind::Identity, choice);
  functionOf<native::ValuesFunction>(entry)(frame.get(), values);
  return identity;
}

}  // namespace

bool sumsFloats(const program::Reduction& reduction, const native::Call& fold, const CodeChoice& choice) {
  const auto& factors = reduction.term.factors;
  return choice.real == RealType::Double && !factors.empty() &&
         std::ranges::all_of(factors, [&](std::uint8_t i) { return fold.operands[i].holdsFloats; });
}

void sumFloats(const program::Reduction& reduction, const native::ReduceCall& call,
               const CodeChoice& choice) {
  const FactorKernel term(reduction.fold, reduction.term.factors, call.fold);
  const CodeFrame frame(term.kernel(), term.call());
  const double identity = identityOf(reduction, CodeFrame(reduction.fold, call.fold), choice);
  const SumFrame sumFrame{*frame.get(), reduction.seeded ? -0.0 : identity, identity};
  const SlotLayout layout(term.kernel(), term.call(), frame, {.real = RealType::Float});
  const StateShape shape({sizeof(double)});
  const FoldResults results(reduction.fold.parameters, call.fold.operands, shape);
  const std::size_t factors = reduction.term.factors.size();
  const FoldProgram program{.layout = layout,
                            .shape = shape,
                            .fold = {sumOf(factors), 1, &sumFrame},
                            .combine = combination(),
                            .isCommutative = true,
                            .isUneven = false,
                            .first = call.fold.computed().first};
  if (!call.scan) {
    foldBlocks(program, call.fold.computed().extent, call.block, results);
    return;
  }
  const bool storesFloats = results.areRoundedRows();
  const Bound<native::ScanFunction> scan{floatScan(factors, storesFloats, hasWideVectors()), 1, &sumFrame};
  const ScanProgram scanProgram{program, scan, &storeIdentity, call.scan->isExclusive, false, storesFloats};
  scanBlocks(scanProgram, call.fold.domain, call.block, results);
}

}  // namespace sk
