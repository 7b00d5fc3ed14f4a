// SPDX-License-Identifier: MIT
#include "support/npz.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <initializer_list>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "sk/error.hpp"
#include "support/checked_size.hpp"

namespace sk::npy {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void failIn(const fs::path& file, std::string_view what) {
  throw Error(fmt::format("'{}': {}", file.string(), what), Error::Kind::File);
}

// ---- zip ----------------------------------------------------------------------------------------------

constexpr std::uint32_t localSignature = 0x04034b50, directorySignature = 0x02014b50,
                        endSignature = 0x06054b50;
constexpr std::size_t localLength = 30, directoryLength = 46, endLength = 22, longestComment = 0xffff;
// zip64: numbers of 64 bits, where one of 32 says that it is elsewhere
constexpr std::uint32_t longEndSignature = 0x06064b50, locatorSignature = 0x07064b50, elsewhere = 0xffffffff;
constexpr std::size_t longEndLength = 56, locatorLength = 20;
constexpr std::uint16_t manyEntries = 0xffff, longId = 1;
constexpr std::uint16_t version = 20, longVersion = 45;
constexpr std::uint16_t isUtf8 = 1U << 11;
constexpr std::uint16_t isEncrypted = 1U;
constexpr std::uint16_t firstDay = 1 << 5 | 1;  // of 1980: equal arrays make equal files

/// CRC-32 of IEEE 802.3, which continues from `before`.
std::uint32_t checksumOf(std::span<const std::byte> bytes, std::uint32_t before = 0) {
  static constexpr auto table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t i = 0; i < made.size(); ++i) {
      std::uint32_t remainder = i;
      for (int bit = 0; bit < 8; ++bit)
        remainder = remainder >> 1U ^ ((remainder & 1U) != 0 ? 0xedb88320U : 0);
      made[i] = remainder;
    }
    return made;
  }();
  std::uint32_t sum = ~before;
  for (const std::byte byte : bytes)
    sum = table[(sum ^ std::to_integer<std::uint32_t>(byte)) & 0xffU] ^ sum >> 8U;
  return ~sum;
}

std::span<const std::byte> bytesOf(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}
std::string_view textOf(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Appends numbers of 16 or 32 bits, the low byte first.
class Record {
 public:
  template <class T>
  Record& add(T number) {
    for (std::size_t k = 0; k < sizeof number; ++k) text_ += static_cast<char>(number >> (8 * k) & 0xffU);
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

template <class T>
T numberAt(std::span<const std::byte> bytes, std::size_t at) {
  T number = 0;
  for (std::size_t k = 0; k < sizeof number; ++k)
    number = static_cast<T>(number | static_cast<T>(std::to_integer<T>(bytes[at + k]) << (8 * k)));
  return number;
}

std::uint16_t flagsOf(std::string_view name) {
  return std::ranges::all_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x80; }) ? 0 : isUtf8;
}

/// What the headers in front of an entry and in the directory have in common. `isLong`: the length is in what follows the name.
void addCommon(Record& record, std::string_view name, std::uint32_t checksum, std::uint64_t bytes,
               bool isLong, std::size_t extraLength) {
  constexpr std::uint16_t stored = 0, midnight = 0;
  const std::uint32_t length = isLong ? elsewhere : static_cast<std::uint32_t>(bytes);
  record.add(extraLength > 0 ? longVersion : version)
      .add(flagsOf(name))
      .add(stored)
      .add(midnight)
      .add(firstDay);
  record.add(checksum).add(length).add(length).add(static_cast<std::uint16_t>(name.size()));
  record.add(static_cast<std::uint16_t>(extraLength));
}

/// Numbers of 64 bits that stand beside a header.
std::string longNumbers(std::initializer_list<std::uint64_t> numbers) {
  Record record;
  record.add(longId).add(static_cast<std::uint16_t>(numbers.size() * sizeof(std::uint64_t)));
  for (const std::uint64_t number : numbers) record.add(number);
  return record.text();
}

}  // namespace

NpzWriter::NpzWriter(fs::path file, std::uint64_t longFrom)
    : longFrom_(longFrom), file_(std::move(file)), out_(file_, std::ios::binary | std::ios::trunc) {
  if (!out_) failIn(file_, fmt::format("it cannot be written: {}", std::generic_category().message(errno)));
}

NpzWriter::~NpzWriter() {
  if (isFinished_) return;
  out_.close();
  std::error_code ignored;
  fs::remove(file_, ignored);
}

void NpzWriter::write(std::string_view bytes) {
  if (!out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    failIn(file_, fmt::format("it cannot be written: {}", std::generic_category().message(errno)));
  size_ += bytes.size();
}

void NpzWriter::add(std::string_view name, const NpyArray& array, std::span<const std::byte> elements) {
  const std::string entry = std::string(name) + ".npy";
  if (entries_.contains(entry))
    failIn(file_, fmt::format("it has two arrays '{}'; give each a name of its own", name));
  if (entry.size() > std::numeric_limits<std::uint16_t>::max())
    failIn(file_, "the name of an array is too long");
  const std::string header = npyHeader(array);
  const Entry made{checksumOf(elements, checksumOf(bytesOf(header))), header.size() + elements.size(), size_};
  const std::string extra = isLong(made.bytes) ? longNumbers({made.bytes, made.bytes}) : "";
  Record local;
  local.add(localSignature);
  addCommon(local, entry, made.checksum, made.bytes, isLong(made.bytes), extra.size());
  write(local.text());
  write(entry);
  write(extra);
  write(header);
  write(textOf(elements));
  entries_.emplace(entry, made);
}

std::string NpzWriter::directoryEntry(std::string_view name, const Entry& entry) const {
  constexpr std::uint16_t none = 0;
  constexpr std::uint32_t noAttributes = 0;
  std::string extra;
  if (isLong(entry.bytes) && isLong(entry.offset)) {
    extra = longNumbers({entry.bytes, entry.bytes, entry.offset});
  } else if (isLong(entry.bytes)) {
    extra = longNumbers({entry.bytes, entry.bytes});
  } else if (isLong(entry.offset)) {
    extra = longNumbers({entry.offset});
  }
  Record record;
  record.add(directorySignature).add(extra.empty() ? version : longVersion);
  addCommon(record, name, entry.checksum, entry.bytes, isLong(entry.bytes), extra.size());
  record.add(none).add(none).add(none).add(noAttributes);  // no comment, first disk, binary
  record.add(isLong(entry.offset) ? elsewhere : static_cast<std::uint32_t>(entry.offset));
  return record.text() + std::string(name) + extra;
}

/// The records behind a directory that begins at `begin` and ends here.
std::string NpzWriter::endOfDirectory(std::uint64_t begin) const {
  constexpr std::uint16_t onlyDisk = 0, noComment = 0;
  constexpr std::uint32_t firstDisk = 0, disks = 1;
  constexpr std::uint64_t restOfLongEnd = longEndLength - 12;
  const std::uint64_t count = entries_.size(), length = size_ - begin;
  const bool areMany = count >= manyEntries, isFar = isLong(begin) || isLong(length);
  Record end;
  if (areMany || isFar) {
    end.add(longEndSignature)
        .add(restOfLongEnd)
        .add(longVersion)
        .add(longVersion)
        .add(firstDisk)
        .add(firstDisk);
    end.add(count).add(count).add(length).add(begin);
    end.add(locatorSignature).add(firstDisk).add(size_).add(disks);
  }
  const std::uint16_t shortCount = areMany ? manyEntries : static_cast<std::uint16_t>(count);
  end.add(endSignature).add(onlyDisk).add(onlyDisk).add(shortCount).add(shortCount);
  end.add(isFar ? elsewhere : static_cast<std::uint32_t>(length));
  end.add(isFar ? elsewhere : static_cast<std::uint32_t>(begin)).add(noComment);
  return end.text();
}

void NpzWriter::finish() {
  const std::uint64_t begin = size_;
  for (const auto& [name, entry] : entries_) write(directoryEntry(name, entry));
  write(endOfDirectory(begin));
  if (!out_.flush())
    failIn(file_, fmt::format("it cannot be written: {}", std::generic_category().message(errno)));
  isFinished_ = true;
}

namespace {

// ---- reading ------------------------------------------------------------------------------------------

constexpr std::string_view notWhole = "it is no .npz file, or not whole";

/// The bytes of a number of a type such as "'<f4'"; nullopt for other types, and for another byte order.
std::optional<std::size_t> numberBytes(std::string_view type) {
  if (type.size() < 5 || type.front() != '\'' || type.back() != '\'') return std::nullopt;
  const char order = type[1], kind = type[2];
  std::size_t bytes = 0;
  const char* const begin = type.data() + 3;
  const char* const end = type.data() + type.size() - 1;
  if (std::from_chars(begin, end, bytes).ptr != end) return std::nullopt;
  const bool isKnown =
      kind == 'f'   ? bytes == 2 || bytes == 4 || bytes == 8
      : kind == 'b' ? bytes == 1
                    : (kind == 'i' || kind == 'u') && (bytes == 1 || bytes == 2 || bytes == 4 || bytes == 8);
  const bool isNative = order == '<' || order == '=' || order == '|';
  return isKnown && isNative ? std::optional(bytes) : std::nullopt;
}

class NpzReader {
 public:
  explicit NpzReader(fs::path file) : file_(std::move(file)) {
    std::ifstream in(file_, std::ios::binary | std::ios::ate);
    const std::streamoff size = in ? static_cast<std::streamoff>(in.tellg()) : -1;
    if (size < 0) failIn(file_, fmt::format("it cannot be read: {}", std::generic_category().message(errno)));
    bytes_.resize(static_cast<std::size_t>(size));
    in.seekg(0);
    if (size > 0 && !in.read(reinterpret_cast<char*>(bytes_.data()), size))
      failIn(file_, fmt::format("it cannot be read: {}", std::generic_category().message(errno)));
  }

  std::map<std::string, NpzArray, std::less<>> read() const {
    const auto [begin, end, count] = directory();
    std::size_t at = begin;
    std::map<std::string, NpzArray, std::less<>> arrays;
    for (std::uint64_t i = 0; i < count; ++i) {
      Entry entry = entryAt(at, end);
      at += directoryLength + entry.skipped;
      std::string name = entry.name;
      if (!name.ends_with(".npy"))
        failIn(file_, fmt::format("'{}' is no .npy file; put arrays alone into it", name));
      name.resize(name.size() - 4);
      if (!arrays.emplace(name, arrayOf(entry)).second)
        failIn(file_, fmt::format("it has two arrays '{}'", name));
    }
    return arrays;
  }

 private:
  struct Entry {
    std::string name;
    std::size_t skipped;  ///< bytes of its names and comments in the directory
    std::uint32_t checksum;
    std::uint64_t bytes, offset;
  };

  void require(bool condition) const {
    if (!condition) failIn(file_, notWhole);
  }

  /// The offset of the record that ends the file, in front of a comment.
  std::size_t endOfDirectory() const {
    require(bytes_.size() >= endLength);
    const std::size_t last = bytes_.size() - endLength;
    for (std::size_t at = last + 1; at-- > 0 && last - at <= longestComment;) {
      if (numberAt<std::uint32_t>(bytes_, at) != endSignature) continue;
      if (numberAt<std::uint16_t>(bytes_, at + 20) == last - at) return at;
    }
    failIn(file_, notWhole);
  }

  struct Directory {
    std::size_t begin, end;
    std::uint64_t count;
  };
  Directory directory() const {
    const std::size_t end = endOfDirectory();
    const auto count = numberAt<std::uint16_t>(bytes_, end + 10);
    const auto begin = numberAt<std::uint32_t>(bytes_, end + 16);
    if (begin != elsewhere && count != manyEntries) return {begin, end, count};
    require(end >= locatorLength && numberAt<std::uint32_t>(bytes_, end - locatorLength) == locatorSignature);
    const auto at = numberAt<std::uint64_t>(bytes_, end - locatorLength + 8);
    require(at <= end && longEndLength <= end - at &&
            numberAt<std::uint32_t>(bytes_, at) == longEndSignature);
    return {numberAt<std::uint64_t>(bytes_, at + 48), at, numberAt<std::uint64_t>(bytes_, at + 32)};
  }

  /// Replaces numbers that are elsewhere by those of 64 bits.
  void readLongNumbers(std::span<const std::byte> extra, Entry& entry, bool isStoredElsewhere) const {
    std::size_t at = 0, length = 0;
    for (; at + 4 <= extra.size(); at += 4 + length) {
      length = numberAt<std::uint16_t>(extra, at + 2);
      require(length <= extra.size() - at - 4);
      if (numberAt<std::uint16_t>(extra, at) != longId) continue;
      std::size_t next = at + 4;
      const auto take = [&](std::uint64_t& number) {
        require(next + sizeof number <= at + 4 + length);
        number = numberAt<std::uint64_t>(extra, next);
        next += sizeof number;
      };
      std::uint64_t ignored = 0;
      if (entry.bytes == elsewhere) take(entry.bytes);
      if (isStoredElsewhere) take(ignored);
      if (entry.offset == elsewhere) take(entry.offset);
      return;
    }
  }

  Entry entryAt(std::size_t at, std::size_t end) const {
    require(at <= end && directoryLength <= end - at &&
            numberAt<std::uint32_t>(bytes_, at) == directorySignature);
    const auto flags = numberAt<std::uint16_t>(bytes_, at + 8),
               method = numberAt<std::uint16_t>(bytes_, at + 10);
    const std::size_t length = numberAt<std::uint16_t>(bytes_, at + 28),
                      extraLength = numberAt<std::uint16_t>(bytes_, at + 30);
    const std::size_t skipped = length + extraLength + numberAt<std::uint16_t>(bytes_, at + 32);
    require(skipped <= end - at - directoryLength);
    const std::span<const std::byte> behind = std::span(bytes_).subspan(at + directoryLength, skipped);
    Entry entry{.name = std::string(textOf(behind.first(length))),
                .skipped = skipped,
                .checksum = numberAt<std::uint32_t>(bytes_, at + 16),
                .bytes = numberAt<std::uint32_t>(bytes_, at + 24),
                .offset = numberAt<std::uint32_t>(bytes_, at + 42)};
    if ((flags & isEncrypted) != 0)
      failIn(file_, fmt::format("'{}' is encrypted; save it by numpy.savez", entry.name));
    if (method != 0)
      failIn(file_, fmt::format(
                        "'{}' is compressed, and only arrays as they are can be read; save it by numpy.savez",
                        entry.name));
    readLongNumbers(behind.subspan(length, extraLength), entry,
                    numberAt<std::uint32_t>(bytes_, at + 20) == elsewhere);
    return entry;
  }

  NpzArray arrayOf(const Entry& entry) const {
    require(entry.offset <= bytes_.size() && localLength <= bytes_.size() - entry.offset &&
            numberAt<std::uint32_t>(bytes_, entry.offset) == localSignature);
    const std::size_t begin = entry.offset + localLength +
                              numberAt<std::uint16_t>(bytes_, entry.offset + 26) +
                              numberAt<std::uint16_t>(bytes_, entry.offset + 28);
    require(begin <= bytes_.size() && entry.bytes <= bytes_.size() - begin);
    const std::span<const std::byte> stored = std::span(bytes_).subspan(begin, entry.bytes);
    const auto fail = [&](std::string_view what) {
      failIn(file_, fmt::format("'{}': {}", entry.name, what));
    };
    if (checksumOf(stored) != entry.checksum) fail("its checksum is another; copy the file anew");
    const std::string_view text = textOf(stored);
    const std::size_t header = npyHeaderLength(text.substr(0, npyPrefix));
    if (header == 0 || header > text.size()) fail("it is no .npy file, or not whole");
    NpzArray read;
    if (const std::string wrong = parseNpyHeader(text.substr(0, header), read.array); !wrong.empty())
      fail(wrong);
    std::optional<std::int64_t> size = numberBytes(read.array.type);
    if (!size)
      fail(
          fmt::format("it has elements of type {}; save numbers of 8 to 64 bits, or bools", read.array.type));
    for (const std::int64_t extent : read.array.extents)
      size = size ? checkedProduct(*size, extent) : std::nullopt;
    if (!size || static_cast<std::uint64_t>(*size) != text.size() - header)
      fail(fmt::format("it has {} bytes of elements, which are not as many as its shape {} needs",
                       text.size() - header, npyShape(read.array.extents)));
    read.elements.assign(stored.begin() + static_cast<std::ptrdiff_t>(header), stored.end());
    return read;
  }

  const fs::path file_;
  std::vector<std::byte> bytes_;
};

}  // namespace

std::map<std::string, NpzArray, std::less<>> readNpz(const fs::path& file) { return NpzReader(file).read(); }

}  // namespace sk::npy
