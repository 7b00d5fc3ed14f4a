// SPDX-License-Identifier: MIT
//
// stats DATA.csv|DATA.bin: what the columns of a table are like.
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <sk/sk.hpp>

#include "column_statistics.hpp"
#include "data.hpp"
#include "support/application.hpp"
#include "support/stopwatch.hpp"
#include "support/table.hpp"

namespace {

enum class NanPolicy : std::uint8_t { Skip, Propagate };

struct Settings {
  std::filesystem::path file;
  std::filesystem::path made = "weather.csv";
  std::string separator = ",";
  std::vector<std::string> select;
  int columns = 1;
  examples::BinaryOrder order = examples::BinaryOrder::Rows;
  NanPolicy nan = NanPolicy::Skip;
};

void addOptions(CLI::App& cli, Settings& s) {
  const std::map<std::string, examples::BinaryOrder> orders = {{"rows", examples::BinaryOrder::Rows},
                                                               {"columns", examples::BinaryOrder::Columns}};
  const std::map<std::string, NanPolicy> policies = {{"skip", NanPolicy::Skip},
                                                     {"propagate", NanPolicy::Propagate}};
  cli.add_option("data", s.file,
                 "CSV, or raw little-endian floats if it ends in .bin (default: readings of a made-up "
                 "weather station, written to weather.csv)");
  cli.add_option("--made", s.made, "where to write them (default: weather.csv)");
  cli.add_option("--separator", s.separator,
                 "between the fields of CSV; 'tab' for a tabulator (default: a comma)");
  cli.add_option("--select", s.select,
                 "columns of CSV to read, with commas between (default: all with numbers)")
      ->delimiter(',');
  cli.add_option("--columns", s.columns, "numbers in a row of a .bin file (default: 1)")
      ->check(CLI::Range(1, 100'000));
  cli.add_option("--order", s.order,
                 "of a .bin file: row after row, or column after column: rows, columns (default: rows)")
      ->transform(CLI::CheckedTransformer(orders).description(""));
  cli.add_option(
         "--nan", s.nan,
         "a missing number is left out, or makes its column's results NaN: skip, propagate (default: skip)")
      ->transform(CLI::CheckedTransformer(policies).description(""));
}

char separatorOf(const std::string& text) {
  if (text == "tab") return '\t';
  if (text.size() == 1 && text != "\"" && text != "\n" && text != "\r") return text.front();
  throw std::runtime_error(
      fmt::format("--separator '{}' is no single character; quotes and line ends cannot be one", text));
}

examples::Data read(Settings& s) {
  if (s.file.empty()) {
    examples::writeWeather(s.made);
    fmt::print("no data was given, so some were made: {}\n", s.made.string());
    s.file = s.made;
  }
  if (s.file.extension() == ".bin") return examples::readBinary(s.file, s.columns, s.order);
  return examples::readCsv(s.file, {separatorOf(s.separator), s.select});
}

std::string cell(double value, bool known) {
  return known && !std::isnan(value) ? fmt::format("{:.7g}", value) : "NaN";
}

void addRow(examples::Table& table, const std::string& name, const examples::ColumnStatistics& s,
            NanPolicy policy) {
  const bool known = policy == NanPolicy::Skip || s.missing == 0;
  table.add({name, fmt::format("{}", s.count), fmt::format("{}", s.missing), cell(s.mean, known),
             cell(s.variance, known), cell(s.min, known), cell(s.max, known),
             known && s.argmax >= 0 ? fmt::format("{}", s.argmax + 1) : "none"});
}

void describe(examples::Application& app, Settings& s) {
  const examples::Data data = read(s);
  const auto rows = static_cast<std::int64_t>(data.columns.front().values.size());
  for (const std::string& name : data.textColumns)
    fmt::print("column '{}' holds no numbers and is left out\n", name);

  sk::Device device(app.device());
  examples::reduceColumn(device, data.columns.front().values);  // once unmeasured: programs are compiled
  std::vector<examples::ColumnStatistics> results;
  const examples::Stopwatch stopwatch;
  for (const examples::Column& column : data.columns)
    results.push_back(examples::reduceColumn(device, column.values));
  const double milliseconds = stopwatch.milliseconds();

  examples::Table table({"column", "count", "missing", "mean", "variance", "min", "max", "row of max"});
  for (std::size_t i = 0; i < results.size(); ++i) addRow(table, data.columns[i].name, results[i], s.nan);
  fmt::print("{}", table.text());
  app.report(fmt::format("{} columns of {} rows of {}", results.size(), rows, s.file.filename().string()),
             device.name(), milliseconds);
  examples::StatisticsChecks checks(rows);
  for (std::size_t i = 0; i < results.size(); ++i) {
    checks.compare(data.columns[i].values, results[i], static_cast<std::int64_t>(i));
  }
  for (const examples::Verification* check : {&checks.exact, &checks.means, &checks.variances})
    app.verified(*check);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  examples::Application app("stats", "Count, mean, variance, least and greatest of the columns of a table.");
  addOptions(app.options(), settings);
  return app.run(argc, argv, [&] { describe(app, settings); });
}
