// SPDX-License-Identifier: MIT
#include "support/host_memory.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <sk/sk.hpp>

namespace examples {

std::optional<std::int64_t> availableMemory() { return sk::Device::native().availableMemory(); }

void requireMemoryForGrid(const sk::Device& device, std::string_view size, std::int64_t cells,
                          const BytesPerCell& need, int ranks) {
  const auto require = [&](std::string_view place, double bytesPerCell,
                           std::optional<std::int64_t> available) {
    constexpr double unasked = 1 << 24;
    // Fields are read, written and drawn through copies: 1.2 to 1.7 times the need was measured with lattices, flows and waves.
    constexpr double copies = 1.5;
    bytesPerCell *= copies;
    const double bytes = bytesPerCell * static_cast<double>(cells);
    if (bytes < unasked || !available || bytes <= static_cast<double>(*available)) return;
    throw std::runtime_error(
        fmt::format("{} cells take about {:.3g} GB of memory, and {} has {:.3g} GB available; take at most "
                    "{:.2g} cells, with --size",
                    size, bytes * 1e-9, place, static_cast<double>(*available) * 1e-9,
                    static_cast<double>(*available) / bytesPerCell));
  };
  const double onDevice = need.device / ranks;
  if (device.profile() == "native" || device.isSoftware())
    return require("the host", onDevice + need.host, device.availableMemory());
  require(device.name(), onDevice, device.availableMemory());
  require("the host", need.host, availableMemory());
}

}  // namespace examples
