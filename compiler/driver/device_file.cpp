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
  constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();
  const nlohmann::json& limit = limits.at(name);
  const std::uint64_t number = limit.is_number_unsigned() ? limit.get<std::uint64_t>() : 0;
  if (number < atLeast || number > most) {
    throw std::out_of_range(fmt::format("{} is {}, but every device has {} or more", name,
                                        limit.is_number() ? limit.dump() : limit.type_name(), atLeast));
  }
  return static_cast<std::uint32_t>(number);
}

}  // namespace

std::vector<MeasuredDevice> readDevices(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(fmt::format("'{}' cannot be read: {}", file, std::strerror(errno)));
  std::vector<MeasuredDevice> devices;
  const auto fail = [&](const std::exception& error) {
    return std::runtime_error(
        fmt::format("'{}' is not what sk info --json={} writes: {}", file, file, error.what()));
  };
  try {
    const nlohmann::json written = nlohmann::json::parse(in);
    for (const nlohmann::json& device : written.at("devices")) {
      const auto limits = device.find("limits");
      if (limits == device.end() || !limits->contains("draw_buffers")) continue;
      devices.push_back({device.at("name").get<std::string>(),
                         {limitOf(*limits, "draw_buffers", least.drawBuffers),
                          limitOf(*limits, "texture_units", least.textureUnits)}});
    }
  } catch (const nlohmann::json::exception& error) {
    throw fail(error);
  } catch (const std::out_of_range& error) {
    throw fail(error);
  }
  if (devices.empty()) {
    throw std::runtime_error(fmt::format("'{}' has no device that draws; write it where there is one", file));
  }
  return devices;
}

}  // namespace skc::driver
