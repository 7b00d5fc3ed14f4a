// SPDX-License-Identifier: MIT
//
// How native loops become fast: marks for compilers. All that the function around a kernel's loops calls becomes part of it, and
// there is a clone of it for each generation of CPUs, of which the program's loader takes the best that this one runs. They
// round alike: nothing is contracted. Vectors of 512 bits have none: loops that wait for memory gain nothing by them, and
// each clone takes as long to compile again.
#pragma once

#include <cstdint>  // which tells of the C library

#if defined(SK_NATIVE_PLAIN)  // by those who would rather compile sooner than run faster
#define SK_NATIVE_HOT
#elif defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SK_NATIVE_HOT __attribute__((flatten, target_clones("default", "arch=x86-64-v3")))
#elif defined(__GNUC__)
#define SK_NATIVE_HOT __attribute__((flatten))
#else
#define SK_NATIVE_HOT
#endif

/// The same for code that makes sense with vectors of 256 bits alone: without a clone for CPUs that have none (isWide()).
#if defined(SK_NATIVE_PLAIN) || !defined(__GNUC__)
#define SK_NATIVE_WIDE
#elif defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define SK_NATIVE_WIDE __attribute__((flatten, target("arch=x86-64-v3")))
#else
#define SK_NATIVE_WIDE __attribute__((flatten))
#endif

/// Whether what is marked SK_NATIVE_WIDE multiplies and adds in one operation, where this CPU runs it.
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA) ||                                               \
    (!defined(SK_NATIVE_PLAIN) && defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && \
     !defined(__clang__) && !defined(__SANITIZE_ADDRESS__))
#define SK_NATIVE_FUSES true
#else
#define SK_NATIVE_FUSES false
#endif

/// Without the clones.
#if defined(__GNUC__) && !defined(SK_NATIVE_PLAIN)
#define SK_NATIVE_INLINED __attribute__((flatten))
#else
#define SK_NATIVE_INLINED
#endif

/// Before a loop whose rounds may be computed in any order: none reads what another one writes.
#if defined(__clang__)
#define SK_NATIVE_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define SK_NATIVE_INDEPENDENT _Pragma("GCC ivdep")
#else
#define SK_NATIVE_INDEPENDENT
#endif

namespace sk::native {

/// Whether this CPU runs what is marked SK_NATIVE_WIDE.
inline bool isWide() {
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
  return __builtin_cpu_supports("x86-64-v3") != 0;
#else
  return true;
#endif
}

}  // namespace sk::native
