// SPDX-License-Identifier: MIT
//
// All information about a device as one JSON object, which is cached, printed for programs, and formatted for people.
// docs/accuracy.md explains its entries. The measurements are one function per entry of the object. Each runs kernels on
// the device and compares the results with the host's in double. All use fixed seeds and medians of times, so that figures
// of different runs agree.
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

/// Whether the device does not use GL, to which some questions do not apply.
bool isNative(const sk::Device& device);

Json probeProcessor();  ///< "processor": for native devices
Json probeAllocations(sk::Device& device);  ///< "allocates"
Json probeOperations(sk::Device& device);  ///< "operations": + - * / sqrt fma
Json probeContraction(sk::Device& device);  ///< "contraction": of a * b + c, and what fma is
Json probeOwnOperations(sk::Device& device);  ///< "own_operations": whether kernels compute what is written
Json probeFunctions(sk::Device& device);  ///< "functions"
Json probeSpecialValues(sk::Device& device);  ///< "special_values"
Json probeExactSums(sk::Device& device);  ///< "exact_sums"
Json probeHalfStores(sk::Device& device);  ///< "half_stores"
Json probeFilter(sk::Device& device);  ///< "filter"
Json probeIndices(sk::Device& device);  ///< "indices"
Json probeDoubles(sk::Device& device);  ///< "doubles"
Json probeCosts(sk::Device& device);  ///< "costs"

}  // namespace sk_tool
