// SPDX-License-Identifier: MIT
//
// Loops over elements, one instantiation for each size that is copied, so that copies are moves.
#include "element_packing.hpp"

#include <cstdint>
#include <cstring>

namespace sk {

namespace {

using program::Element;
using program::Field;
using program::Scalar;

/// Calls `loop` with the number of components as a constant.
template <class Loop>
void withWidth(int width, Loop loop) {
  switch (width) {
    case 1: loop(std::integral_constant<std::size_t, 1>{}); return;
    case 2: loop(std::integral_constant<std::size_t, 2>{}); return;
    case 3: loop(std::integral_constant<std::size_t, 3>{}); return;
    default: loop(std::integral_constant<std::size_t, 4>{}); return;
  }
}

constexpr std::size_t channelsOf(std::size_t width) { return width == 3 ? 4 : width; }

/// Copies `Width` components of 4 bytes, or bools, from one place to another.
template <std::size_t Width>
void copyWords(const std::byte* from, std::byte* to) {
  std::memcpy(to, from, 4 * Width);
}

template <std::size_t Width>
void copyBools(const std::byte* from, std::byte* to) {
  for (std::size_t c = 0; c < Width; ++c) {
    to[c] = std::byte{from[c] != std::byte{0}};
  }
}

}  // namespace

bool areTexels(const Element& element) {
  const Field& field = element.fields[0];
  return element.fields.size() == 1 && field.scalar != Scalar::Bool && field.width != 3 &&
         field.offset == 0 && element.size == 4u * field.width;
}

void packTexels(const Element& element, const Field& field, const std::byte* elements, std::size_t count,
                std::byte* texels) {
  const std::byte* from = elements + field.offset;
  withWidth(field.width, [&](auto widthConstant) {
    constexpr std::size_t width = widthConstant;
    constexpr std::size_t channels = channelsOf(width);
    if (field.scalar == Scalar::Bool) {
      std::memset(texels, 0, count * channels);
      for (std::size_t i = 0; i < count; ++i) {
        copyBools<width>(from + i * element.size, texels + i * channels);
      }
    } else {
      if constexpr (width == 3) {
        std::memset(texels, 0, count * channels * 4);
      }
      for (std::size_t i = 0; i < count; ++i) {
        copyWords<width>(from + i * element.size, texels + i * channels * 4);
      }
    }
  });
}

void unpackTexels(const Element& element, const Field& field, const std::byte* texels, std::size_t count,
                  std::byte* elements) {
  std::byte* to = elements + field.offset;
  withWidth(field.width, [&](auto widthConstant) {
    constexpr std::size_t width = widthConstant;
    constexpr std::size_t channels = channelsOf(width);
    if (field.scalar == Scalar::Bool) {
      for (std::size_t i = 0; i < count; ++i) {
        copyBools<width>(texels + i * channels, to + i * element.size);
      }
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        copyWords<width>(texels + i * channels * 4, to + i * element.size);
      }
    }
  });
}

void narrowTexels(const gl::Format& format, const std::byte* wide, std::size_t count, std::byte* tight) {
  withWidth(format.tight.channels, [&](auto channelsConstant) {
    constexpr std::size_t channels = channelsConstant;
    for (std::size_t i = 0; i < count; ++i) {
      const std::byte* from = wide + i * format.wide.texelBytes();
      if (format.tight.channelBytes == 4) {
        copyWords<channels>(from, tight + i * channels * 4);
        continue;
      }
      for (std::size_t c = 0; c < channels; ++c) {
        std::uint32_t value = 0;
        std::memcpy(&value, from + 4 * c, sizeof value);
        tight[i * channels + c] = static_cast<std::byte>(value);
      }
    }
  });
}

}  // namespace sk
