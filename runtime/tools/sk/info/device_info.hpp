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

/// A device as drivers have it, whatever the environment says of limits and doubles.
sk::DeviceOptions plainOptions(const std::string& device, const std::string& profile = {});

}  // namespace sk_tool
