// SPDX-License-Identifier: MIT
#include "numbers/case.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

namespace fuzz::numbers {
namespace {

using Json = nlohmann::json;

template <class Enum, std::size_t count>
using Names = std::array<std::pair<Enum, const char*>, count>;

constexpr Names<sk::Accumulate, 5> accumulateNames{{{sk::Accumulate::Default, "default"},
                                                    {sk::Accumulate::Tree, "tree"},
                                                    {sk::Accumulate::Compensated, "compensated"},
                                                    {sk::Accumulate::Extended, "extended"},
                                                    {sk::Accumulate::Exact, "exact"}}};
constexpr Names<sk::Precision, 5> precisionNames{{{sk::Precision::Default, "default"},
                                                  {sk::Precision::Half, "half"},
                                                  {sk::Precision::Single, "single"},
                                                  {sk::Precision::Extended, "extended"},
                                                  {sk::Precision::Double, "double"}}};
constexpr Names<sk::Storage, 5> storageNames{{{sk::Storage::Default, "default"},
                                              {sk::Storage::Half, "half"},
                                              {sk::Storage::Single, "single"},
                                              {sk::Storage::Extended, "extended"},
                                              {sk::Storage::Double, "double"}}};
constexpr Names<View, 4> viewNames{
    {{View::Whole, "whole"}, {View::Box, "box"}, {View::Strided, "strided"}, {View::Reshaped, "reshaped"}}};

template <class Enum, std::size_t count>
const char* nameOf(const Names<Enum, count>& names, Enum value) {
  for (const auto& [one, name] : names) {
    if (one == value) return name;
  }
  return "default";
}

template <class Enum, std::size_t count>
Enum named(const Names<Enum, count>& names, const std::string& name) {
  for (const auto& [value, one] : names) {
    if (one == name) return value;
  }
  throw std::runtime_error("a case has '" + name + "'");
}

std::string hexadecimal(double x) {
  if (std::isnan(x)) return "nan";
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%a", x);
  return text.data();
}

}  // namespace

int components(Element element) { return element == Element::Float3 ? 3 : 1; }

sk::Shape shapeOf(const std::vector<std::int64_t>& extents) {
  switch (extents.size()) {
    case 1: return {extents[0]};
    case 2: return {extents[0], extents[1]};
    case 3: return {extents[0], extents[1], extents[2]};
    case 4: return {extents[0], extents[1], extents[2], extents[3]};
    default: return {};
  }
}

std::string written(const Case& one) {
  Json json{{"operation", one.operation},
            {"accumulate", nameOf(accumulateNames, one.options.accumulate)},
            {"precision", nameOf(precisionNames, one.options.precision)},
            {"contraction", one.options.contraction == sk::Contraction::Fast ? "fast" : "exact"},
            {"scan", one.options.scan == sk::Scan::Exclusive ? "exclusive" : "inclusive"},
            {"along", one.options.along.value_or(-1)},
            {"view", nameOf(viewNames, one.view)},
            {"textureLimit", one.textureLimit},
            {"pairs", one.isPairs},
            {"storage", nameOf(storageNames, one.storage)},
            {"shape", one.shape},
            {"result", one.result},
            {"starts", one.starts}};
  for (const Values& values : one.inputs) {
    Json list = Json::array();
    for (const double value : values) list.push_back(hexadecimal(value));
    json["inputs"].push_back(std::move(list));
  }
  return json.dump(1, ' ');
}

Case parsed(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw std::runtime_error("this is no case");
  Case one;
  try {
    one.operation = json.at("operation");
    one.options.accumulate = named(accumulateNames, json.at("accumulate"));
    one.options.precision = named(precisionNames, json.at("precision"));
    if (json.at("contraction") == "fast") one.options.contraction = sk::Contraction::Fast;
    if (json.at("scan") == "exclusive") one.options.scan = sk::Scan::Exclusive;
    if (const int along = json.at("along"); along >= 0) one.options.along = along;
    one.view = named(viewNames, json.at("view"));
    one.textureLimit = json.at("textureLimit");
    one.isPairs = json.at("pairs");
    one.storage = named(storageNames, json.at("storage"));
    one.shape = json.at("shape").get<std::vector<std::int64_t>>();
    one.result = json.at("result").get<std::vector<std::int64_t>>();
    one.starts = json.at("starts").get<std::vector<std::int64_t>>();
    for (const Json& list : json.at("inputs")) {
      Values& values = one.inputs.emplace_back();
      for (const Json& value : list) values.push_back(std::strtod(value.get<std::string>().c_str(), nullptr));
    }
  } catch (const Json::exception& error) {
    throw std::runtime_error(std::string("this is no case: ") + error.what());
  }
  return one;
}

std::string optionsInBrowsers(const Case& one) {
  Json json = Json::object();
  const sk::CallOptions& options = one.options;
  if (options.accumulate != sk::Accumulate::Default)
    json["accumulate"] = nameOf(accumulateNames, options.accumulate);
  if (options.precision != sk::Precision::Default)
    json["precision"] = nameOf(precisionNames, options.precision);
  if (options.scan == sk::Scan::Exclusive) json["scan"] = "exclusive";
  if (options.along) json["along"] = *options.along;
  return json.dump();
}

std::string described(const Case& one) {
  std::string text = one.operation;
  const auto add = [&](const char* what, const std::string& value) {
    text += fmt::format(", {} {}", what, value);
  };
  if (one.options.accumulate != sk::Accumulate::Default)
    add("accumulate", nameOf(accumulateNames, one.options.accumulate));
  if (one.options.precision != sk::Precision::Default)
    add("precision", nameOf(precisionNames, one.options.precision));
  if (one.options.contraction == sk::Contraction::Fast) add("contraction", "fast");
  if (one.options.scan == sk::Scan::Exclusive) add("scan", "exclusive");
  if (one.options.along) add("along", std::to_string(*one.options.along));
  if (one.view != View::Whole) add("view", nameOf(viewNames, one.view));
  if (one.textureLimit != 0) add("texture limit", std::to_string(one.textureLimit));
  if (one.isPairs) add("doubles as", "pairs");
  if (one.storage != sk::Storage::Single) add("storage", nameOf(storageNames, one.storage));
  add("shape", fmt::format("{{{}}}", fmt::join(one.shape, ", ")));
  if (!one.result.empty()) add("to", fmt::format("{{{}}}", fmt::join(one.result, ", ")));
  if (!one.starts.empty()) add("rows from", fmt::format("{{{}}}", fmt::join(one.starts, ", ")));
  return text;
}

std::string shown(double x) {
  if (!std::isfinite(x) || (x == std::trunc(x) && std::fabs(x) < 1e6)) return fmt::format("{}", x);
  return fmt::format("{:.9g} ({})", x, hexadecimal(x));
}

}  // namespace fuzz::numbers
