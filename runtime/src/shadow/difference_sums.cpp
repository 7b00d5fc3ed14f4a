// SPDX-License-Identifier: MIT
#include "shadow/difference_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "native/float_vectors.hpp"
#include "sk/native/code.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#endif

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
  sums.mayFlush = sums.mayFlush || (d == 0 && o != 0);
}

/// For CPUs without vectors of four doubles, and for the elements that fill no vector.
void addEach(const double* d, const double* o, const double* r, std::int64_t count, DifferenceSums& sums) {
  for (std::int64_t i = 0; i < count; ++i) addOne(d[i], o[i], r[i], sums);
}

#if defined(__x86_64__) && defined(__GNUC__)

#define SK_FOR_V4 [[gnu::target("arch=x86-64-v4")]]

template <class Vector>
double sumOf(const Vector& x) {
  double values[sizeof x / sizeof(double)];
  std::memcpy(values, &x, sizeof x);
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

template <class Vector>
double largestOf(const Vector& x) {
  double values[sizeof x / sizeof(double)];
  std::memcpy(values, &x, sizeof x);
  return *std::ranges::max_element(values);
}

/// The sums of vectors of eight doubles. GCC 12 warns about those functions of immintrin.h that have undefined lanes.
SK_FOR_V4 DifferenceSums addVectorsOfEight(const double* d, const double* o, const double* r,
                                           std::int64_t count) {
  const __m512d zero = _mm512_setzero_pd();
  __m512d reference2 = zero, own2 = zero, inherited2 = zero, total2 = zero, largestOwn = zero;
  unsigned flushes = 0;
  std::int64_t i = 0;
  for (; i + 8 <= count; i += 8) {
    const __m512d device = _mm512_loadu_pd(d + i), given = _mm512_loadu_pd(o + i),
                  reference = _mm512_loadu_pd(r + i);
    const __m512d own = device - given, inherited = given - reference, total = device - reference;
    reference2 = _mm512_fmadd_pd(reference, reference, reference2);
    own2 = _mm512_fmadd_pd(own, own, own2);
    inherited2 = _mm512_fmadd_pd(inherited, inherited, inherited2);
    total2 = _mm512_fmadd_pd(total, total, total2);
    largestOwn = _mm512_maskz_max_pd(0xFF, largestOwn, _mm512_abs_pd(own));
    const __mmask8 zeros = _mm512_cmp_pd_mask(device, zero, _CMP_EQ_OQ);
    flushes |= _mm512_mask_cmp_pd_mask(zeros, given, zero, _CMP_NEQ_UQ);
  }
  DifferenceSums sums{.reference2 = sumOf(reference2),
                      .own2 = sumOf(own2),
                      .inherited2 = sumOf(inherited2),
                      .total2 = sumOf(total2),
                      .largestOwn = largestOf(largestOwn),
                      .mayFlush = flushes != 0};
  _mm256_zeroupper();  // before a local function, GCC 12 leaves it out, and other code then runs at half its speed
  addEach(d + i, o + i, r + i, count - i, sums);
  return sums;
}

/// The sums of vectors of four doubles.
SK_FOR_V3 DifferenceSums addVectorsOfFour(const double* d, const double* o, const double* r,
                                          std::int64_t count) {
  const __m256d zero = _mm256_setzero_pd(), sign = _mm256_set1_pd(-0.0);
  __m256d reference2 = zero, own2 = zero, inherited2 = zero, total2 = zero, largestOwn = zero, flushes = zero;
  std::int64_t i = 0;
  for (; i + 4 <= count; i += 4) {
    const __m256d device = _mm256_loadu_pd(d + i), given = _mm256_loadu_pd(o + i),
                  reference = _mm256_loadu_pd(r + i);
    const __m256d own = _mm256_sub_pd(device, given), inherited = _mm256_sub_pd(given, reference),
                  total = _mm256_sub_pd(device, reference);
    reference2 = _mm256_fmadd_pd(reference, reference, reference2);
    own2 = _mm256_fmadd_pd(own, own, own2);
    inherited2 = _mm256_fmadd_pd(inherited, inherited, inherited2);
    total2 = _mm256_fmadd_pd(total, total, total2);
    largestOwn = _mm256_max_pd(largestOwn, _mm256_andnot_pd(sign, own));
    const __m256d zeros = _mm256_cmp_pd(device, zero, _CMP_EQ_OQ);
    flushes = _mm256_or_pd(flushes, _mm256_and_pd(zeros, _mm256_cmp_pd(given, zero, _CMP_NEQ_UQ)));
  }
  DifferenceSums sums{.reference2 = sumOf(reference2),
                      .own2 = sumOf(own2),
                      .inherited2 = sumOf(inherited2),
                      .total2 = sumOf(total2),
                      .largestOwn = largestOf(largestOwn),
                      .mayFlush = _mm256_movemask_pd(flushes) != 0};
  _mm256_zeroupper();  // before a local function, GCC 12 leaves it out, and other code then runs at half its speed
  addEach(d + i, o + i, r + i, count - i, sums);
  return sums;
}

#endif

}  // namespace

DifferenceSums addDifferences(const double* d, const double* o, const double* r, std::int64_t count) {
#if defined(__x86_64__) && defined(__GNUC__)
  switch (native::levelOfHardware()) {
    case native::Level::V4: return addVectorsOfEight(d, o, r, count);
    case native::Level::V3: return addVectorsOfFour(d, o, r, count);
    case native::Level::Base: break;
  }
#endif
  DifferenceSums sums;
  addEach(d, o, r, count, sums);
  return sums;
}

}  // namespace sk::shadow
