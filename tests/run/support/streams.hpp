// SPDX-License-Identifier: MIT
//
// Streams that are made of what they hold.
#pragma once

#include <cstdint>
#include <vector>

#include "sk/sk.hpp"

namespace run_tests {

/// A stream with these elements; without a shape, of rank 1.
template <class T>
sk::Stream<T> streamOf(sk::Device& device, const std::vector<T>& values, sk::Shape shape = {},
                       sk::Storage storage = sk::Storage::Default) {
  auto stream = device.stream<T>(
      shape.rank() == 0 ? sk::Shape{static_cast<std::int64_t>(values.size())} : shape, storage);
  stream.write(values);
  return stream;
}

}  // namespace run_tests
