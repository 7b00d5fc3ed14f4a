// SPDX-License-Identifier: MIT
//
// From the fields of CSV to columns of numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include "csv_records.hpp"
#include "data.hpp"
#include "support/text_cursor.hpp"

namespace examples {
namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

bool isMissing(std::string_view field) {
  constexpr std::array<std::string_view, 7> words = {"", "NA", "N/A", "NaN", "nan", "NULL", "null"};
  return std::find(words.begin(), words.end(), field) != words.end();
}

/// A number, NaN where it is missing, or nothing where the field is neither. Numbers too small for float's
/// normal range become 0, which is what a device may make of them anyhow.
std::optional<float> parseNumber(std::string_view field) {
  field = trimmed(field);
  if (isMissing(field)) return missing;
  const std::optional<double> value = numberIn(field);
  const bool isInfinity = value && field.find_first_of("iI") != std::string_view::npos;
  if (!value || (std::abs(*value) > double{std::numeric_limits<float>::max()} && !isInfinity))
    return std::nullopt;
  const auto rounded = static_cast<float>(*value);
  return std::fpclassify(rounded) == FP_SUBNORMAL ? 0.0f : rounded;
}

/// One column while its file is read.
struct Draft {
  std::string name;
  std::size_t field = 0;   ///< which field of a line it is
  bool selected = false;
  std::vector<float> values;
  std::size_t numbers = 0;
  std::int64_t strangeLine = 0;  ///< the first line whose field is no number; 0 if none
  std::string strange;
};

std::vector<Draft> draftsFromNames(const std::vector<std::string>& names, const CsvOptions& options,
                                   const std::string& file) {
  std::vector<Draft> drafts;
  const auto add = [&](std::size_t field, bool selected) {
    const std::string_view name = trimmed(names[field]);
    drafts.push_back({name.empty() ? fmt::format("column {}", field + 1) : std::string(name),
                      field,
                      selected,
                      {},
                      0,
                      0,
                      {}});
  };
  if (options.select.empty()) {
    for (std::size_t i = 0; i < names.size(); ++i) add(i, false);
    return drafts;
  }
  for (const std::string& wanted : options.select) {
    const auto found =
        std::find_if(names.begin(), names.end(), [&](const std::string& n) { return trimmed(n) == wanted; });
    if (found == names.end()) {
      throw std::runtime_error(
          fmt::format("'{}' has no column '{}'; it has {}", file, wanted, fmt::join(names, ", ")));
    }
    add(static_cast<std::size_t>(found - names.begin()), true);
  }
  return drafts;
}

void addRecord(std::vector<Draft>& drafts, const std::vector<std::string>& fields, std::int64_t line) {
  for (Draft& draft : drafts) {
    const std::string_view field =
        draft.field < fields.size() ? std::string_view(fields[draft.field]) : std::string_view();
    const std::optional<float> number = parseNumber(field);
    if (!number && draft.strangeLine == 0) {
      draft.strangeLine = line;
      draft.strange = field.substr(0, 40);
    }
    if (number && !std::isnan(*number)) ++draft.numbers;
    draft.values.push_back(number.value_or(missing));
  }
}

/// Short lines are filled up, which may take far more memory than the text, were there no end to it.
void checkFilling(std::size_t cells, std::size_t bytes, const std::string& file, std::int64_t line) {
  constexpr std::size_t free = 1'000'000, cellsPerByte = 16;
  if (cells <= free || (cells - free) / cellsPerByte <= bytes) return;
  throw std::runtime_error(
      fmt::format("{}:{}: nearly all lines lack nearly all columns of the first one; is the separator right?",
                  file, line));
}

Data finished(std::vector<Draft> drafts, const std::string& file) {
  Data data;
  for (Draft& draft : drafts) {
    if (draft.strangeLine == 0) {
      data.columns.push_back({std::move(draft.name), std::move(draft.values)});
    } else if (draft.numbers == 0 && !draft.selected) {
      data.textColumns.push_back(std::move(draft.name));
    } else {
      throw std::runtime_error(
          fmt::format("{}:{}: column '{}': '{}' is no number that a float can hold; correct it, "
                      "leave it empty, or choose other columns by --select",
                      file, draft.strangeLine, draft.name, draft.strange));
    }
  }
  if (data.columns.empty()) throw std::runtime_error(fmt::format("'{}' has no column of numbers", file));
  return data;
}

bool allNumbers(const std::vector<std::string>& fields) {
  return std::all_of(fields.begin(), fields.end(),
                     [](const std::string& f) { return parseNumber(f).has_value(); });
}

std::vector<std::string> numberedNames(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(fmt::format("column {}", i + 1));
  return names;
}

}  // namespace

Data readCsv(const std::filesystem::path& file, const CsvOptions& options) {
  const std::string name = file.string();
  const std::string text = readBytes(file);
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos) {
    throw std::runtime_error(fmt::format(
        "'{}' is no text (byte {} is 0); raw floats are read from files that end in .bin", name, zero + 1));
  }
  CsvRecords records(text, options.separator, name);
  std::vector<std::string> fields;
  if (!records.next(fields))
    throw std::runtime_error(fmt::format("'{}' holds nothing but blank lines", name));
  const bool headless = allNumbers(fields);
  const std::size_t width = fields.size();
  std::vector<Draft> drafts = draftsFromNames(headless ? numberedNames(width) : fields, options, name);
  if (headless) addRecord(drafts, fields, records.line());
  while (records.next(fields)) {
    while (fields.size() > width && trimmed(fields.back()).empty()) fields.pop_back();
    if (fields.size() > width) {
      throw std::runtime_error(fmt::format("{}:{}: {} fields, but the first line has {}", name,
                                           records.line(), fields.size(), width));
    }
    addRecord(drafts, fields, records.line());
    checkFilling(drafts.size() * drafts.front().values.size(), text.size(), name, records.line());
  }
  if (drafts.front().values.empty())
    throw std::runtime_error(fmt::format("'{}' has a header but no data", name));
  return finished(std::move(drafts), name);
}

}  // namespace examples
