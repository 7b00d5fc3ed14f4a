// SPDX-License-Identifier: MIT
#include "support/host_memory.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <sk/sk.hpp>

namespace examples {

std::optional<std::int64_t> availableMemory() { return sk::Device::native().availableMemory(); }

void requireMemory(std::string_view what, double bytes) {
  constexpr double unasked = 1 << 24;  // always there, and not worth the question
  if (bytes < unasked) return;
  const std::optional<std::int64_t> available = availableMemory();
  if (available && bytes > static_cast<double>(*available))
    throw std::runtime_error(fmt::format("{} takes about {:.3g} GB of memory, and {:.3g} GB are available",
                                         what, bytes * 1e-9, static_cast<double>(*available) * 1e-9));
}

}  // namespace examples
