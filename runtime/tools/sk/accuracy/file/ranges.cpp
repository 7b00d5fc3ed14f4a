// SPDX-License-Identifier: MIT
#include "accuracy/file/ranges.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "sk/narrow.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk_tool {

namespace {

using sk::program::Parameter;

[[noreturn]] void refuse(const std::string& option, const std::string& text, const char* wanted) {
  throw std::runtime_error(fmt::format("{} '{}' says nothing; write {}", option, text, wanted));
}

/// Parses a number, "true" or "false".
std::optional<double> numberIn(const std::string& text) {
  if (text == "true" || text == "false") return text == "true" ? 1 : 0;
  std::size_t read = 0;
  try {
    const double number = std::stod(text, &read);
    return read == text.size() && std::isfinite(number) ? std::optional(number) : std::nullopt;
  } catch (const std::logic_error&) {  // not a number, or out of the range of doubles
    return std::nullopt;
  }
}

bool isNamed(const Parameter& parameter, const ScalarPlace& place, const std::string& name) {
  return name == parameter.name || name == std::string(parameter.name) + place.member;
}

/// The number of scalars of a parameter with that name.
std::size_t scalarsNamed(const Parameter& parameter, const std::string& name) {
  const std::vector<ScalarPlace> places = scalarsOf(*parameter.element);
  return static_cast<std::size_t>(std::count_if(places.begin(), places.end(), [&](const ScalarPlace& place) {
    return isNamed(parameter, place, name);
  }));
}

/// All names that options may use.
std::string namesOf(std::span<const Subject> subjects) {
  std::vector<std::string> names;
  for (const Subject& subject : subjects) {
    for (const Parameter& parameter : subject.parameters()) {
      const std::string name(parameter.name);
      if (!isResult(parameter) && std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
    }
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

void Ranges::addRange(const std::string& text) {
  constexpr const char* wanted = "PARAM=LO:HI with numbers LO <= HI";
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.find(':', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || colon == std::string::npos) refuse("--range", text, wanted);
  const auto low = numberIn(text.substr(equals + 1, colon - equals - 1));
  const auto high = numberIn(text.substr(colon + 1));
  if (!low || !high || *low > *high) refuse("--range", text, wanted);
  byName_[text.substr(0, equals)] = {Range{*low, *high}};
}

void Ranges::addValues(const std::string& text) {
  constexpr const char* wanted = "PARAM=VALUE, or PARAM=VALUE,VALUE... for a vector, a struct or an array";
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse("--set", text, wanted);
  std::istringstream list(text.substr(equals + 1));
  std::vector<Range> values;
  for (std::string word; std::getline(list, word, ',');) {
    const auto value = numberIn(word);
    if (!value) refuse("--set", text, wanted);
    values.push_back(Range{*value, *value});
  }
  if (values.empty()) refuse("--set", text, wanted);
  byName_[text.substr(0, equals)] = values;
}

void Ranges::check(std::span<const Subject> subjects) const {
  for (const auto& [name, ranges] : byName_) {
    std::size_t scalars = 0;
    for (const Subject& subject : subjects) {
      for (const Parameter& parameter : subject.parameters()) {
        if (isResult(parameter)) continue;
        scalars = std::max(scalars, scalarsNamed(parameter, name));
      }
    }
    if (scalars == 0) {
      throw std::runtime_error(
          fmt::format("there is no parameter '{}' to draw or set; there are {}", name, namesOf(subjects)));
    }
    if (ranges.size() != 1 && ranges.size() != scalars) {
      throw std::runtime_error(
          fmt::format("'{}' has {} scalar(s), but {} values are given; give one for each, or one for all",
                      name, scalars, ranges.size()));
    }
  }
}

std::vector<std::optional<Range>> Ranges::of(const Parameter& parameter) const {
  std::vector<std::optional<Range>> ranges;
  std::map<std::string, std::size_t> next;
  for (const ScalarPlace& place : scalarsOf(*parameter.element)) {
    std::optional<Range> range;
    for (const auto& [name, given] :
         byName_) {  // sorted: a member's name follows that of the whole parameter
      if (!isNamed(parameter, place, name)) continue;
      range = given.size() == 1 ? given.front() : given[std::min(next[name]++, given.size() - 1)];
    }
    if (!range) range = declaredRange(parameter, place.scalar);
    ranges.push_back(range);
  }
  return ranges;
}

std::string Ranges::text(const Subject& subject) const {
  std::string text;
  for (const auto& [name, ranges] : byName_) {
    text += fmt::format("{}{} ", text.empty() ? "" : ", ", name);
    if (ranges.size() == 1 && !ranges.front().isValue()) {
      fmt::format_to(std::back_inserter(text), "in [{:g}, {:g}]", ranges.front().low, ranges.front().high);
      continue;
    }
    text += "= ";
    for (const Range& value : ranges)
      text += fmt::format("{}{:g}", &value == &ranges.front() ? "" : ", ", value.low);
  }
  for (const Parameter& parameter : subject.parameters()) {
    if (!parameter.range || isResult(parameter) || byName_.contains(std::string(parameter.name))) continue;
    text += fmt::format("{}{} in [{:g}, {:g}] as declared", text.empty() ? "" : ", ", parameter.name,
                        parameter.range->low, parameter.range->high);
  }
  return text;
}

namespace {

using sk::program::Scalar;

/// Calls visit(T()) with the C++ type of a scalar; a bool is a byte.
template <class Visit>
auto withType(Scalar scalar, Visit&& visit) {
  switch (scalar) {
    case Scalar::Bool: return visit(std::uint8_t());
    case Scalar::Int: return visit(std::int32_t());
    case Scalar::Uint: return visit(std::uint32_t());
    case Scalar::Double: return visit(double());
    case Scalar::Long: return visit(std::int64_t());
    case Scalar::Ulong: return visit(std::uint64_t());
    case Scalar::Half: return visit(sk::half(0.0F));
    case Scalar::Char: return visit(std::int8_t());
    case Scalar::Uchar: return visit(std::uint8_t());
    case Scalar::Short: return visit(std::int16_t());
    case Scalar::Ushort: return visit(std::uint16_t());
    case Scalar::Unorm8: return visit(sk::unorm8(0.0F));
    case Scalar::Snorm8: return visit(sk::snorm8(0.0F));
    case Scalar::Unorm16: return visit(sk::unorm16(0.0F));
    case Scalar::Snorm16: return visit(sk::snorm16(0.0F));
    case Scalar::Float: break;
  }
  return visit(float());
}

template <class T>
T nearest(double value) {
  if constexpr (std::is_integral_v<T>) {
    using Limits = std::numeric_limits<T>;
    const double whole = std::round(value);
    const double past =
        std::ldexp(1.0, Limits::digits);  // a double has no room for the largest integer of 64 bits
    if (whole >= past) return Limits::max();
    return static_cast<T>(std::max(whole, static_cast<double>(Limits::min())));
  } else if constexpr (std::is_same_v<T, double>) {
    return value;
  } else {
    return T(static_cast<float>(value));
  }
}

struct FloatFormat {
  int digits;  ///< bits of the significand
  int smallest;  ///< exponent of the smallest normal number
};

FloatFormat formatOf(Scalar scalar) {
  if (scalar == Scalar::Double) return {53, -1022};
  if (scalar == Scalar::Half) return {11, -14};
  return {24, -126};
}

/// The largest number that is drawn: differences of two must be finite.
double largestOf(Scalar scalar) {
  if (scalar == Scalar::Half) return 65504;
  if (scalar == Scalar::Float) return std::numeric_limits<float>::max();
  return std::numeric_limits<double>::max() / 4;
}

/// The distance between values of a fixed-point type from -1 or 0 to 1; 0 for floating-point types.
double stepOf(Scalar scalar) {
  if (scalar == Scalar::Unorm8) return 1.0 / 255;
  if (scalar == Scalar::Snorm8) return 1.0 / 127;
  if (scalar == Scalar::Unorm16) return 1.0 / 65535;
  return scalar == Scalar::Snorm16 ? 1.0 / 32767 : 0;
}

}  // namespace

std::vector<ScalarPlace> scalarsOf(const sk::program::Element& element) {
  std::vector<ScalarPlace> places;
  for (const sk::program::Field& field : element.fields) {
    const bool isVectorPart = field.part >= 0 && sk::program::is64Bit(field.scalar);
    const bool isRow = field.part >= 0 && !isVectorPart;
    const std::string member = field.path.empty() || field.path.front() == '['
                                   ? std::string(field.path)
                                   : fmt::format(".{}", field.path);
    for (std::size_t c = 0; c < field.width; ++c) {
      const std::size_t letter = c + (isVectorPart ? 2U * static_cast<std::size_t>(field.part) : 0);
      std::string component = isRow ? fmt::format("[{}]", field.part) : "";
      if (field.width > 1 || isVectorPart) component += fmt::format(".{}", "xyzw"[letter]);
      places.push_back(
          {member, component, field.scalar, field.offset + c * sk::program::hostBytes(field.scalar)});
    }
  }
  return places;
}

bool isReal(Scalar scalar) {
  return scalar == Scalar::Float || scalar == Scalar::Double || scalar == Scalar::Half || stepOf(scalar) > 0;
}

std::optional<Range> declaredRange(const Parameter& parameter, Scalar scalar) {
  if (!parameter.range) return std::nullopt;
  const sk::program::ValueRange promise = *parameter.range;
  if (parameter.role == sk::program::Role::Spec) {
    const double value = std::clamp(1.0, promise.low, promise.high);
    return Range{value, value, promise};
  }
  const double most = largestOf(scalar), far = isReal(scalar) ? 1e4 : 8;
  double low = std::max(promise.low, -most), high = std::min(promise.high, most);
  if (std::isinf(promise.low) && std::isinf(promise.high)) return std::nullopt;
  if (std::isinf(promise.high))
    high = std::min(isReal(scalar) && low > 0 ? low * far : std::max(low, 0.0) + far, most);
  if (std::isinf(promise.low))
    low = std::max(isReal(scalar) && high < 0 ? high * far : std::min(high, 0.0) - far, -most);
  return Range{low, high, promise};
}

double load(Scalar scalar, const std::byte* from) {
  return withType(scalar, [from](auto value) {
    std::memcpy(&value, from, sizeof value);
    if constexpr (std::is_arithmetic_v<decltype(value)>) {
      return static_cast<double>(value);
    } else {
      return static_cast<double>(static_cast<float>(value));
    }
  });
}

void store(Scalar scalar, double value, std::byte* to) {
  if (scalar == Scalar::Bool) value = value != 0 ? 1 : 0;
  withType(scalar, [value, to](auto kind) {
    const auto stored = nearest<decltype(kind)>(value);
    std::memcpy(to, &stored, sizeof stored);
  });
}

double roundedTo(Scalar scalar, double value) {
  std::byte memory[sizeof(double)];
  store(scalar, value, memory);
  return load(scalar, memory);
}

double ulpOf(Scalar scalar, double value) {
  if (const double step = stepOf(scalar); step > 0) return step;
  const FloatFormat format = formatOf(scalar);
  int exponent = 0;
  std::frexp(value, &exponent);
  exponent = value == 0 ? format.smallest : std::max(exponent - 1, format.smallest);
  return std::ldexp(1.0, exponent - format.digits + 1);
}

double smallestOf(Scalar scalar) {
  const double step = stepOf(scalar);
  return step > 0 ? step : std::ldexp(1.0, formatOf(scalar).smallest);
}

std::string hexOf(Scalar scalar, double value) {
  if (scalar == Scalar::Bool) return value != 0 ? "true" : "false";
  if (std::isnan(value)) return "nan";
  return isReal(scalar) ? fmt::format("{:a}", value) : fmt::format("{}", value);
}

Json jsonOf(Scalar scalar, double value) {
  Json json = {{"value", std::isfinite(value) ? Json(value) : Json(nullptr)}, {"hex", hexOf(scalar, value)}};
  if (scalar == Scalar::Float) {
    json["bits"] = fmt::format("0x{:08x}", std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }
  return json;
}

}  // namespace sk_tool
