// SPDX-License-Identifier: MIT
//
// The loops over elements are instantiated for each size of field, so that each copy compiles to moves.
#include "gl_device/memory/element_packing.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "sk/narrow.hpp"

namespace sk {

namespace {

using program::Element;
using program::Field;

/// Calls loop(bytes, texelBytes) with the sizes of a field and of its texel as constants.
template <class Loop>
void withBytes(const Field& field, Loop loop) {
  const auto call = [&]<std::size_t Bytes, std::size_t TexelBytes>() {
    loop(std::integral_constant<std::size_t, Bytes>{}, std::integral_constant<std::size_t, TexelBytes>{});
  };
  switch (gl::hostBytes(field)) {
    case 1: return call.template operator()<1, 1>();
    case 2: return call.template operator()<2, 2>();
    case 3: return call.template operator()<3, 4>();
    case 4: return call.template operator()<4, 4>();
    case 6: return call.template operator()<6, 8>();
    case 8: return call.template operator()<8, 8>();
    case 12: return call.template operator()<12, 16>();
    default: return call.template operator()<16, 16>();
  }
}

/// Copies the bytes of a field; those of bools become 0 or 1.
template <std::size_t Bytes, bool IsBool>
void copyField(const std::byte* from, std::byte* to) {
  if constexpr (IsBool) {
    for (std::size_t c = 0; c < Bytes; ++c) {
      to[c] = std::byte{from[c] != std::byte{0}};
    }
  } else {
    std::memcpy(to, from, Bytes);
  }
}

/// Copies `count` fields, which are `fromStep` bytes apart in the source and `toStep` bytes in the target.
template <std::size_t Bytes>
void copyFields(const Field& field, const std::byte* from, std::size_t fromStep, std::byte* to,
                std::size_t toStep, std::size_t count) {
  if (field.scalar == program::Scalar::Bool) {
    if constexpr (Bytes <= 4) {
      for (std::size_t i = 0; i < count; ++i) {
        copyField<Bytes, true>(from + i * fromStep, to + i * toStep);
      }
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    copyField<Bytes, false>(from + i * fromStep, to + i * toStep);
  }
}

/// Converts a channel of 32 bits to a narrower one: a float to a half, an integer to its low bytes.
void narrowChannel(const gl::Transfer& tight, const std::byte* wide, std::byte* channel) {
  if (tight.type == GL_HALF_FLOAT) {
    float value = 0;
    std::memcpy(&value, wide, sizeof value);
    const std::uint16_t bits = half(value).bits();
    std::memcpy(channel, &bits, sizeof bits);
    return;
  }
  std::uint32_t value = 0;
  std::memcpy(&value, wide, sizeof value);
  const auto low = static_cast<std::uint16_t>(value);
  if (tight.channelBytes == 2) {
    std::memcpy(channel, &low, sizeof low);
  } else {
    *channel = static_cast<std::byte>(value);
  }
}

}  // namespace

bool areTexels(const Element& element) {
  const Field& field = element.fields[0];
  return element.fields.size() == 1 && field.scalar != program::Scalar::Bool && field.width != 3 &&
         field.offset == 0 && element.size == gl::hostBytes(field);
}

void packTexels(const Element& element, const Field& field, const std::byte* elements, std::size_t count,
                std::byte* texels) {
  if (areTexels(element)) {
    std::memcpy(texels, elements, count * element.size);
    return;
  }
  withBytes(field, [&](auto bytes, auto texelBytes) {
    if constexpr (bytes != texelBytes) {
      std::memset(texels, 0, count * texelBytes);
    }
    copyFields<bytes>(field, elements + field.offset, element.size, texels, texelBytes, count);
  });
}

void unpackTexels(const Element& element, const Field& field, const std::byte* texels, std::size_t count,
                  std::byte* elements) {
  if (areTexels(element)) {
    std::memcpy(elements, texels, count * element.size);
    return;
  }
  withBytes(field, [&](auto bytes, auto texelBytes) {
    copyFields<bytes>(field, texels, texelBytes, elements + field.offset, element.size, count);
  });
}

void narrowTexels(const gl::Format& format, const std::byte* wide, std::size_t count, std::byte* tight) {
  const auto channels = static_cast<std::size_t>(format.tight.channels);
  const auto bytes = static_cast<std::size_t>(format.tight.channelBytes);
  for (std::size_t i = 0; i < count; ++i) {
    const std::byte* from = wide + i * format.wide.texelBytes();
    std::byte* to = tight + i * format.texelBytes();
    if (format.wide.channelBytes == format.tight.channelBytes) {
      std::memcpy(to, from, format.texelBytes());
      continue;
    }
    for (std::size_t c = 0; c < channels; ++c) {
      narrowChannel(format.tight, from + 4 * c, to + c * bytes);
    }
  }
}

}  // namespace sk
