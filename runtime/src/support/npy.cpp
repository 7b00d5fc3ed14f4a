// SPDX-License-Identifier: MIT
#include "sk/npy.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "sk/error.hpp"
#include "sk/narrow.hpp"
#include "support/checked_size.hpp"
#include "support/npy_header.hpp"

namespace sk::npy {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, std::string_view what) {
  throw Error(fmt::format("'{}': {}", file.string(), what), Error::Kind::File);
}

template <class T>
double numberAt(const char* bytes, bool isSwapped) {
  char ordered[sizeof(T)];
  for (std::size_t k = 0; k < sizeof(T); ++k) ordered[k] = bytes[isSwapped ? sizeof(T) - 1 - k : k];
  T number;
  std::memcpy(&number, ordered, sizeof number);
  return static_cast<double>(number);
}

double halfAt(const char* bytes, bool isSwapped) {
  std::uint16_t bits = 0;
  std::memcpy(&bits, bytes, sizeof bits);
  if (isSwapped) bits = static_cast<std::uint16_t>(bits << 8 | bits >> 8);
  return static_cast<float>(std::bit_cast<half>(bits));
}

/// How the numbers of a type such as '<f4' are read.
struct NumberReader {
  std::size_t bytes;
  double (*read)(const char* bytes, bool isSwapped);
};

std::optional<NumberReader> readerOf(std::string_view kind) {
  struct Row {
    std::string_view kind;
    NumberReader reader;
  };
  static constexpr Row rows[] = {{"b1", {1, numberAt<std::uint8_t>}},  {"i1", {1, numberAt<std::int8_t>}},
                                 {"u1", {1, numberAt<std::uint8_t>}},  {"i2", {2, numberAt<std::int16_t>}},
                                 {"u2", {2, numberAt<std::uint16_t>}}, {"i4", {4, numberAt<std::int32_t>}},
                                 {"u4", {4, numberAt<std::uint32_t>}}, {"i8", {8, numberAt<std::int64_t>}},
                                 {"u8", {8, numberAt<std::uint64_t>}}, {"f2", {2, halfAt}},
                                 {"f4", {4, numberAt<float>}},         {"f8", {8, numberAt<double>}}};
  for (const Row& row : rows)
    if (row.kind == kind) return row.reader;
  return std::nullopt;
}

/// The product of the extents; nullopt if it does not fit in 63 bits.
std::optional<std::int64_t> countOf(std::span<const std::int64_t> extents) {
  std::int64_t count = 1;
  for (const std::int64_t extent : extents) {
    const std::optional<std::int64_t> product = extent < 0 ? std::nullopt : checkedProduct(count, extent);
    if (!product) return std::nullopt;
    count = *product;
  }
  return count;
}

}  // namespace

}  // namespace sk::npy

namespace sk {

NumberArray readNpy(const std::filesystem::path& file) {
  using namespace npy;
  std::ifstream in(file, std::ios::binary);
  std::error_code unreadable;
  const std::uintmax_t size = fs::file_size(file, unreadable);
  if (!in || unreadable) fail(file, "the file does not exist or cannot be read");
  std::string header(npyPrefix, '\0');
  in.read(header.data(), static_cast<std::streamsize>(header.size()));
  const std::size_t length = in ? npyHeaderLength(header) : 0;
  if (length == 0) fail(file, "this is not a .npy file; numpy.save writes one");
  if (length > size || length < npyPrefix) fail(file, "the file ends in its header");
  header.resize(length);
  in.seekg(0);
  in.read(header.data(), static_cast<std::streamsize>(length));

  NpyArray array;
  if (const std::string wrong = parseNpyHeader(header, array); !wrong.empty()) fail(file, wrong);
  // '<f4', with the quotes
  const std::string_view type = array.type;
  const std::optional<NumberReader> reader =
      type.size() == 5 && type.front() == '\'' ? readerOf(type.substr(2, 2)) : std::nullopt;
  if (!reader || std::string_view("<>|=").find(type[1]) == std::string_view::npos) {
    fail(file, fmt::format("its elements are {}; save booleans, integers, or floats of 16, 32 or 64 bits",
                           array.type));
  }
  const std::optional<std::int64_t> count = countOf(array.extents);
  if (!count || static_cast<std::uintmax_t>(*count) > (size - length) / reader->bytes) {
    fail(file, fmt::format("it has {} bytes after its header, too few for the shape {}", size - length,
                           npyShape(array.extents)));
  }

  const bool isSwapped =
      (type[1] == '>') == (std::endian::native == std::endian::little) && reader->bytes > 1;
  NumberArray numbers{array.extents, {}};
  try {
    numbers.values.resize(static_cast<std::size_t>(*count));
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format("'{}': no memory for {} numbers", file.string(), *count), Error::Kind::Memory);
  }
  std::vector<char> piece(std::size_t{1} << 20);   // a multiple of all sizes
  const std::size_t perPiece = piece.size() / reader->bytes;
  for (std::size_t i = 0; i < numbers.values.size(); i += perPiece) {
    const std::size_t some = std::min(perPiece, numbers.values.size() - i);
    in.read(piece.data(), static_cast<std::streamsize>(some * reader->bytes));
    if (!in) fail(file, "the file could not be read to its end");
    for (std::size_t k = 0; k < some; ++k)
      numbers.values[i + k] = reader->read(&piece[k * reader->bytes], isSwapped);
  }
  return numbers;
}

void writeNpy(const std::filesystem::path& file, std::span<const std::int64_t> extents,
              std::span<const double> values, NumberType type) {
  using namespace npy;
  const std::optional<std::int64_t> count = countOf(extents);
  const std::vector<std::int64_t> shape(extents.begin(), extents.end());
  if (!count || static_cast<std::size_t>(*count) != values.size()) {
    throw Error(fmt::format("'{}': {} numbers do not make an array of the shape {}", file.string(),
                            values.size(), npyShape(shape)),
                Error::Kind::Shape);
  }
  const fs::path partial = fmt::format("{}.part{}", file.string(), ::getpid());
  std::ofstream out(partial, std::ios::binary);
  out << npyHeader({type == NumberType::Float64 ? "'<f8'" : "'<f4'", shape});
  const auto put = [&](auto number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof number);
    out.write(bytes, sizeof number);
  };
  for (const double value : values) {
    if (type == NumberType::Float64)
      put(value);
    else
      put(static_cast<float>(value));
  }
  out.close();
  std::error_code error;
  if (out) fs::rename(partial, file, error);
  if (!out || error) {
    const std::string why = error ? error.message() : std::strerror(errno);
    fs::remove(partial, error);
    fail(file, fmt::format("the file cannot be written: {}", why));
  }
}

}  // namespace sk
