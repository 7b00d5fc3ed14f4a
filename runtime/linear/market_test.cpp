// SPDX-License-Identifier: MIT
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "matrix_market.hpp"

namespace sk::linear {
namespace {

TEST_CASE("Matrix Market files of every kind are read") {
  const MarketFile general = parseMarket(
      "%%MatrixMarket matrix coordinate real general\n% a comment\n\n2 3 4\n2 3 -1.5e2\n1 1 2\n2 3 0.5\n  1 "
      "3 4 \n",
      "a.mtx");
  CHECK(general.duplicates == 1);
  CHECK(general.matrix.rows == 2);
  CHECK(general.matrix.columns == 3);
  CHECK(general.matrix.starts == std::vector<std::int64_t>{0, 2, 3});
  CHECK(general.matrix.column == std::vector<std::int32_t>{0, 2, 2});
  CHECK(general.matrix.value == std::vector<double>{2, 4, -149.5});

  const SparseMatrix symmetric =
      parseMarket("%%MatrixMarket matrix coordinate integer symmetric\n2 2 2\n1 1 3\n2 1 7\n", "a.mtx")
          .matrix;
  CHECK(symmetric.value == std::vector<double>{3, 7, 7});
  const SparseMatrix skew =
      parseMarket("%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 1\n2 1 7\n", "a.mtx").matrix;
  CHECK(skew.value == std::vector<double>{-7, 7});
  const SparseMatrix pattern =
      parseMarket("%%MatrixMarket matrix coordinate pattern general\n1 2 1\n1 2\n", "a.mtx").matrix;
  CHECK(pattern.value == std::vector<double>{1});
  const SparseMatrix array =
      parseMarket("%%matrixmarket MATRIX array real general\n2 2\n1\n2\n0\n4\n", "a.mtx").matrix;
  CHECK(array.starts == std::vector<std::int64_t>{0, 1, 3});
  CHECK(array.value == std::vector<double>{1, 2, 4});
  const SparseMatrix half =
      parseMarket("%%MatrixMarket matrix array real symmetric\n2 2\n1\n2\n4\n", "a.mtx").matrix;
  CHECK(half.value == std::vector<double>{1, 2, 2, 4});
  CHECK(parseMarket("%%MatrixMarket matrix coordinate real general\n0 0 0\n", "a.mtx").matrix.rows == 0);
}

TEST_CASE("Matrix Market files are in free format") {
  const std::string text =
      "%%MatrixMarket matrix coordinate real general\n% a comment\n3 3 4\n1 1 2\n2 2 4\n3 1 1\n3 3 8";
  const SparseMatrix wanted = parseMarket(text, "a.mtx").matrix;
  CHECK(wanted.value == std::vector<double>{2, 4, 1, 8});
  std::vector<std::string> same = {
      "\xEF\xBB\xBF" + text,
      "%%matrixmarket  Matrix   Coordinate\tReal General  \n3 3 4\n1 1 2\n2 2 4\n3 1 1\n3 3 8\n",
      "%%MATRIXMARKET MATRIX COORDINATE REAL GENERAL\n3 3 4\n1 1 2.0D+00\n2 2 0.4d1\n3 1 10D-1\n3 3 .8D+01\n",
      "%%MatrixMarket matrix coordinate double general\n%\n\n   \n%% another\n\t3\t3   4  \n\n   1 1 +2\n% "
      "among\n2\t2\t4.\t\n  3   1   1e+00 % "
      "behind\n3 3 0.8+001\n% at the end",
      "%%MatrixMarket matrix coordinate integer general\n+3 3 5\n3 3 5\n3 3 3\n1 1 2\n2 2 4\n3 1 1",
      "%%MatrixMarket matrix array real general\n% c\n3 3\n\n2\n0\n1\n\n0\n4\n0\n0\n0\n8\n"};
  for (const std::string end : {"\r\n", "\r"}) {
    same.emplace_back();
    for (const char c : text) same.back() += c == '\n' ? end : std::string(1, c);
  }
  for (const std::string& each : same) {
    CAPTURE(each);
    const SparseMatrix read = parseMarket(each, "a.mtx").matrix;
    CHECK(read.starts == wanted.starts);
    CHECK(read.column == wanted.column);
    CHECK(read.value == wanted.value);
  }
  // A skew-symmetric matrix has zeros on its diagonal, which a file may say.
  const SparseMatrix skew =
      parseMarket("%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 3\n1 1 0\n2 1 7\n2 2 -0.0\n",
                  "a.mtx")
          .matrix;
  CHECK(multiply(skew, std::vector<double>{1, 1}) == std::vector<double>{-7, 7});
}

TEST_CASE("Broken Matrix Market files are refused with their line and column") {
  const std::string head = "%%MatrixMarket matrix coordinate real general\n";
  const std::pair<std::string, std::string> cases[] = {
      {"", "a.mtx:1:1: this is no Matrix Market file"},
      {"2 2 1\n", "a.mtx:1:1: this is no Matrix Market file"},
      {"%%MatrixMarket tensor coordinate real general\n", "a.mtx:1:16: only the object 'matrix'"},
      {"%%MatrixMarket matrix coordinate complex general\n", "a.mtx:1:34: complex matrices"},
      {"%%MatrixMarket matrix coordinate real hermitian\n", "a.mtx:1:39: the symmetry is"},
      {"%%MatrixMarket matrix array pattern general\n", "an array has no pattern"},
      {head, "the line with the size is missing"},
      {head + "2 2\n", "a.mtx:2:4: the number of entries is missing"},
      {head + "-1 2 0\n", "cannot be stored"},
      {head + "2 2 1\n3 1 5\n", "a.mtx:3:1: there is no row 3; rows are from 1 to 2"},
      {head + "2 2 1\n0 1 5\n", "there is no row 0"},
      {head + "2 2 1\n1 4 5\n", "a.mtx:3:3: there is no column 4"},
      {head + "2 2 1\n1 1 nan\n", "a.mtx:3:5: 'nan' is not finite"},
      {head + "2 2 1\n1 1 five\n", "a.mtx:3:5: 'five' is no number"},
      {head + "2 2 1\n1 1\n", "the value is missing"},
      {head + "2 2 1\n1 1 2 3\n", "a.mtx:3:7: '3' is too much; an entry is ROW COLUMN VALUE"},
      {head + "2 2 1\n1 1 1e400\n", "a.mtx:3:5: '1e400' is not finite"},
      {"%%MatrixMarket matrix coordinate integer general\n2 2 1\n1 1 2.5\n",
       "a.mtx:3:5: '2.5' is no integer, which the first line promises"},
      {"%%MatrixMarket matrix array integer general\n1 1\n1e-1\n", "a.mtx:3:1: '1e-1' is no integer"},
      {head + "2 2 1\n1.0 1 2\n", "a.mtx:3:1: '1.0' is no integer"},
      {head + "2147483647 2147483647 1\n1 1 2\n",
       "a.mtx:2:24: nearly all of 2147483647 rows are empty; is the size right?"},
      {"%%MatrixMarket matrix array real general\n2147483647 0\n", "a.mtx:2:13: nearly all of"},
      {head + "2 2 1 0\n", "a.mtx:2:7: '0' is too much; the size is ROWS COLUMNS ENTRIES"},
      {head + "2 2 2\n1 1 2\n", "the file ends after 1 of 2 entries"},
      {head + "2 2 1\n1 1 2\n1 2 2\n", "a.mtx:4:1: the file goes on after its last entry"},
      {head + "2 2 4611686018427387904\n1 1 2\n", "the file ends after 1 of"},
      {"%%MatrixMarket matrix coordinate real symmetric\n2 3 0\n", "a symmetric matrix is square"},
      {"%%MatrixMarket matrix coordinate real symmetric\n2 2 1\n1 2 1\n", "is above the diagonal"},
      {"%%MatrixMarket matrix coordinate real skew-symmetric\n2 2 1\n1 1 1\n",
       "the entry (1, 1) of a skew-symmetric matrix is 0, not 1"},
      {"%%MatrixMarket matrix array real general\n2 2\n1\n2\n3\n", "the file ends before row 2 of column 2"}};
  for (const auto& [text, message] : cases) {
    CAPTURE(text);
    CHECK_THROWS_WITH(parseMarket(text, "a.mtx"), Catch::Contains(message));
  }
  CHECK_THROWS_WITH(readMatrixMarket("none.mtx"), "the matrix 'none.mtx' does not exist or cannot be read");
}

/// A file that goes when the test does.
struct RemovedFile {
  std::filesystem::path path;
  ~RemovedFile() { std::filesystem::remove(path); }
};

TEST_CASE("Vectors and matrices keep their digits in Matrix Market files") {
  const RemovedFile file{"vector.mtx"}, matrix{"market_made/matrix.mtx"};
  const std::vector<double> values = {1.0 / 3.0, -0.0, 1e-310, 6.02e23};
  writeMatrixMarketVector(file.path, values);
  CHECK(readMatrixMarketVector(file.path) == values);
  const Entry entries[] = {{0, 2, 1.0 / 3.0}, {2, 0, -1e-310}, {2, 1, 7}};
  const SparseMatrix a = assemble(3, 4, entries);
  writeMatrixMarket(matrix.path, a);
  std::int64_t duplicates = -1;
  const SparseMatrix read = readMatrixMarket(matrix.path, &duplicates);
  CHECK(read.rows == 3);
  CHECK(read.columns == 4);
  CHECK(read.starts == a.starts);
  CHECK(read.column == a.column);
  CHECK(read.value == a.value);
  CHECK(duplicates == 0);
  CHECK_THROWS_WITH(readMatrixMarketVector(matrix.path),
                    Catch::Contains("a vector has one column or one row"));
  CHECK_THROWS_WITH(writeMatrixMarket("/proc/none/a.mtx", a), "cannot write '/proc/none/a.mtx'");
}

}  // namespace
}  // namespace sk::linear
