// SPDX-License-Identifier: MIT
//
// All information about a device as one JSON object, which is cached, printed for programs, and formatted for
// people. docs/accuracy.md explains its entries.
#pragma once

#include <nlohmann/json.hpp>

#include "sk/device.hpp"

namespace sk_tool {

using Json = nlohmann::ordered_json;

/// The properties that a device reports: "name", "driver" ..., and its "limits". Measures nothing.
Json describe(const sk::Device& device);

/// Adds the kind of the device and what the runtime assumes of it, which the configuration file may change.
void addTraits(const sk::Device& device, Json& info);

/// Adds what must be measured, which takes some seconds.
void measure(sk::Device& device, Json& info);

/// Identifies what measurements depend on.
std::string keyOf(const sk::Device& device);

/// Options that open the same device again, for probes that change a device's state.
sk::DeviceOptions optionsOf(const sk::Device& device);

}  // namespace sk_tool
