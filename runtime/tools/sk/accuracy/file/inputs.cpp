// SPDX-License-Identifier: MIT
#include "accuracy/file/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "accuracy/programs.hpp"
#include "info/numbers.hpp"

namespace sk_tool {

namespace {

using sk::program::Parameter;
using sk::program::Role;
using sk::program::Scalar;

constexpr double wideLeast = 1e-4, wideMost = 1e4;  ///< of half of all reals; halves hold them
constexpr double integerMost = 8;

/// Half of the numbers are distributed logarithmically (as many in [1, 2] as in [100, 200]), the others
/// uniformly.
double drawReal(const std::optional<Range>& range, Numbers& numbers) {
  const bool isLinear = numbers.unit() < 0.5;
  const auto linear = [&](double low, double high) { return low + (high - low) * numbers.unit(); };
  const auto logarithmic = [&](double low, double high) {
    return low * std::exp2(numbers.unit() * std::log2(high / low));
  };
  if (!range) {
    if (isLinear) return linear(-1, 1);
    const double magnitude = logarithmic(wideLeast, wideMost);
    return numbers.unit() < 0.5 ? -magnitude : magnitude;
  }
  const double low = range->low, high = range->high;
  if (isLinear || low == high) return linear(low, high);
  const bool isNegative = high <= 0 || (low < 0 && numbers.unit() < 0.5);
  const double most = isNegative ? -low : high;
  const bool endsAtZero = low <= 0 && high >= 0;
  const double least = endsAtZero ? most * 0x1p-24 : isNegative ? -high : low;
  const double magnitude = std::clamp(logarithmic(least, most), least, most);
  return isNegative ? -magnitude : magnitude;
}

double drawScalar(Scalar scalar, const std::optional<Range>& range, Numbers& numbers) {
  if (isReal(scalar)) return drawReal(range, numbers);
  const bool isSigned =
      scalar == Scalar::Int || scalar == Scalar::Long || scalar == Scalar::Char || scalar == Scalar::Short;
  const double most = scalar == Scalar::Bool ? 1 : integerMost;
  const Range from = range.value_or(Range{isSigned ? -most : 0, most});
  return std::min(from.low + std::floor(numbers.unit() * (from.high - from.low + 1)), from.high);
}

/// Whether a scalar may be extreme: a real that the options do not set.
bool isDrawnReal(Scalar scalar, const std::optional<Range>& range) {
  return isReal(scalar) && !(range && range->isValue());
}

/// Returns at most `mostExtremes` numbers.
std::vector<double> extremesOf(Scalar scalar, const std::optional<Range>& range) {
  std::vector<double> values{0.0, -0.0, 1, -1};
  const auto add = [&](double normal, double denormal, double most, int digits) {
    for (const double value : {normal, denormal, normal - denormal, most, std::exp2(digits), HUGE_VAL}) {
      values.push_back(value);
      values.push_back(-value);
    }
    values.push_back(std::numeric_limits<double>::quiet_NaN());
  };
  using Floats = std::numeric_limits<float>;
  using Doubles = std::numeric_limits<double>;
  if (scalar == Scalar::Float) add(Floats::min(), Floats::denorm_min(), Floats::max(), 24);
  if (scalar == Scalar::Double) add(Doubles::min(), Doubles::denorm_min(), Doubles::max(), 53);
  if (scalar == Scalar::Half) add(0x1p-14, 0x1p-24, 65504, 11);
  if (range) {
    for (const double value : {range->low, range->low + ulpOf(scalar, range->low), range->high,
                               range->high - ulpOf(scalar, range->high)}) {
      values.push_back(value);
    }
    if (range->promise)
      std::erase_if(values,
                    [&](double v) { return !(v >= range->promise->low && v <= range->promise->high); });
  }
  return values;
}

/// The number of steps of an iterator's component.
std::int64_t stepsOf(const Parameter& parameter, const sk::Shape& domain, std::size_t component) {
  const bool countsElements = domain.rank() == 1 || parameter.element->fields[0].width == 1;
  return countsElements ? domain.size() : domain[domain.rank() - 1 - static_cast<int>(component)];
}

/// The ends of an iterator's scalar; integers have whole steps.
Range endsOf(const Parameter& parameter, Scalar scalar, const std::optional<Range>& range,
             const sk::Shape& domain, std::size_t component) {
  if (isReal(scalar)) return range.value_or(Range{-1, 1});
  const auto steps = static_cast<double>(stepsOf(parameter, domain, component));
  if (!range) return {0, steps};
  const double stride = std::max(1.0, std::round((range->high - range->low) / steps));
  return {range->low, range->low + stride * steps};
}

std::int64_t identifyingElement(const Extent& extent, std::int64_t result) {
  const std::int64_t block = extent.domain.size() / std::max<std::int64_t>(extent.results.size(), 1);
  return result * block + (block > 1 ? result * 7 % block : 0);
}

class Drawing {
 public:
  Drawing(const Subject& subject, const Ranges& ranges, const Extent& extent, Extremes extremes)
      : subject_(subject), ranges_(ranges), extent_(extent), extremes_(extremes), numbers_(inputSeed) {}

  Inputs draw() {
    Inputs inputs{.extent = extent_, .parameters = {}, .elements = identifyingElements(extent_)};
    places_ = extremeScalars(subject_, ranges_, extremes_);
    for (const Parameter& parameter : subject_.parameters())
      inputs.parameters.push_back(drawParameter(parameter));
    return inputs;
  }

 private:
  ParameterInput drawParameter(const Parameter& parameter) {
    if (isResult(parameter)) return {.shape = extent_.results, .bytes = {}};
    if (parameter.role == Role::Iterator) return iterator(parameter);
    const bool isOneValue = isValue(parameter);
    sk::Shape shape = extent_.domain;
    if (parameter.role == Role::Gather && parameter.rank != shape.rank()) {
      shape = cubeOf(parameter.rank, shape.size());
    }
    const auto count = static_cast<std::size_t>(isOneValue ? extent_.draws : shape.size());
    ParameterInput input{.shape = shape, .bytes = std::vector<std::byte>(count * parameter.element->size)};
    const std::vector<std::optional<Range>> ranges = ranges_.of(parameter);
    const std::vector<ScalarPlace> places = scalarsOf(*parameter.element);
    for (std::size_t c = 0; c < places.size(); ++c) {
      const std::vector<double> values = drawScalars(parameter, places[c].scalar, ranges[c], count);
      for (std::size_t i = 0; i < count; ++i) {
        store(places[c].scalar, values[i],
              input.bytes.data() + i * parameter.element->size + places[c].offset);
      }
    }
    return input;
  }

  std::vector<double> drawScalars(const Parameter& parameter, Scalar scalar,
                                  const std::optional<Range>& range, std::size_t count) {
    if (parameter.role == Role::Spec && !range) return std::vector<double>(count, 1);
    std::vector<double> values(count);
    for (double& value : values) value = drawScalar(scalar, range, numbers_);
    if (extremes_ == Extremes::AtExponents) {
      if (!isValue(parameter) && isDrawnReal(scalar, range)) moveToExponents(values, scalar, range);
      return values;
    }
    const bool isWhere =
        extremes_ != Extremes::None && isValue(parameter) == (extremes_ == Extremes::InValues);
    if (!isWhere || parameter.role == Role::Spec || !isDrawnReal(scalar, range)) return values;
    const std::vector<double> extremes = extremesOf(scalar, range);
    for (std::size_t i = 0; i < count; ++i) {
      if (takesExtreme(parameter, i, place_)) values[i] = pick(extremes, i);
    }
    ++place_;
    return values;
  }

  /// Makes three of four numbers powers of 2 or one of their neighbours, with the same sign, in their range.
  void moveToExponents(std::vector<double>& values, Scalar scalar, const std::optional<Range>& range) {
    for (double& value : values) {
      const double unit = numbers_.unit();
      if (value == 0 || unit > 0.75) continue;
      const double end = std::copysign(std::exp2(std::ilogb(value)), value);
      const double moved = end + std::floor(numbers_.unit() * 5 - 2) * ulpOf(scalar, end) / 2;
      const double stored = roundedTo(scalar, moved);
      if (!range || (stored >= range->low && stored <= range->high)) value = stored;
    }
  }

  /// First makes each scalar extreme alone, with each of its extremes; later several at once. Gathers have
  /// few extremes, because other elements read their neighbours.
  bool takesExtreme(const Parameter& parameter, std::size_t element, std::size_t place) {
    if (!identifiesResult(element)) return false;
    const std::size_t number = numberOf(element);
    if (number < places_ * mostExtremes) return number % places_ == place;
    return numbers_.unit() < (parameter.role == Role::Gather ? 0.125 : 0.5);
  }
  double pick(const std::vector<double>& extremes, std::size_t element) {
    const std::size_t number = numberOf(element);
    const auto any = static_cast<std::size_t>(numbers_.unit() * static_cast<double>(extremes.size()));
    return extremes[number < places_ * mostExtremes ? number / places_ % extremes.size() : any];
  }

  /// Only the element that identifies its block's result is extreme.
  std::int64_t block() const { return extent_.domain.size() / extent_.results.size(); }
  bool identifiesResult(std::size_t element) const {
    if (extremes_ == Extremes::InValues || block() == 1) return true;
    const auto at = static_cast<std::int64_t>(element);
    return at / block() < extent_.results.size() && identifyingElement(extent_, at / block()) == at;
  }
  std::size_t numberOf(std::size_t element) const {
    return extremes_ == Extremes::InValues ? element : element / static_cast<std::size_t>(block());
  }

  ParameterInput iterator(const Parameter& parameter) const {
    const std::size_t size = parameter.element->size;
    ParameterInput input{.shape = {}, .bytes = std::vector<std::byte>(2 * size)};
    const std::vector<std::optional<Range>> ranges = ranges_.of(parameter);
    const std::vector<ScalarPlace> places = scalarsOf(*parameter.element);
    for (std::size_t c = 0; c < places.size(); ++c) {
      const Range ends = endsOf(parameter, places[c].scalar, ranges[c], extent_.domain, c);
      store(places[c].scalar, ends.low, input.bytes.data() + places[c].offset);
      store(places[c].scalar, ends.high, input.bytes.data() + size + places[c].offset);
    }
    return input;
  }

  const Subject& subject_;
  const Ranges& ranges_;
  const Extent& extent_;
  Extremes extremes_;
  Numbers numbers_;
  std::size_t places_ = 0;  ///< number of scalars that may be extreme
  std::size_t place_ = 0;  ///< number of the next one
};

/// The number in a stream of the element that an element of the domain reads; nullopt if the stream is fitted to the domain in
/// another way than by repeating extents of 1.
std::optional<std::int64_t> numberIn(const sk::Shape& shape, const sk::Shape& domain, std::int64_t element) {
  if (shape == domain) return element;
  if (shape.rank() != domain.rank()) return std::nullopt;
  std::int64_t number = 0, factor = 1;
  for (int d = domain.rank() - 1; d >= 0; --d) {
    if (shape[d] != domain[d] && shape[d] != 1) return std::nullopt;
    number += (shape[d] == 1 ? 0 : element % domain[d]) * factor;
    factor *= shape[d];
    element /= domain[d];
  }
  return number;
}

/// The index of an element as text, rows first: "3, 5".
std::string indexText(const sk::Shape& shape, std::int64_t element) {
  std::vector<std::int64_t> index(static_cast<std::size_t>(shape.rank()));
  for (int d = shape.rank() - 1; d >= 0; --d) {
    index[static_cast<std::size_t>(d)] = element % shape[d];
    element /= shape[d];
  }
  return fmt::format("{}", fmt::join(index, ", "));
}

}  // namespace

std::vector<std::int64_t> identifyingElements(const Extent& extent) {
  std::vector<std::int64_t> elements;
  for (std::int64_t i = 0; i < extent.results.size(); ++i) elements.push_back(identifyingElement(extent, i));
  return elements;
}

bool areAligned(const Subject& subject, const Inputs& inputs) {
  for (std::size_t p = 0; p < inputs.parameters.size(); ++p) {
    if (subject.parameters()[p].role == Role::Input && inputs.parameters[p].shape != inputs.extent.domain)
      return false;
  }
  return true;
}

Inputs drawInputs(const Subject& subject, const Ranges& ranges, const Extent& extent, Extremes extremes) {
  return Drawing(subject, ranges, extent, extremes).draw();
}

bool isElementwise(const Subject& subject) {
  if (subject.isReduce()) return false;
  for (const Parameter& parameter : subject.parameters()) {
    if (parameter.role != Role::Input && !isResult(parameter) && parameter.role != Role::Uniform &&
        parameter.role != Role::Spec)
      return false;
  }
  return true;
}

Inputs inputsAt(const Subject& subject, const Inputs& inputs, int draw,
                std::span<const std::size_t> elements) {
  const auto count = static_cast<std::int64_t>(elements.size());
  Inputs at{.extent = {.domain = {count}, .results = {count}, .draws = 1}, .parameters = {}, .elements = {}};
  for (std::int64_t i = 0; i < count; ++i) at.elements.push_back(i);
  for (std::size_t p = 0; p < inputs.parameters.size(); ++p) {
    const Parameter& parameter = subject.parameters()[p];
    ParameterInput input{.shape = {count}, .bytes = {}};
    const auto take = [&](std::size_t number) {
      const auto from =
          inputs.parameters[p].bytes.begin() + static_cast<std::ptrdiff_t>(number * parameter.element->size);
      input.bytes.insert(input.bytes.end(), from,
                         from + static_cast<std::ptrdiff_t>(parameter.element->size));
    };
    if (isValue(parameter)) {
      take(static_cast<std::size_t>(draw));
    } else if (!isResult(parameter)) {
      for (const std::size_t element : elements) take(element);
    }
    at.parameters.push_back(std::move(input));
  }
  return at;
}

namespace {

/// Inputs of `count` elements, each scalar of which `scalarOf` returns, given the scalar's place, its range, those of the
/// elements of `from`, and the number of the element.
template <class ScalarOf>
Inputs madeFrom(const Subject& subject, const Ranges& ranges, const Inputs& from, std::int64_t count,
                const ScalarOf& scalarOf) {
  const std::vector<std::size_t> none;
  Inputs made = inputsAt(subject, from, 0, none);
  made.extent.domain = made.extent.results = {count};
  for (std::int64_t i = 0; i < count; ++i) made.elements.push_back(i);
  for (std::size_t p = 0; p < made.parameters.size(); ++p) {
    const Parameter& parameter = subject.parameters()[p];
    if (isValue(parameter)) continue;
    made.parameters[p].shape = {count};
    if (isResult(parameter)) continue;
    const std::size_t size = parameter.element->size;
    made.parameters[p].bytes.resize(static_cast<std::size_t>(count) * size);
    const std::vector<std::optional<Range>> given = ranges.of(parameter);
    const std::vector<ScalarPlace> places = scalarsOf(*parameter.element);
    for (std::size_t c = 0; c < places.size(); ++c) {
      const auto old = [&](std::size_t i) {
        return load(places[c].scalar, from.parameters[p].bytes.data() + i * size + places[c].offset);
      };
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        store(places[c].scalar, scalarOf(places[c], given[c], old, i),
              made.parameters[p].bytes.data() + i * size + places[c].offset);
      }
    }
  }
  return made;
}

}  // namespace

Inputs inputsNear(const Subject& subject, const Ranges& ranges, const Inputs& centres, std::int64_t count,
                  unsigned seed) {
  Numbers numbers(seed);
  const auto known = static_cast<std::size_t>(centres.extent.domain.size());
  return madeFrom(
      subject, ranges, centres, count,
      [&](const ScalarPlace& place, const std::optional<Range>& range, const auto& old, std::size_t i) {
        const double centre = old(i % known);
        if (i < known || !isDrawnReal(place.scalar, range) || !std::isfinite(centre)) return centre;
        const double u = numbers.unit(), side = 2 * numbers.unit() - 1;
        if (u < 0.25) return centre;  // so that others change alone
        const double ulp = ulpOf(place.scalar, centre);
        const double near = u < 0.5 ? centre + std::round(8 * side) * ulp
                                    : centre + centre * side * std::exp2(-24 * numbers.unit());
        return range ? std::clamp(near, range->low, range->high) : near;
      });
}

Inputs inputsBetween(const Subject& subject, const Inputs& ends, std::int64_t countOfEach) {
  const std::int64_t pairs = ends.extent.domain.size() / 2;
  return madeFrom(subject, {}, ends, pairs * countOfEach,
                  [&](const ScalarPlace& place, const std::optional<Range>&, const auto& old, std::size_t i) {
                    const std::size_t pair = i / static_cast<std::size_t>(countOfEach);
                    const std::size_t step = i % static_cast<std::size_t>(countOfEach);
                    const double low = old(2 * pair), high = old(2 * pair + 1);
                    if (!isReal(place.scalar)) return low;
                    return low + (high - low) * (static_cast<double>(step) + 0.5) /
                                     static_cast<double>(countOfEach);
                  });
}

std::vector<std::vector<double>> drawnReals(const Subject& subject, const Ranges& ranges,
                                            const Inputs& inputs) {
  std::vector<std::vector<double>> all;
  for (std::size_t p = 0; p < inputs.parameters.size(); ++p) {
    const Parameter& parameter = subject.parameters()[p];
    if (parameter.role != Role::Input) continue;
    const std::vector<std::optional<Range>> given = ranges.of(parameter);
    const std::vector<ScalarPlace> places = scalarsOf(*parameter.element);
    for (std::size_t c = 0; c < places.size(); ++c) {
      if (!isDrawnReal(places[c].scalar, given[c])) continue;
      std::vector<double>& values =
          all.emplace_back(static_cast<std::size_t>(inputs.parameters[p].shape.size()));
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = load(places[c].scalar,
                         inputs.parameters[p].bytes.data() + i * parameter.element->size + places[c].offset);
      }
    }
  }
  return all;
}

int rankOf(const Subject& subject) {
  int rank = 1;
  for (const Parameter& parameter : subject.parameters()) {
    if (parameter.role == Role::Gather) rank = std::max<int>(rank, parameter.rank);
    if (parameter.role == Role::Iterator) rank = std::max<int>(rank, parameter.element->fields[0].width);
  }
  return rank;
}

sk::Shape shapeOf(std::span<const std::int64_t> extents) {
  sk::Shape shape{1};
  if (extents.size() == 2) shape = {1, 1};
  if (extents.size() == 3) shape = {1, 1, 1};
  if (extents.size() == 4) shape = {1, 1, 1, 1};
  for (int d = 0; d < shape.rank(); ++d) shape = shape.with(d, extents[static_cast<std::size_t>(d)]);
  return shape;
}

sk::Shape cubeOf(int rank, std::int64_t count) {
  auto side = static_cast<std::int64_t>(std::floor(std::pow(static_cast<double>(count), 1.0 / rank)));
  while (std::pow(static_cast<double>(side), rank) < static_cast<double>(count)) ++side;
  return shapeOf(std::vector<std::int64_t>(static_cast<std::size_t>(rank), side));
}

bool hasDrawnValues(const Subject& subject, const Ranges& ranges) {
  for (const Parameter& parameter : subject.parameters()) {
    if (parameter.role != Role::Uniform) continue;
    const std::vector<std::optional<Range>> given = ranges.of(parameter);
    const auto isDrawn = [](const std::optional<Range>& range) { return !range || !range->isValue(); };
    if (std::any_of(given.begin(), given.end(), isDrawn)) return true;
  }
  return false;
}

std::size_t extremeScalars(const Subject& subject, const Ranges& ranges, Extremes extremes) {
  std::size_t count = 0;
  for (const Parameter& parameter : subject.parameters()) {
    const bool isElement = parameter.role == Role::Input || parameter.role == Role::Gather;
    const bool isOfElements = extremes == Extremes::InElements || extremes == Extremes::AtExponents;
    const bool counts = isOfElements ? isElement : parameter.role == Role::Uniform;
    if (!counts || extremes == Extremes::None) continue;
    const std::vector<std::optional<Range>> given = ranges.of(parameter);
    const std::vector<ScalarPlace> places = scalarsOf(*parameter.element);
    for (std::size_t c = 0; c < places.size(); ++c) {
      count += isDrawnReal(places[c].scalar, given[c]) ? 1 : 0;
    }
  }
  return count;
}

std::string indexOf(const Inputs& inputs, std::size_t result) {
  return indexText(inputs.extent.results, static_cast<std::int64_t>(result));
}

Json inputsOf(const Subject& subject, const Inputs& inputs, int draw, std::size_t result) {
  Json json = Json::object();
  const std::int64_t element = inputs.elements[result];
  for (std::size_t p = 0; p < inputs.parameters.size(); ++p) {
    const Parameter& parameter = subject.parameters()[p];
    const ParameterInput& input = inputs.parameters[p];
    if (isResult(parameter) || input.isAbsent) continue;
    std::string name(parameter.name);
    if (parameter.role == Role::Iterator) {
      json[name] = {{"index", indexText(inputs.extent.domain, element)}};
      continue;
    }
    if (parameter.role == Role::Gather) {
      if (input.shape != inputs.extent.domain) continue;
      name += fmt::format("[{}]", indexText(input.shape, element));
    }
    const std::optional<std::int64_t> number =
        isValue(parameter) ? draw : numberIn(input.shape, inputs.extent.domain, element);
    if (!number) continue;
    const auto at = static_cast<std::size_t>(*number);
    const std::byte* bytes = input.bytes.data() + at * parameter.element->size;
    for (const ScalarPlace& place : scalarsOf(*parameter.element)) {
      json[name + place.member + place.component] =
          jsonOf(place.scalar, load(place.scalar, bytes + place.offset));
    }
  }
  return json;
}

}  // namespace sk_tool
