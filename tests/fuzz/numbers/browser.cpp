// SPDX-License-Identifier: MIT
#include "numbers/browser.hpp"

#include <bit>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "browser_page.hpp"
#include "numbers/devices.hpp"
#include "numbers/operations.hpp"
#include "temporary_folder.hpp"

namespace fuzz::numbers {
namespace {

using Json = nlohmann::json;

const char* nameOf(Element element) {
  switch (element) {
    case Element::Float: return "float";
    case Element::Float3: return "float3";
    case Element::Double: return "double";
    case Element::Int: return "int";
    case Element::Uint: break;
  }
  return "uint";
}

Json wordsOf(Element element, const Values& values) {
  Json words = Json::array();
  for (const double x : values) {
    switch (element) {
      case Element::Float:
      case Element::Float3: words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(x))); break;
      case Element::Double: {
        const auto bits = std::bit_cast<std::uint64_t>(x);
        words.push_back(static_cast<std::uint32_t>(bits));
        words.push_back(static_cast<std::uint32_t>(bits >> 32U));
        break;
      }
      case Element::Int: words.push_back(static_cast<std::uint32_t>(static_cast<std::int32_t>(x))); break;
      case Element::Uint: words.push_back(static_cast<std::uint32_t>(x)); break;
    }
  }
  return words;
}

Values valuesOf(Element element, const Json& words) {
  Values values;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto word = words[i].get<std::uint32_t>();
    switch (element) {
      case Element::Float:
      case Element::Float3: values.push_back(std::bit_cast<float>(word)); break;
      case Element::Double: {
        const std::uint64_t high = words[++i].get<std::uint32_t>();
        values.push_back(std::bit_cast<double>(high << 32U | word));
        break;
      }
      case Element::Int: values.push_back(static_cast<std::int32_t>(word)); break;
      case Element::Uint: values.push_back(word); break;
    }
  }
  return values;
}

Json jsonOf(const Case& one, std::uint64_t number) {
  const Operation& operation = operationNamed(one.operation);
  Json json{{"number", number},
            {"operation", one.operation},
            {"options", Json::parse(optionsInBrowsers(one))},
            {"view", one.view == View::Box       ? "box"
                     : one.view == View::Strided ? "strided"
                                                 : "whole"},
            {"isValue", isToValue(one)}};
  for (std::size_t k = 0; k < one.inputs.size(); ++k) {
    const Parameter& parameter = operation.inputs[k];
    const bool isTable = parameter.role == Role::Table;
    const std::vector<std::int64_t> table{static_cast<std::int64_t>(one.inputs[k].size())};
    json["inputs"].push_back({{"type", nameOf(parameter.element)},
                              {"role", isTable                           ? "table"
                                       : parameter.role == Role::Uniform ? "uniform"
                                                                         : "elements"},
                              {"shape", isTable ? table : one.shape},
                              {"words", wordsOf(parameter.element, one.inputs[k])}});
  }
  const std::vector<std::vector<std::int64_t>> shapes = outputShapes(one);
  for (std::size_t k = 0; k < shapes.size(); ++k)
    json["outputs"].push_back({{"type", nameOf(operation.outputs[k])}, {"shape", shapes[k]}});
  return json;
}

}  // namespace

std::map<std::uint64_t, BrowserResult> runInBrowser(std::span<const Case> cases) {
  const TemporaryFolder folder;
  const std::string command = std::string(SK_SKC " --emit=js -W no-everything -o '") +
                              folder.path().string() +
                              "' '" SK_SOURCE_FOLDER "/tests/fuzz/numbers/adversary.sk'";
  if (std::system(command.c_str()) != 0)
    throw std::runtime_error("skc does not compile adversary.sk for browsers");
  Json list = Json::array();
  for (std::size_t i = 0; i < cases.size(); ++i) list.push_back(jsonOf(cases[i], i));
  std::ofstream(folder.path() / "cases.json") << list.dump();
  std::map<std::uint64_t, BrowserResult> results;
  for (const auto& [number, text] : reportsOf(folder.path(), "numbers/cases.mjs")) {
    if (!text.starts_with('[')) {
      results[number] = text;
      continue;
    }
    const Json words = Json::parse(text);
    std::vector<Values> values;
    const Operation& operation = operationNamed(cases[number].operation);
    for (std::size_t k = 0; k < words.size(); ++k) values.push_back(valuesOf(operation.outputs[k], words[k]));
    results[number] = std::move(values);
  }
  return results;
}

}  // namespace fuzz::numbers
