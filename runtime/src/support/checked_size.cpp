// SPDX-License-Identifier: MIT
#include "support/checked_size.hpp"

#include <fmt/format.h>

#include "sk/error.hpp"
#include "sk/host_vector.hpp"

namespace sk {

namespace {

/// Created while there is memory: copying an Error does not allocate.
const Error noMemory("there is not enough host memory", Error::Kind::Memory);

/// Throws an Error with the result of `text`, or without it if there is no memory for it either.
template <class Text>
[[noreturn]] void failWith(Text&& text) {
  try {
    throw Error(text(), Error::Kind::Memory);
  } catch (const std::bad_alloc&) {
    throw Error(noMemory);
  }
}

}  // namespace

void failForHostMemory(std::string_view what, const std::bad_alloc& error) {
  failWith([&] {
    const auto* known = dynamic_cast<const NoMemory*>(&error);
    return known == nullptr ? fmt::format("{}: there is not enough host memory", what)
                            : fmt::format("{}: there is no host memory for {} bytes", what, known->bytes());
  });
}

void detail::failForElements(std::size_t count, std::size_t elementBytes) {
  failWith([&] {
    return fmt::format("there is no host memory for {} element(s) of {} byte(s) each", count, elementBytes);
  });
}

}  // namespace sk
