// SPDX-License-Identifier: MIT
//
// Sizes that users choose, in 64 bits and without overflow: the only place that converts elements to bytes,
// and the errors for exhausted host memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "sk/error.hpp"

namespace sk {

/// The product of two nonnegative numbers; nullopt if it does not fit in 63 bits.
constexpr std::optional<std::int64_t> checkedProduct(std::int64_t a, std::int64_t b) {
  if (b != 0 && a > std::numeric_limits<std::int64_t>::max() / b) return std::nullopt;
  return a * b;
}

/// The exception of `allocated` (native/memory.hpp), with the number of bytes that was requested.
class NoMemory : public std::bad_alloc {
 public:
  explicit NoMemory(std::size_t bytes) : bytes_(bytes) {}
  const char* what() const noexcept override { return "sk::NoMemory"; }
  std::size_t bytes() const { return bytes_; }

 private:
  std::size_t bytes_;
};

/// The bytes of `count` elements. Throws NoMemory, with the largest number of bytes, if they do not fit in 63
/// bits.
inline std::size_t bytesOf(std::int64_t count, std::size_t elementBytes) {
  const std::optional<std::int64_t> bytes = checkedProduct(count, static_cast<std::int64_t>(elementBytes));
  if (!bytes) throw NoMemory(std::numeric_limits<std::size_t>::max());
  return static_cast<std::size_t>(*bytes);
}

/// Resizes a vector whose size a user chooses. Throws NoMemory.
template <class Vector>
void resizeChecked(Vector& vector, std::size_t count) {
  try {
    vector.resize(count);
  } catch (const std::bad_alloc&) {
    throw NoMemory(count * sizeof(typename Vector::value_type));
  }
}

/// A number of bytes as in messages: "12 bytes", "48 KiB", "3 MiB".
std::string bytesText(std::int64_t bytes);

/// Throws sk::Error: the host is out of memory for `what`.
[[noreturn]] void failForHostMemory(std::string_view what, const std::bad_alloc& error);
/// Throws an error again. If it is one of exhausted memory, its text begins with `what` then.
[[noreturn]] void failNaming(std::string_view what, const Error& error);

/// Calls fn(), the operation `what`. Throws sk::Error if it runs out of host memory. If memory of any kind is exhausted, the
/// error names the operation.
template <class Fn>
decltype(auto) withHostMemory(std::string_view what, Fn&& fn) {
  try {
    return fn();
  } catch (const std::bad_alloc& error) {
    failForHostMemory(what, error);
  } catch (const Error& error) {
    failNaming(what, error);
  }
}

}  // namespace sk
