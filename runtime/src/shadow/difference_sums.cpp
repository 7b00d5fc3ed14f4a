// SPDX-License-Identifier: MIT
#include "shadow/difference_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "native/float_vectors.hpp"
#include "sk/native/code.hpp"

namespace sk::shadow {

bool DifferenceSums::isFinite() const { return std::isfinite(reference2 + own2 + inherited2 + total2); }

namespace {

void addOne(double d, double o, double r, DifferenceSums& sums) {
  const double own = d - o, inherited = o - r, total = d - r;
  sums.reference2 += r * r;
  sums.own2 += own * own;
  sums.inherited2 += inherited * inherited;
  sums.total2 += total * total;
  sums.largestOwn = std::max(sums.largestOwn, std::fabs(own));
  sums.largestTotal = std::max(sums.largestTotal, std::fabs(total));
  sums.mayFlush = sums.mayFlush || (d == 0 && o != 0);
}

/// For CPUs without vectors of four doubles, and for the elements that fill no vector.
void addEach(const double* d, const double* o, const double* r, std::int64_t count, DifferenceSums& sums) {
  for (std::int64_t i = 0; i < count; ++i) addOne(d[i], o[i], r[i], sums);
}

#if defined(__x86_64__) && defined(__GNUC__)

/// One vector of each sum. There are few enough of them for the registers.
struct VectorSums {
  Doubles reference2{}, own2{}, inherited2{}, total2{}, largestOwn{}, largestTotal{};
  Words flushes{};

  SK_FOR_V3 void add(const double* d, const double* o, const double* r) {
    Doubles device, given, reference;
    std::memcpy(&device, d, sizeof device);
    std::memcpy(&given, o, sizeof given);
    std::memcpy(&reference, r, sizeof reference);
    const Doubles own = device - given, inherited = given - reference, total = device - reference;
    addProduct(reference, reference, reference2);
    addProduct(own, own, own2);
    addProduct(inherited, inherited, inherited2);
    addProduct(total, total, total2);
    raise(own, largestOwn);
    raise(total, largestTotal);
    flushes |= (device == 0) & (given != 0);
  }
  SK_FOR_V3 static void raise(const Doubles& difference, Doubles& largest) {
    const Words magnitude = __builtin_bit_cast(Words, difference) & INT64_MAX;
    const Doubles size = __builtin_bit_cast(Doubles, magnitude);
    largest = size > largest ? size : largest;
  }
  SK_FOR_V3 static double sum(const Doubles& x) { return (x[0] + x[1]) + (x[2] + x[3]); }
  SK_FOR_V3 static double largest(const Doubles& x) {
    return std::max(std::max(x[0], x[1]), std::max(x[2], x[3]));
  }
  SK_FOR_V3 DifferenceSums all() const {
    return {.reference2 = sum(reference2),
            .own2 = sum(own2),
            .inherited2 = sum(inherited2),
            .total2 = sum(total2),
            .largestOwn = largest(largestOwn),
            .largestTotal = largest(largestTotal),
            .mayFlush = (flushes[0] | flushes[1] | flushes[2] | flushes[3]) != 0};
  }
};

SK_FOR_V3 DifferenceSums addVectors(const double* d, const double* o, const double* r, std::int64_t count) {
  VectorSums vectors;
  std::int64_t i = 0;
  for (; i + doublesPerVector <= count; i += doublesPerVector) vectors.add(d + i, o + i, r + i);
  DifferenceSums sums = vectors.all();
  addEach(d + i, o + i, r + i, count - i, sums);
  return sums;
}

SK_FOR_V3 void widenVectors(const float* from, std::int64_t count, double* to) {
  std::int64_t i = 0;
  for (; i + doublesPerVector <= count; i += doublesPerVector) {
    Doubles wide;
    widen(from + i, wide);
    std::memcpy(to + i, &wide, sizeof wide);
  }
  for (; i < count; ++i) to[i] = from[i];
}

bool hasVectors() { return native::levelOfHardware() >= native::Level::V3; }

#endif

}  // namespace

DifferenceSums addDifferences(const double* d, const double* o, const double* r, std::int64_t count) {
#if defined(__x86_64__) && defined(__GNUC__)
  if (hasVectors()) return addVectors(d, o, r, count);
#endif
  DifferenceSums sums;
  addEach(d, o, r, count, sums);
  return sums;
}

void widenFloats(const float* from, std::int64_t count, double* to) {
#if defined(__x86_64__) && defined(__GNUC__)
  if (hasVectors()) return widenVectors(from, count, to);
#endif
  std::copy_n(from, count, to);
}

}  // namespace sk::shadow
