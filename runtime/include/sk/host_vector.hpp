// SPDX-License-Identifier: MIT
//
// Host memory for the elements that functions of the API return.
#pragma once

#include <cstddef>
#include <new>
#include <stdexcept>
#include <vector>

namespace sk::detail {

[[noreturn]] void failForElements(std::size_t count, std::size_t elementBytes);

/// `count` elements. Throws sk::Error where the host has no memory for them.
template <class E>
std::vector<E> hostVector(std::size_t count) {
  try {
    return std::vector<E>(count);
  } catch (const std::bad_alloc&) {
    failForElements(count, sizeof(E));
  } catch (const std::length_error&) {
    failForElements(count, sizeof(E));
  }
}

}  // namespace sk::detail
