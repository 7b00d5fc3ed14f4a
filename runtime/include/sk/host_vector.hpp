// SPDX-License-Identifier: MIT
//
// Allocates host memory for elements that API functions return.
#pragma once

#include <cstddef>
#include <new>
#include <stdexcept>
#include <vector>

namespace sk::detail {

[[noreturn]] void failForElements(std::size_t count, std::size_t elementBytes, const char* what);

/// Allocates `count` elements. Throws sk::Error, with the operation `what` in front, if the host is out of memory.
template <class E>
std::vector<E> hostVector(std::size_t count, const char* what = "") {
  try {
    return std::vector<E>(count);
  } catch (const std::bad_alloc&) {
    failForElements(count, sizeof(E), what);
  } catch (const std::length_error&) {
    failForElements(count, sizeof(E), what);
  }
}

}  // namespace sk::detail
