// SPDX-License-Identifier: MIT
//
// The numbers of files that programs write.
#include <algorithm>
#include <cctype>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sk/npy.hpp"
#include "tune/application.hpp"

namespace sk_tool::tune {

namespace {

using sk::results::Series;
using sk::results::Values;

std::string extensionOf(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

Values valuesOf(const std::vector<double>& numbers) {
  return {
      .kind = Values::Kind::Double,
      .bytes = std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double))};
}

/// Appends all numbers in a value of JSON, in their order.
void appendNumbers(const nlohmann::json& value, std::vector<double>& numbers) {
  if (value.is_number()) numbers.push_back(value.get<double>());
  if (value.is_null()) numbers.push_back(std::numeric_limits<double>::quiet_NaN());  // what JSON has for NaN
  if (!value.is_structured()) return;
  for (const auto& each : value) appendNumbers(each, numbers);
}

/// The names in an object, for a message.
std::string namesIn(const nlohmann::json& value) {
  std::string names;
  if (value.is_object()) {
    for (const auto& [name, member] : value.items()) names += (names.empty() ? "" : ", ") + name;
  }
  return names.empty() ? "no members" : names;
}

std::vector<double> numbersIn(const ResultFile& file) {
  std::ifstream in(file.file);
  nlohmann::json value = nlohmann::json::parse(in, nullptr, /*allow_exceptions=*/false);
  if (value.is_discarded()) throw std::runtime_error(fmt::format("'{}' is no JSON", file.file));
  std::string rest = file.path;
  while (!rest.empty()) {
    const std::size_t end = rest.find('.');
    const std::string name = rest.substr(0, end);
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
    const bool isNumber =
        !name.empty() && std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c); });
    const bool isIndex = value.is_array() && isNumber && std::stoul(name) < value.size();
    if (!isIndex && !(value.is_object() && value.contains(name))) {
      throw std::runtime_error(fmt::format("'{}' has no '{}' (of '{}'); there are {}", file.file, name,
                                           file.path, namesIn(value)));
    }
    value = isIndex ? nlohmann::json(value[std::stoul(name)]) : nlohmann::json(value[name]);
  }
  std::vector<double> numbers;
  appendNumbers(value, numbers);
  if (numbers.empty())
    throw std::runtime_error(fmt::format("'{}' in '{}' is no number and has none", file.path, file.file));
  return numbers;
}

}  // namespace

bool ResultFile::isPicture() const {
  const std::string extension = extensionOf(file);
  return extension != ".npy" && path.empty() && extension != ".json";
}

Series seriesOf(const ResultFile& file) {
  std::vector<double> numbers;
  if (file.isPicture()) {
    numbers = pictureIn(file.file);
  } else if (extensionOf(file.file) == ".npy" && file.path.empty()) {
    numbers = sk::readNpy(file.file).values;
  } else {
    numbers = numbersIn(file);
  }
  Series series{.name = file.name(), .reads = 1};
  series.first.push_back(valuesOf(numbers));
  series.hash = std::hash<std::string>()(series.first.front().bytes);
  return series;
}

}  // namespace sk_tool::tune
