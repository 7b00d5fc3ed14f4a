// SPDX-License-Identifier: MIT
#include "shadow/errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <type_traits>
#include <vector>

#include "native/convert_floats.hpp"
#include "shadow/difference_sums.hpp"
#include "sk/narrow.hpp"
#include "sk/native/parallel.hpp"
#include "sk/native/quad_type.hpp"
#include "sk/types.hpp"
#include "support/convert_elements.hpp"
#include "support/scalar_types.hpp"

namespace sk::shadow {

namespace {

constexpr double leastNormal = std::numeric_limits<float>::min();

}  // namespace

void OutputErrors::add(const OutputErrors& other) {
  reals += other.reals;
  reference2 += other.reference2;
  own2 += other.own2;
  inherited2 += other.inherited2;
  total2 += other.total2;
  ownInTotal += other.ownInTotal;
  nans.add(other.nans);
  infinities.add(other.infinities);
  newNans.add(other.newNans);
  newInfinities.add(other.newInfinities);
  lost += other.lost;
  flushed.add(other.flushed);
  integers += other.integers;
  ownDecisions.add(other.ownDecisions);
  decisions.add(other.decisions);
  integerReference2 += other.integerReference2;
  integerTotal2 += other.integerTotal2;
  isSame = isSame && other.isSame;
}

double OutputErrors::relativeIntegers() const {
  if (decisions.count == 0) return 0;
  const double share = static_cast<double>(decisions.count) / static_cast<double>(integers);
  const double asNumbers = integerReference2 > 0 ? integerTotal2 / integerReference2 : 1;
  return std::sqrt(std::min(share, asNumbers));
}

double OutputErrors::reportedOwn() const {
  const bool isLost = newNans.count > 0 || newInfinities.count > 0;
  return isLost ? std::numeric_limits<double>::infinity() : relativeOwn();
}

double OutputErrors::reportedTotal() const {
  return lost > 0 ? std::numeric_limits<double>::infinity() : relativeTotal();
}

double OutputErrors::ownShare() const { return std::clamp(signedOwnShare(), 0.0, 1.0); }

double OutputErrors::signedOwnShare() const {
  if (newNans.count > 0 || newInfinities.count > 0) return 1;
  return total2 > 0 ? ownInTotal / total2 : 0;
}

double OutputErrors::scale() const {
  return reals > 0 ? std::sqrt(reference2 / static_cast<double>(reals)) : 0;
}

double OutputErrors::absoluteTotal() const {
  return reals > 0 ? std::sqrt(total2 / static_cast<double>(reals)) : 0;
}

double OutputErrors::relative(double squares) const {
  if (squares == 0) return 0;
  // where the reference is 0 everywhere, nothing of the result is right
  if (!(reference2 > 0)) return 1;
  // below the smallest normal float, floats have fewer digits
  const double least = static_cast<double>(reals) * leastNormal * leastNormal;
  return std::sqrt(squares / std::max(reference2, least));
}

using program::Scalar;

bool isReal(Scalar scalar) {
  return withScalarType(scalar, []<class T>(T) { return !std::is_integral_v<T>; });
}

std::int64_t realComponents(const program::Element& element) {
  std::int64_t count = 0;
  for (const program::Field& field : element.fields) count += isReal(field.scalar) ? field.width : 0;
  return count;
}

namespace {

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
    const std::byte* const place =
        static_cast<const std::byte*>(array) + index * static_cast<std::int64_t>(bytes);
    if (scalar != Scalar::Float && scalar != Scalar::Double) return numberAt(place, scalar);
    if (bytes == sizeof(float)) return componentAt<float>(place);
    if (bytes == sizeof(double)) return componentAt<double>(place);
    return static_cast<double>(componentAt<native::Quad>(place));
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
    widenFloats(floats, count, room.data());
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

/// The block with the largest own error so far. Which of its elements has it, is found out once at the end.
struct WorstBlock {
  double error = 0;
  std::int64_t first = 0, count = 0;
  int component = 0;
  Block own{};  ///< what the reference computes there with the device's inputs

  void take(const Triple& block, double largest) {
    error = largest;
    first = block.first;
    count = block.count;
    component = block.component;
    std::copy_n(block.o, block.count, own.begin());
  }
  void add(const WorstBlock& other) {
    const bool isEarlier =
        other.component < component || (other.component == component && other.first < first);
    if (other.error > error || (other.error == error && error > 0 && isEarlier)) *this = other;
  }
};

struct Compared {
  OutputErrors errors;
  WorstBlock worst;

  void add(const Compared& other) {
    errors.add(other.errors);
    worst.add(other.worst);
  }
};

/// Adds what is at one index; anything may be NaN.
void addCarefully(const Triple& block, std::int64_t i, OutputErrors& errors, double& worst) {
  const double d = block.d[i], o = block.o[i], r = block.r[i];
  const std::int64_t element = block.first + i;
  if (std::isnan(d)) errors.nans.add(element, block.component, o);
  if (std::isinf(d)) errors.infinities.add(element, block.component, o);
  if (std::isfinite(o) && std::isnan(d)) errors.newNans.add(element, block.component, o);
  if (std::isfinite(o) && std::isinf(d)) errors.newInfinities.add(element, block.component, o);
  if (std::isfinite(r) && !std::isfinite(d)) ++errors.lost;
  if (!std::isfinite(d) || !std::isfinite(o) || !std::isfinite(r)) return;
  const double own = d - o, total = d - r, inherited = o - r;
  ++errors.reals;
  errors.reference2 += r * r;
  errors.own2 += own * own;
  errors.inherited2 += inherited * inherited;
  errors.total2 += total * total;
  errors.ownInTotal += own * total;
  worst = std::max(worst, std::fabs(own));
}

void addReals(const Triple& block, Compared& all) {
  OutputErrors& errors = all.errors;
  const DifferenceSums sums = addDifferences(block.d, block.o, block.r, block.count);
  double worst = 0;
  if (!sums.isFinite()) {
    errors.isSame = false;
    for (std::int64_t i = 0; i < block.count; ++i) addCarefully(block, i, errors, worst);
  } else {
    errors.reals += block.count;
    errors.reference2 += sums.reference2;
    errors.own2 += sums.own2;
    errors.inherited2 += sums.inherited2;
    errors.total2 += sums.total2;
    errors.ownInTotal += sums.ownInTotal();
    worst = sums.largestOwn;
    errors.isSame =
        errors.isSame && sums.total2 == 0 &&
        std::memcmp(block.d, block.r, static_cast<std::size_t>(block.count) * sizeof(double)) == 0;
  }
  if (worst > all.worst.error) all.worst.take(block, worst);
  if (sums.isFinite() && !sums.mayFlush) return;
  for (std::int64_t i = 0; i < block.count; ++i) {
    if (block.d[i] == 0 && block.o[i] != 0 && std::fabs(block.o[i]) < leastNormal)
      errors.flushed.add(block.first + i, block.component, block.o[i]);
  }
}

/// Whether integers differ by more than the rounding of a number that is packed in their upper bits.
bool differ(double x, double y) {
  constexpr double rounding = 0x1p-20;
  return std::fabs(x - y) > rounding * std::max(std::fabs(x), std::fabs(y));
}

template <class T>
double sumOfSquares(const void* array, std::int64_t first, std::int64_t count) {
  double sums[4] = {};
  for (std::int64_t i = 0; i < count; ++i) {
    const auto value = static_cast<double>(componentAt<T>(
        static_cast<const std::byte*>(array) + (first + i) * static_cast<std::int64_t>(sizeof(T))));
    sums[i % 4] += value * value;
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

double sumOfSquares(const Column& column, std::int64_t first, std::int64_t count) {
  if (column.scalar == Scalar::Int) return sumOfSquares<std::int32_t>(column.array, first, count);
  if (column.scalar == Scalar::Uint) return sumOfSquares<std::uint32_t>(column.array, first, count);
  if (column.bytes == 1 && column.scalar != Scalar::Char)
    return sumOfSquares<std::uint8_t>(column.array, first, count);
  double sum = 0;
  for (std::int64_t i = first; i < first + count; ++i) {
    const double value = column.at(i);
    sum += value * value;
  }
  return sum;
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
  errors.isSame = errors.isSame && !isTotal;
  errors.integerReference2 += sumOfSquares(r, block.first, block.count);
  if (!isOwn && !isTotal) return;
  for (std::int64_t i = block.first; i < block.first + block.count; ++i) {
    const double reference = r.at(i), device = d.at(i), total = device - reference;
    const double own = o.at(i);
    if (differ(device, own)) errors.ownDecisions.add(i, block.component, own);
    if (differ(device, reference)) errors.decisions.add(i, block.component, own);
    errors.integerTotal2 += total * total;
  }
}

/// Fills a block of the device's component from where its elements are.
void fetch(const Column& from, const Column& to, std::int64_t first, std::int64_t count) {
  const auto place = [first](const Column& column) {
    return static_cast<const std::byte*>(column.array) + first * static_cast<std::int64_t>(column.bytes);
  };
  auto* const target = const_cast<std::byte*>(place(to));
  if (from.bytes == to.bytes) {
    std::memcpy(target, place(from), static_cast<std::size_t>(count) * to.bytes);
  } else {
    widenFloats(reinterpret_cast<const float*>(place(from)), count, reinterpret_cast<double*>(target));
  }
}

/// The three arrays of a component, and where the device's come from.
struct ComparedColumns {
  Column d, o, r;
  std::optional<Column> source;
  bool isReplaced;  ///< d is the source, whose elements replace those of o
  int component;
};

void addRange(const ComparedColumns& columns, native::Range range, Compared& all) {
  const auto& [d, o, r, source, isReplaced, component] = columns;
  Block roomD, roomO, roomR;
  for (std::int64_t first = range.begin; first < range.end; first += blockSize) {
    Triple block{nullptr, nullptr, nullptr, first, std::min(blockSize, range.end - first), component};
    if (source && !isReplaced) fetch(*source, d, first, block.count);
    if (isReal(d.scalar)) {
      block.d = doublesOf(d, first, block.count, roomD);
      block.o = o.array == r.array ? nullptr : doublesOf(o, first, block.count, roomO);
      block.r = doublesOf(r, first, block.count, roomR);
      if (block.o == nullptr) block.o = block.r;
      addReals(block, all);
    } else {
      addIntegers(d, o, r, block, all.errors);
    }
    if (isReplaced) fetch(*source, o, first, block.count);
  }
}

/// The first element of a block with its largest own error.
Worst elementOf(const WorstBlock& worst, const Column& d) {
  Block room;
  const double* const device = doublesOf(d, worst.first, worst.count, room);
  std::size_t i = 0;
  while (static_cast<std::int64_t>(i) < worst.count - 1 && std::fabs(device[i] - worst.own[i]) != worst.error)
    ++i;
  return {worst.error, worst.first + static_cast<std::int64_t>(i), worst.component, worst.own[i]};
}

}  // namespace

OutputErrors compare(NativeStream& device, const NativeStream* source, const NativeStream* own,
                     const NativeStream& reference) {
  const NativeStream& given = own != nullptr ? *own : reference;
  const bool isReplaced = own == &device && source != nullptr;
  std::vector<ComparedColumns> columns;
  for (std::size_t c = 0; c < device.components.types().size(); ++c) {
    std::optional<Column> from;
    if (source != nullptr) from.emplace(*source, c);
    columns.push_back({isReplaced ? *from : Column(device, c),
                       {given, c},
                       {reference, c},
                       from,
                       isReplaced,
                       static_cast<int>(c)});
  }
  Compared all;
  std::mutex mutex;
  native::inParallel(device.shape.size(), static_cast<std::int64_t>(columns.size()), native::Deal::Evenly,
                     [&](native::Range range) {
                       Compared part;
                       for (const ComparedColumns& each : columns) addRange(each, range, part);
                       const std::lock_guard lock(mutex);
                       all.add(part);
                     });
  if (source != nullptr) device.setWritten();
  if (all.worst.error > 0) {
    all.errors.own = elementOf(all.worst, columns[static_cast<std::size_t>(all.worst.component)].d);
  }
  return all.errors;
}

bool haveSameBits(const NativeStream& a, const NativeStream& b) {
  for (std::size_t c = 0; c < a.components.types().size(); ++c) {
    const std::size_t bytes = static_cast<std::size_t>(a.shape.size()) * a.components.types()[c].storedBytes;
    if (bytes > 0 && std::memcmp(a.components.arrays()[c], b.components.arrays()[c], bytes) != 0)
      return false;
  }
  return true;
}

double squaresOfRounding(const NativeStream& stream, bool isToHalf) {
  const auto rounded = [&](double value) {
    return isToHalf ? static_cast<float>(half(roundedToOdd(value))) : static_cast<float>(value);
  };
  double squares = 0;
  for (std::size_t c = 0; c < stream.components.types().size(); ++c) {
    const Column column(stream, c);
    if (column.scalar != Scalar::Float) continue;
    for (std::int64_t i = 0; i < stream.shape.size(); ++i) {
      const double value = column.at(i), change = rounded(value) - value;
      if (std::isfinite(change)) squares += change * change;
    }
  }
  return squares;
}

double valueAt(const NativeStream& stream, int component, std::int64_t element) {
  return Column(stream, static_cast<std::size_t>(component)).at(element);
}

}  // namespace sk::shadow
