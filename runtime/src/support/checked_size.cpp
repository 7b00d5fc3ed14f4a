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

std::string bytesText(std::int64_t bytes) {
  if (bytes < 1 << 14) return fmt::format("{} bytes", bytes);
  return bytes < 1 << 24 ? fmt::format("{} KiB", bytes >> 10) : fmt::format("{} MiB", bytes >> 20);
}

void failForHostMemory(std::string_view what, const std::bad_alloc& error) {
  failWith([&] {
    const auto* known = dynamic_cast<const NoMemory*>(&error);
    return known == nullptr ? fmt::format("{}: there is not enough host memory", what)
                            : fmt::format("{}: there is no host memory for {} bytes", what, known->bytes());
  });
}

void failNaming(std::string_view what, const Error& error) {
  const std::string_view text = error.what();
  const bool isNamed = text.starts_with(what) && text.substr(what.size()).starts_with(':');
  if (error.kind() == Error::Kind::Memory && !isNamed)
    failWith([&] { return fmt::format("{}: {}", what, text); });
  throw Error(error);
}

void detail::failForElements(std::size_t count, std::size_t elementBytes, const char* what) {
  failWith([&] {
    return fmt::format("{}{}there is no host memory for {} element(s) of {} byte(s) each", what,
                       *what == '\0' ? "" : ": ", count, elementBytes);
  });
}

}  // namespace sk
