// SPDX-License-Identifier: MIT
//
// The stable order of unsigned keys: a radix sort from the least significant digit, on threads.
#pragma once

#include <cstdint>
#include <vector>

namespace sk {

/// The numbers of the keys, in the order of the keys; equal keys keep their order. Consumes the keys. There are at
/// most 2^31 - 1. The result does not depend on the number of threads.
std::vector<std::int32_t> radixOrder(std::vector<std::uint32_t>&& keys);
std::vector<std::int32_t> radixOrder(std::vector<std::uint64_t>&& keys);

}  // namespace sk
