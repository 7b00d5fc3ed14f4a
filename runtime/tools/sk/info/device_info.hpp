// SPDX-License-Identifier: MIT
//
// All that is found out about a device, as one JSON object: what is kept, printed for programs, and told to people.
// docs/accuracy.md says what its entries mean.
#pragma once

#include <nlohmann/json.hpp>

#include "sk/device.hpp"

namespace sk_tool {

using Json = nlohmann::ordered_json;

/// What a device says of itself: "name", "driver" ..., and its "limits". Measures nothing.
Json describe(const sk::Device& device);

/// Adds what has to be measured, in some seconds.
void measure(sk::Device& device, Json& info);

/// What measurements depend on, in words.
std::string keyOf(const sk::Device& device);

/// The same device once more, for what leaves traces in one.
sk::DeviceOptions optionsOf(const sk::Device& device);

}  // namespace sk_tool
