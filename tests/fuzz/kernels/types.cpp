// SPDX-License-Identifier: MIT
#include "kernels/types.hpp"

#include <fmt/format.h>

#include "sk/types.hpp"

namespace fuzz {
namespace {

template <class Narrow>
float through(float value) {
  return static_cast<float>(Narrow(value));
}

template <class Narrow>
std::uint32_t wrapped(std::uint32_t bits) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(static_cast<Narrow>(bits)));
}

std::uint32_t quantized(Scalar scalar, std::uint32_t bits) {
  const auto asFloat = [&](auto convert) {
    return std::bit_cast<std::uint32_t>(convert(std::bit_cast<float>(bits)));
  };
  switch (scalar) {
    case Scalar::Bool: return bits != 0 ? 1 : 0;
    case Scalar::Int:
    case Scalar::Uint:
    case Scalar::Float:
    case Scalar::Double:
    case Scalar::Long:
    case Scalar::Ulong: return bits;
    case Scalar::Half: return asFloat(through<sk::half>);
    case Scalar::Char: return wrapped<std::int8_t>(bits);
    case Scalar::Uchar: return wrapped<std::uint8_t>(bits);
    case Scalar::Short: return wrapped<std::int16_t>(bits);
    case Scalar::Ushort: return wrapped<std::uint16_t>(bits);
    case Scalar::Unorm8: return asFloat(through<sk::unorm8>);
    case Scalar::Snorm8: return asFloat(through<sk::snorm8>);
    case Scalar::Unorm16: return asFloat(through<sk::unorm16>);
    case Scalar::Snorm16: return asFloat(through<sk::snorm16>);
  }
  return bits;
}

std::uint32_t randomBits(Scalar scalar, Random& random) {
  if (arithmeticScalar(scalar) == Scalar::Float) {
    const int most = isNormalized(scalar) ? 24 : 1 << kept.bits();
    const float value = static_cast<float>(random.between(-most, most)) / (1 << kept.fraction);
    return quantized(scalar, std::bit_cast<std::uint32_t>(value));
  }
  // Shifting by a random amount makes small numbers as likely as large ones.
  const std::uint64_t bits = random.next();
  return quantized(scalar, static_cast<std::uint32_t>(bits) >> (bits >> 59));
}

}  // namespace

bool isNarrow(Scalar scalar) { return scalar >= Scalar::Half; }
bool isNormalized(Scalar scalar) { return scalar >= Scalar::Unorm8; }

Scalar arithmeticScalar(Scalar scalar) {
  if (!isNarrow(scalar)) return scalar;
  return scalar == Scalar::Half || isNormalized(scalar) ? Scalar::Float : Scalar::Int;
}

float scaleOf(Scalar normalized) {
  if (normalized == Scalar::Unorm8) return sk::unorm8::scale;
  if (normalized == Scalar::Snorm8) return sk::snorm8::scale;
  return normalized == Scalar::Unorm16 ? sk::unorm16::scale : sk::snorm16::scale;
}

int componentsOf(const Records& records, const Type& type) {
  return static_cast<int>(scalarsOf(records, type).size());
}

std::string spelling(const Records& records, const Type& type) {
  if (type.record >= 0) return records[static_cast<std::size_t>(type.record)].name;
  const auto width = static_cast<std::size_t>(type.width);
  if (type.isMatrix) return std::string(sk::detail::matrixNames[width - 2]);
  return std::string(sk::detail::spellings[static_cast<std::size_t>(type.scalar)].names[width - 1]);
}

std::vector<Scalar> scalarsOf(const Records& records, const Type& type) {
  if (type.record < 0) {
    const int count = type.isMatrix ? type.width * type.width : type.width;
    return std::vector(static_cast<std::size_t>(count), type.scalar);
  }
  std::vector<Scalar> all;
  for (const Record::Member& member : records[static_cast<std::size_t>(type.record)].members) {
    const std::vector<Scalar> one = scalarsOf(records, member.type);
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

Value quantized(const Records& records, const Type& type, Value value) {
  const std::vector<Scalar> scalars = scalarsOf(records, type);
  for (std::size_t i = 0; i < scalars.size(); ++i) value.bits[i] = quantized(scalars[i], value.bits[i]);
  return value;
}

Value randomValue(const Records& records, const Type& type, Random& random) {
  Value value;
  const std::vector<Scalar> scalars = scalarsOf(records, type);
  for (std::size_t i = 0; i < scalars.size(); ++i) value.bits[i] = randomBits(scalars[i], random);
  return value;
}

Type randomVector(Random& random) {
  static constexpr Scalar often[] = {Scalar::Bool,  Scalar::Int,   Scalar::Int,  Scalar::Uint,
                                     Scalar::Float, Scalar::Float, Scalar::Float};
  static constexpr Scalar narrow[] = {Scalar::Half,   Scalar::Char,    Scalar::Uchar,
                                      Scalar::Short,  Scalar::Ushort,  Scalar::Unorm8,
                                      Scalar::Snorm8, Scalar::Unorm16, Scalar::Snorm16};
  const Scalar scalar = random.chance(1, 4) ? random.pick(narrow) : random.pick(often);
  return {scalar, random.chance(1, 2) ? 1 : random.between(2, 4)};
}

Type randomType(const Records& records, Random& random) {
  if (!records.empty() && random.chance(1, 6)) {
    return {.record = static_cast<int>(random.below(records.size()))};
  }
  if (random.chance(1, 10)) return {Scalar::Float, random.between(2, 4), true};
  return randomVector(random);
}

std::string literal(const Type& type, const Value& value) {
  std::string parts;
  for (int i = 0; i < type.width; ++i) {
    std::string one;
    if (type.scalar == Scalar::Bool) {
      one = value.asUint(i) != 0 ? "true" : "false";
    } else if (type.scalar == Scalar::Uint) {
      one = fmt::format("{}u", value.asUint(i));
    } else if (type.scalar == Scalar::Float) {
      one = fmt::format("{:.4f}", value.asFloat(i));
    } else {
      one = value.asInt(i) == INT32_MIN ? "(-2147483647 - 1)" : fmt::format("{}", value.asInt(i));
    }
    if (one[0] == '-') one = "(" + one + ")";
    parts += (i == 0 ? "" : ", ") + one;
  }
  return type.width == 1 ? parts : fmt::format("{}({})", spelling({}, type), parts);
}

}  // namespace fuzz
