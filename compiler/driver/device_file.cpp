// SPDX-License-Identifier: MIT
#include "driver/device_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace skc::driver {

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
                         {limits.at("draw_buffers").get<std::uint32_t>(),
                          limits.at("texture_units").get<std::uint32_t>()}});
    }
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(
        fmt::format("'{}' is not what sk info --json={} writes: {}", file, file, error.what()));
  }
  if (devices.empty()) {
    throw std::runtime_error(fmt::format("'{}' has no device that draws; write it where there is one", file));
  }
  return devices;
}

}  // namespace skc::driver
