// SPDX-License-Identifier: MIT
#include "driver/device_file.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace skc::driver {

namespace {

/// What every device that runs kernels guarantees (ES 3.0).
constexpr ir::Limits least{.drawBuffers = 4, .textureUnits = 16};

/// Throws std::out_of_range if the limit is missing or too small.
std::uint32_t limitOf(const nlohmann::json& limits, const char* name, std::uint32_t atLeast) {
  const auto limit = limits.at(name).get<std::int64_t>();
  if (limit < atLeast || limit > std::numeric_limits<std::int32_t>::max()) {
    throw std::out_of_range(fmt::format("{} is {}, but every device has {} or more", name, limit, atLeast));
  }
  return static_cast<std::uint32_t>(limit);
}

}  // namespace

std::vector<MeasuredDevice> readDevices(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("'{}' cannot be read: {}", file, std::strerror(errno)));
  std::vector<MeasuredDevice> devices;
  try {
    const nlohmann::json written = nlohmann::json::parse(in);
    for (const nlohmann::json& device : written.at("devices")) {
      const nlohmann::json limits = device.value("limits", nlohmann::json());
      if (!limits.contains("draw_buffers")) continue;
      devices.push_back({device.at("name").get<std::string>(),
                         {limitOf(limits, "draw_buffers", least.drawBuffers),
                          limitOf(limits, "texture_units", least.textureUnits)}});
    }
  } catch (const std::exception& error) {   // a JSON error, or a limit out of range
    throw std::runtime_error(
        fmt::format("'{}' is not what sk info --json={} writes: {}", file, file, error.what()));
  }
  if (devices.empty()) {
    throw std::runtime_error(fmt::format("'{}' has no device that draws; write it where there is one", file));
  }
  return devices;
}

}  // namespace skc::driver
