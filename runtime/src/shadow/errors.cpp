// SPDX-License-Identifier: MIT
#include "shadow/errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>

#include "sk/narrow.hpp"
#include "sk/native/parallel.hpp"
#include "sk/native/quad_type.hpp"
#include "sk/types.hpp"
#include "support/convert_elements.hpp"

namespace sk::shadow {

void OutputErrors::add(const OutputErrors& other) {
  reals += other.reals;
  reference2 += other.reference2;
  own2 += other.own2;
  inherited2 += other.inherited2;
  total2 += other.total2;
  ownInTotal += other.ownInTotal;
  own.add(other.own);
  total.add(other.total);
  nans.add(other.nans);
  infinities.add(other.infinities);
  newNans.add(other.newNans);
  newInfinities.add(other.newInfinities);
  flushed.add(other.flushed);
  integers += other.integers;
  ownDecisions.add(other.ownDecisions);
  decisions.add(other.decisions);
  integerReference2 += other.integerReference2;
  integerTotal2 += other.integerTotal2;
}

double OutputErrors::relativeIntegers() const {
  if (decisions.count == 0) return 0;
  const double share = static_cast<double>(decisions.count) / static_cast<double>(integers);
  const double asNumbers = integerReference2 > 0 ? integerTotal2 / integerReference2 : 1;
  return std::sqrt(std::min(share, asNumbers));
}

double OutputErrors::ownShare() const { return total2 > 0 ? std::clamp(ownInTotal / total2, 0.0, 1.0) : 0; }

double OutputErrors::scale() const {
  return reals > 0 ? std::sqrt(reference2 / static_cast<double>(reals)) : 0;
}

double OutputErrors::relative(double squares) const {
  if (squares == 0) return 0;
  // where the reference is 0 everywhere, nothing of the result is right
  return reference2 > 0 ? std::sqrt(squares / reference2) : 1;
}

using program::Scalar;

bool isReal(Scalar scalar) {
  switch (scalar) {
    case Scalar::Float:
    case Scalar::Double:
    case Scalar::Half:
    case Scalar::Unorm8:
    case Scalar::Snorm8:
    case Scalar::Unorm16:
    case Scalar::Snorm16: return true;
    case Scalar::Bool:
    case Scalar::Int:
    case Scalar::Uint:
    case Scalar::Long:
    case Scalar::Ulong:
    case Scalar::Char:
    case Scalar::Uchar:
    case Scalar::Short:
    case Scalar::Ushort: return false;
  }
  return false;
}

namespace {

template <class T>
T loaded(const void* array, std::int64_t index) {
  T value;
  std::memcpy(&value, static_cast<const std::byte*>(array) + index * static_cast<std::int64_t>(sizeof value),
              sizeof value);
  return value;
}

/// The array of a component.
struct Column {
  const void* array;
  Scalar scalar;
  std::size_t bytes;

  Column(const NativeStream& stream, std::size_t component)
      : array(stream.components.arrays()[component]),
        scalar(stream.components.types()[component].scalar),
        bytes(stream.components.types()[component].storedBytes) {}

  double at(std::int64_t index) const {
    switch (scalar) {
      case Scalar::Half: return static_cast<float>(loaded<half>(array, index));
      case Scalar::Unorm8: return static_cast<float>(loaded<unorm8>(array, index));
      case Scalar::Snorm8: return static_cast<float>(loaded<snorm8>(array, index));
      case Scalar::Unorm16: return static_cast<float>(loaded<unorm16>(array, index));
      case Scalar::Snorm16: return static_cast<float>(loaded<snorm16>(array, index));
      case Scalar::Float:
      case Scalar::Double:
        if (bytes == sizeof(float)) return loaded<float>(array, index);
        if (bytes == sizeof(double)) return loaded<double>(array, index);
        return static_cast<double>(loaded<native::Quad>(array, index));
      case Scalar::Bool:
      case Scalar::Uchar: return loaded<std::uint8_t>(array, index);
      case Scalar::Int: return loaded<std::int32_t>(array, index);
      case Scalar::Uint: return loaded<std::uint32_t>(array, index);
      case Scalar::Long: return static_cast<double>(loaded<std::int64_t>(array, index));
      case Scalar::Ulong: return static_cast<double>(loaded<std::uint64_t>(array, index));
      case Scalar::Char: return loaded<std::int8_t>(array, index);
      case Scalar::Short: return loaded<std::int16_t>(array, index);
      case Scalar::Ushort: return loaded<std::uint16_t>(array, index);
    }
    return 0;
  }
};

constexpr std::int64_t blockSize = 1024;
using Block = std::array<double, blockSize>;

/// The components of a block as doubles: those of the array if it holds doubles.
const double* doublesOf(const Column& column, std::int64_t first, std::int64_t count, Block& room) {
  if (column.bytes == sizeof(double) && (column.scalar == Scalar::Float || column.scalar == Scalar::Double))
    return static_cast<const double*>(column.array) + first;
  if (column.bytes == sizeof(float) && column.scalar == Scalar::Float) {
    const auto* const floats = static_cast<const float*>(column.array) + first;
    std::copy_n(floats, count, room.begin());
    return room.data();
  }
  for (std::int64_t i = 0; i < count; ++i) room[static_cast<std::size_t>(i)] = column.at(first + i);
  return room.data();
}

/// Blocks of the three arrays.
struct Triple {
  const double* d;
  const double* o;
  const double* r;
  std::int64_t first, count;
  int component;
};

/// Adds what is at one index; anything may be NaN.
void addCarefully(const Triple& block, std::int64_t i, OutputErrors& errors) {
  const double d = block.d[i], o = block.o[i], r = block.r[i];
  const std::int64_t element = block.first + i;
  if (std::isnan(d)) errors.nans.add(element, block.component);
  if (std::isinf(d)) errors.infinities.add(element, block.component);
  if (std::isfinite(o) && std::isnan(d)) errors.newNans.add(element, block.component);
  if (std::isfinite(o) && std::isinf(d)) errors.newInfinities.add(element, block.component);
  if (!std::isfinite(d) || !std::isfinite(o) || !std::isfinite(r)) return;
  const double own = d - o, total = d - r, inherited = o - r;
  ++errors.reals;
  errors.reference2 += r * r;
  errors.own2 += own * own;
  errors.inherited2 += inherited * inherited;
  errors.total2 += total * total;
  errors.ownInTotal += own * total;
  errors.own.add(std::fabs(own), element, block.component);
  errors.total.add(std::fabs(total), element, block.component);
}

constexpr double leastNormal = std::numeric_limits<float>::min();

void addReals(const Triple& block, OutputErrors& errors) {
  constexpr std::int64_t lanes = 4;
  double reference[lanes] = {}, own2[lanes] = {}, inherited2[lanes] = {}, total2[lanes] = {},
         cross[lanes] = {}, worstOwn[lanes] = {}, worstTotal[lanes] = {};
  std::int64_t zeros = 0;
  const std::int64_t whole = block.count - block.count % lanes;
  for (std::int64_t i = 0; i < whole; i += lanes) {
    for (std::int64_t k = 0; k < lanes; ++k) {
      const double d = block.d[i + k], o = block.o[i + k], r = block.r[i + k];
      const double own = d - o, total = d - r, inherited = o - r;
      reference[k] += r * r;
      own2[k] += own * own;
      inherited2[k] += inherited * inherited;
      total2[k] += total * total;
      cross[k] += own * total;
      worstOwn[k] = std::max(worstOwn[k], std::fabs(own));
      worstTotal[k] = std::max(worstTotal[k], std::fabs(total));
      zeros += d == 0 ? 1 : 0;
    }
  }
  const auto sum = [](const double(&values)[lanes]) {
    return (values[0] + values[1]) + (values[2] + values[3]);
  };
  const double all = sum(reference) + sum(own2) + sum(inherited2) + sum(total2);
  if (!std::isfinite(all)) {
    for (std::int64_t i = 0; i < whole; ++i) addCarefully(block, i, errors);
  } else {
    errors.reals += whole;
    errors.reference2 += sum(reference);
    errors.own2 += sum(own2);
    errors.inherited2 += sum(inherited2);
    errors.total2 += sum(total2);
    errors.ownInTotal += sum(cross);
    if (*std::ranges::max_element(worstOwn) > errors.own.error) {
      for (std::int64_t i = 0; i < whole; ++i)
        errors.own.add(std::fabs(block.d[i] - block.o[i]), block.first + i, block.component);
    }
    if (*std::ranges::max_element(worstTotal) > errors.total.error) {
      for (std::int64_t i = 0; i < whole; ++i)
        errors.total.add(std::fabs(block.d[i] - block.r[i]), block.first + i, block.component);
    }
  }
  for (std::int64_t i = whole; i < block.count; ++i) addCarefully(block, i, errors);
  if (zeros == 0 && whole == block.count) return;
  for (std::int64_t i = 0; i < block.count; ++i) {
    if (block.d[i] == 0 && block.o[i] != 0 && std::fabs(block.o[i]) < leastNormal)
      errors.flushed.add(block.first + i, block.component);
  }
}

/// Whether integers differ by more than the rounding of a number that is packed in their upper bits.
bool differ(const Column& a, const Column& b, std::int64_t i) {
  constexpr double rounding = 0x1p-20;
  const double x = a.at(i), y = b.at(i);
  return std::fabs(x - y) > rounding * std::max(std::fabs(x), std::fabs(y));
}

void addIntegers(const Column& d, const Column& o, const Column& r, const Triple& block,
                 OutputErrors& errors) {
  const auto at = [&](const Column& column, std::int64_t i) {
    return static_cast<const std::byte*>(column.array) + i * static_cast<std::int64_t>(column.bytes);
  };
  errors.integers += block.count;
  const auto bytes = static_cast<std::size_t>(block.count) * d.bytes;
  const bool isOwn = std::memcmp(at(d, block.first), at(o, block.first), bytes) != 0;
  const bool isTotal = std::memcmp(at(d, block.first), at(r, block.first), bytes) != 0;
  if (!isOwn && !isTotal) {
    for (std::int64_t i = block.first; i < block.first + block.count; ++i)
      errors.integerReference2 += r.at(i) * r.at(i);
    return;
  }
  for (std::int64_t i = block.first; i < block.first + block.count; ++i) {
    if (differ(d, o, i)) errors.ownDecisions.add(i, block.component);
    if (differ(d, r, i)) errors.decisions.add(i, block.component);
    const double reference = r.at(i), total = d.at(i) - reference;
    errors.integerReference2 += reference * reference;
    errors.integerTotal2 += total * total;
  }
}

OutputErrors compareComponent(const NativeStream& device, const NativeStream& own,
                              const NativeStream& reference, int component) {
  const auto number = static_cast<std::size_t>(component);
  const Column d(device, number), o(own, number), r(reference, number);
  OutputErrors all;
  std::mutex mutex;
  const std::int64_t count = device.shape.size();
  native::inParallel(count, 2, native::Deal::Evenly, [&](native::Range range) {
    OutputErrors errors;
    Block roomD, roomO, roomR;
    for (std::int64_t first = range.begin; first < range.end; first += blockSize) {
      Triple block{nullptr, nullptr, nullptr, first, std::min(blockSize, range.end - first), component};
      if (!isReal(d.scalar)) {
        addIntegers(d, o, r, block, errors);
        continue;
      }
      block.d = doublesOf(d, first, block.count, roomD);
      block.o = doublesOf(o, first, block.count, roomO);
      block.r = doublesOf(r, first, block.count, roomR);
      addReals(block, errors);
    }
    const std::lock_guard lock(mutex);
    all.add(errors);
  });
  return all;
}

}  // namespace

OutputErrors compare(const NativeStream& device, const NativeStream* own, const NativeStream& reference) {
  OutputErrors errors;
  for (std::size_t c = 0; c < device.components.types().size(); ++c)
    errors.add(compareComponent(device, own != nullptr ? *own : reference, reference, static_cast<int>(c)));
  return errors;
}

double squaresOfHalfRounding(const NativeStream& stream) {
  double squares = 0;
  for (std::size_t c = 0; c < stream.components.types().size(); ++c) {
    const Column column(stream, c);
    if (column.scalar != Scalar::Float) continue;
    for (std::int64_t i = 0; i < stream.shape.size(); ++i) {
      const double value = column.at(i), change = static_cast<float>(half(roundedToOdd(value))) - value;
      if (std::isfinite(change)) squares += change * change;
    }
  }
  return squares;
}

double valueAt(const NativeStream& stream, int component, std::int64_t element) {
  return Column(stream, static_cast<std::size_t>(component)).at(element);
}

}  // namespace sk::shadow
