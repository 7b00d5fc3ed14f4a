// SPDX-License-Identifier: MIT
#include "text/memory.hpp"

#include <cstdint>
#include <optional>

#include <fmt/format.h>
#include <sk/device.hpp>
#include <sk/error.hpp>

namespace sk::text {

void requireMemory(std::string_view what, double bytes) {
  constexpr double unasked = 1 << 24;  // always there, and not worth the question
  if (bytes < unasked) return;
  const std::optional<std::int64_t> available = sk::Device::native().availableMemory();
  if (available && bytes > static_cast<double>(*available))
    throw sk::Error(fmt::format("{} takes about {:.3g} GB of memory, and {:.3g} GB are available", what,
                                bytes * 1e-9, static_cast<double>(*available) * 1e-9),
                    sk::Error::Kind::Memory);
}

}  // namespace sk::text
