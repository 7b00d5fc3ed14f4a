// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "csv_records.hpp"
#include "data.hpp"

namespace examples {
namespace {

using Records = std::vector<std::vector<std::string>>;

Records split(std::string_view text, char separator = ',') {
  CsvRecords reader(text, separator, "t.csv");
  Records records;
  for (std::vector<std::string> fields; reader.next(fields);) records.push_back(fields);
  return records;
}

Data parse(const std::string& text, const CsvOptions& options = {}) {
  const auto file = std::filesystem::temp_directory_path() / "sk_csv_test.csv";
  std::ofstream(file, std::ios::binary) << text;
  return readCsv(file, options);
}

TEST_CASE("short lines are filled up, but not to many times what the file holds") {
  std::string lines;
  for (int i = 0; i < 5000; ++i) lines += "1\n";
  CHECK(parse("a" + std::string(100, ',') + "\n" + lines).columns.size() == 101);
  CHECK_THROWS_WITH(parse("a" + std::string(5000, ',') + "\n" + lines),
                    Catch::Contains("nearly all lines lack nearly all columns of the first one"));
}

TEST_CASE("fields and records") {
  CHECK(split("a,b\n1,2\n") == Records{{"a", "b"}, {"1", "2"}});
  CHECK(split("a,b\r\n1,2") == Records{{"a", "b"}, {"1", "2"}});
  CHECK(split("a,,\n,\n") == Records{{"a", "", ""}, {"", ""}});
  CHECK(split("\"a,\"\"b\"\"\",\"c\nd\"\n") == Records{{"a,\"b\"", "c\nd"}});
  CHECK(split("\n\n a \n\r\n \n") == Records{{" a "}});
  CHECK(split("a;b", ';') == Records{{"a", "b"}});
  CHECK(split("\xEF\xBB\xBF"
              "a") == Records{{"a"}});
  CHECK(split("a,b\r1,2\r") == Records{{"a", "b"}, {"1", "2"}});
  CHECK(split("a\r\r\n\nb,\rc") == Records{{"a"}, {"b", ""}, {"c"}});
  CHECK(split("\"a\rb\"\rc") == Records{{"a\rb"}, {"c"}});
  CHECK(split("").empty());
}

TEST_CASE("lines are counted through quoted line ends") {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string text = "\"a" + end + "b\"" + end + end + "c" + end;
    CsvRecords reader(text, ',', "t.csv");
    std::vector<std::string> fields;
    REQUIRE(reader.next(fields));
    CHECK(reader.line() == 1);
    REQUIRE(reader.next(fields));
    CHECK(reader.line() == 4);
  }
}

TEST_CASE("quotes and numbers of fields that are wrong") {
  CHECK_THROWS_WITH(split("a\n\"b"), "t.csv:2: a quote is opened but never closed");
  CHECK_THROWS_WITH(parse("a,b\n1,2,\n3,4,5\n"), Catch::Contains(":3: 3 fields, but the first line has 2"));
  CHECK_THROWS_WITH(split("a\n\"b\"c"), Catch::StartsWith("t.csv:2: text follows a closing quote"));
}

TEST_CASE("numbers, missing ones and text") {
  const Data data = parse("x, note,y\n 1.5 ,p,+2\nNA,q,\n-3e2,\"r\"\n");
  REQUIRE(data.columns.size() == 2);
  CHECK(data.textColumns == std::vector<std::string>{"note"});
  CHECK(data.columns[0].name == "x");
  CHECK(data.columns[0].values[0] == 1.5f);
  CHECK(std::isnan(data.columns[0].values[1]));
  CHECK(data.columns[0].values[2] == -300.0f);
  CHECK(data.columns[1].values[0] == 2.0f);
  CHECK(std::isnan(data.columns[1].values[2]));
}

TEST_CASE("without a header, columns are numbered") {
  const Data data = parse("1,2\n3,4\n");
  REQUIRE(data.columns.size() == 2);
  CHECK(data.columns[1].name == "column 2");
  CHECK(data.columns[1].values == std::vector<float>{2.0f, 4.0f});
}

TEST_CASE("selected columns come in the order asked for") {
  const Data data = parse("a,b,c\n1,2,3\n", {.select = {"c", "a"}});
  REQUIRE(data.columns.size() == 2);
  CHECK(data.columns[0].values.front() == 3.0f);
  CHECK(data.columns[1].values.front() == 1.0f);
}

TEST_CASE("what float cannot hold") {
  CHECK(parse("a\n1e-40\n").columns[0].values.front() == 0.0f);
  CHECK(parse("a\n1e-400\n").columns[0].values.front() == 0.0f);
  CHECK(std::isinf(parse("a\n-inf\n").columns[0].values.front()));
  CHECK(parse("id,a\n12D5,1\n").textColumns == std::vector<std::string>{"id"});
  CHECK_THROWS_WITH(parse("a\n1\n1e400\n"), Catch::Contains(":3: column 'a': '1e400' is no number"));
  CHECK_THROWS_WITH(parse("a\n1\n+-1\n"), Catch::Contains(":3: column 'a': '+-1' is no number"));
  CHECK_THROWS_WITH(parse("a\n1\n1e39\n"), Catch::Contains(":3: column 'a': '1e39' is no number"));
  CHECK_THROWS_WITH(parse("a\n1\n1.5.2\n"), Catch::Contains(":3: column 'a': '1.5.2' is no number"));
  CHECK_THROWS_WITH(parse("a\nx\n", {.select = {"a"}}), Catch::Contains(":2: column 'a': 'x' is no number"));
}

TEST_CASE("files without data") {
  CHECK_THROWS_WITH(parse(""), Catch::Contains("is empty"));
  CHECK_THROWS_WITH(parse("\n\n"), Catch::Contains("nothing but blank lines"));
  CHECK_THROWS_WITH(parse("a,b\n"), Catch::Contains("a header but no data"));
  CHECK_THROWS_WITH(parse("a\nx\n"), Catch::Contains("no column of numbers"));
  CHECK_THROWS_WITH(parse(std::string("a\n1\0\n", 5)), Catch::Contains("is no text (byte 4 is 0)"));
}

TEST_CASE("a line of ten megabytes") {
  std::string text = "a\n";
  for (int i = 0; i < 5; ++i) text += "1";
  text += ",";
  text.resize(text.size() + 10'000'000, ' ');
  text += "\n2\n";
  CHECK(parse(text).columns[0].values == std::vector<float>{11111.0f, 2.0f});
}

}  // namespace
}  // namespace examples
