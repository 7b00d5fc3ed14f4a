// SPDX-License-Identifier: MIT
#include "support/checked_size.hpp"

#include <fmt/format.h>

#include "sk/error.hpp"
#include "sk/host_vector.hpp"

namespace sk {

void failForHostMemory(std::string_view what, const std::bad_alloc& error) {
  if (const auto* known = dynamic_cast<const NoMemory*>(&error)) {
    throw Error(fmt::format("{}: there is no host memory for {} bytes", what, known->bytes()),
                Error::Kind::Memory);
  }
  throw Error(fmt::format("{}: there is not enough host memory", what), Error::Kind::Memory);
}

void detail::failForElements(std::size_t count, std::size_t elementBytes) {
  throw Error(
      fmt::format("there is no host memory for {} element(s) of {} byte(s) each", count, elementBytes),
      Error::Kind::Memory);
}

}  // namespace sk
