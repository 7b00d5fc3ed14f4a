// SPDX-License-Identifier: MIT
//
// The measurements, one function per entry of the JSON object. Each runs kernels on the device and compares
// the results with the host's in double. All use fixed seeds and medians of times, so that figures of
// different runs agree.
#pragma once

#include "info/device_info.hpp"

namespace sk_tool {

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
