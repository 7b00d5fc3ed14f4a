// SPDX-License-Identifier: MIT
//
// Promises: .npy files keep shape and numbers, all kinds of numbers are read, and a file that is not whole is an error that says what is wrong.
#include "sk/npy.hpp"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/error.hpp"

using namespace sk;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

struct NpyFolder {
  fs::path path = fs::temp_directory_path() / ("sk_npy_test." + std::to_string(::getpid()));
  NpyFolder() { fs::create_directories(path); }
  ~NpyFolder() { fs::remove_all(path); }
};

/// A file of version 1 with this dictionary and these bytes after it.
fs::path written(const fs::path& file, std::string dictionary, std::string_view bytes) {
  dictionary += '\n';
  std::ofstream out(file, std::ios::binary);
  out << std::string("\x93NUMPY\x01\0", 8) << static_cast<char>(dictionary.size() & 0xff)
      << static_cast<char>(dictionary.size() >> 8) << dictionary << bytes;
  return file;
}

std::string header(std::string_view type, std::string_view shape) {
  return "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': " + std::string(shape) +
         ", }";
}

}  // namespace

TEST_CASE("npy files keep shape and numbers", "[npy]") {
  const NpyFolder folder;
  const fs::path file = folder.path / "a.npy";
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> values = {0.1, -0.0, 1e-310, infinity, -infinity, 3};
  const std::vector<std::int64_t> extents = {2, 3};
  writeNpy(file, extents, values, NumberType::Float64);
  const NumberArray doubles = readNpy(file);
  CHECK(doubles.extents == extents);
  CHECK(doubles.values == values);
  CHECK(std::signbit(doubles.values[1]));
  writeNpy(file, extents, values);
  CHECK(readNpy(file).values[0] == 0.1f);
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);  // nothing partial is left

  const std::vector<std::int64_t> empty = {0, 4}, one = {};
  writeNpy(file, empty, {});
  CHECK(readNpy(file).extents == empty);
  writeNpy(file, one, std::vector<double>{7});
  CHECK(readNpy(file).extents.empty());
  CHECK(readNpy(file).values == std::vector<double>{7});
}

TEST_CASE("npy files of all kinds of numbers are read", "[npy]") {
  const NpyFolder folder;
  const auto read = [&](std::string_view type, std::string_view bytes, std::string_view shape = "(2,)") {
    return readNpy(written(folder.path / "a.npy", header(type, shape), bytes)).values;
  };
  using V = std::vector<double>;
  using std::string_view_literals::operator""sv;
  CHECK(read("|b1", "\x01\x00"sv) == V{1, 0});
  CHECK(read("|i1", "\xff\x02"sv) == V{-1, 2});
  CHECK(read("|u1", "\xff\x02"sv) == V{255, 2});
  CHECK(read("<i2", "\xfe\xff\x01\x00"sv) == V{-2, 1});
  CHECK(read(">u2", "\x01\x02\x00\x03"sv) == V{258, 3});
  CHECK(read("<u8", "\x01\x00\x00\x00\x00\x00\x00\x00"sv, "(1, 1)") == V{1});
  CHECK(read("<f2", "\x00\x3c\x00\xc0"sv) == V{1, -2});
  CHECK(read(">f2", "\x3c\x00\xc0\x00"sv) == V{1, -2});
  CHECK(read(">f4", "\x3f\x80\x00\x00\xc0\x00\x00\x00"sv) == V{1, -2});
}

TEST_CASE("npy files that are not whole are errors", "[npy]") {
  const NpyFolder folder;
  const fs::path file = folder.path / "a.npy";
  const auto wrong = [&](std::string_view says) {
    CHECK_THROWS_WITH(readNpy(file), Contains(std::string(says)));
  };
  wrong("the file does not exist or cannot be read");
  std::ofstream(file) << "";
  wrong("this is not a .npy file; numpy.save writes one");
  std::ofstream(file) << "\x93NUMPY\x01";
  wrong("this is not a .npy file");
  written(file, header("<f4", "(2,)"), "1234567");
  wrong("it has 7 bytes after its header, too few for the shape (2,)");
  written(file, header("<f4", "(9223372036854775807, 9223372036854775807)"), "1234");
  wrong("too few for the shape");
  written(file, header("<c8", "(1,)"), "12345678");
  wrong("its elements are '<c8'; save booleans, integers, or floats of 16, 32 or 64 bits");
  written(file, "{'descr': '<f4', 'fortran_order': True, 'shape': (1,), }", "1234");
  wrong("Fortran's order");
  written(file, "{}", "1234");
  wrong("no type or no shape");
  std::ofstream(file, std::ios::binary) << std::string("\x93NUMPY\x01\0\xff\xff{}", 12);
  wrong("the file ends in its header");

  CHECK_THROWS_WITH(writeNpy(file, std::vector<std::int64_t>{3}, std::vector<double>{1}),
                    Contains("1 numbers do not make an array of the shape (3,)"));
  CHECK_THROWS_WITH(
      writeNpy(folder.path / "none/a.npy", std::vector<std::int64_t>{1}, std::vector<double>{1}),
      Contains("the file cannot be written: No such file or directory"));
}
