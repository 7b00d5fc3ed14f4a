// SPDX-License-Identifier: MIT
//
// Promises: a file that is written is read as it was; one that is cut off anywhere, or has another byte anywhere, is an error and
// never other numbers; what is compressed, too long or of another type is refused with a way out. (tests/cli/npz_test.py compares
// with Python's zipfile.)
#include "support/npz.hpp"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/error.hpp"

namespace sk::npy {
namespace {

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

class NpzFolder {
 public:
  NpzFolder() { fs::create_directories(path_); }
  ~NpzFolder() { fs::remove_all(path_); }
  NpzFolder(const NpzFolder&) = delete;
  NpzFolder& operator=(const NpzFolder&) = delete;
  fs::path file() const { return path_ / "a.npz"; }

 private:
  const fs::path path_ = fs::temp_directory_path() / ("sk_npz_test." + std::to_string(::getpid()));
};

template <class T>
std::vector<std::byte> bytesOf(const std::vector<T>& values) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void put(const fs::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

std::string errorOf(const fs::path& file) {
  try {
    static_cast<void>(readNpz(file));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

const std::vector<float> floats{1, 2.5f, -3, 4, 5, 6};

constexpr std::uint64_t usual = 0xffffffff;

/// `longFrom` 0 is for what only large files have.
void writeTwo(const fs::path& file, std::uint64_t longFrom = usual) {
  NpzWriter writer(file, longFrom);
  writer.add("heat::diffuse/u", {"'<f4'", {2, 3}}, bytesOf(floats));
  writer.add("heat::diffuse/k", {"'<i8'", {}}, bytesOf(std::vector<std::int64_t>{-7}));
  writer.finish();
  CHECK(writer.size() == fs::file_size(file));
}

TEST_CASE("npz files keep names, types, shapes and elements") {
  const NpzFolder folder;
  writeTwo(folder.file(), GENERATE(usual, std::uint64_t{0}, std::uint64_t{150}));
  const auto arrays = readNpz(folder.file());
  REQUIRE(arrays.size() == 2);
  const NpzArray& u = arrays.at("heat::diffuse/u");
  CHECK(u.array.type == "'<f4'");
  CHECK(u.array.extents == std::vector<std::int64_t>{2, 3});
  CHECK(u.elements == bytesOf(floats));
  CHECK(arrays.at("heat::diffuse/k").array.extents.empty());
  CHECK(arrays.at("heat::diffuse/k").elements == bytesOf(std::vector<std::int64_t>{-7}));

  NpzWriter types(folder.file());
  for (const char* type :
       {"'|b1'", "'|i1'", "'|u1'", "'<i2'", "'<u2'", "'<f2'", "'<i4'", "'<u4'", "'<i8'", "'<u8'", "'<f8'"}) {
    const std::size_t size = static_cast<std::size_t>(type[3] - '0');
    types.add(type, {type, {2, 0}}, {});
    types.add(std::string(type) + "/three", {type, {3}}, std::vector<std::byte>(3 * size, std::byte{1}));
  }
  types.add("leer/ä", {"'|u1'", {1}}, std::vector<std::byte>(1));
  types.finish();
  const auto all = readNpz(folder.file());
  CHECK(all.size() == 23);
  CHECK(all.at("'<u8'/three").elements.size() == 24);
  CHECK(all.at("'<u8'").elements.empty());
  CHECK(all.contains("leer/ä"));
  NpzWriter(folder.file()).finish();
  CHECK(readNpz(folder.file()).empty());
}

TEST_CASE("tests/cli/npz_test.py reads this file", "[.npz_file]") {
  writeTwo(std::getenv("SK_NPZ_FILE"), std::getenv("SK_NPZ_LONG") != nullptr ? 0 : usual);
}

TEST_CASE("a writer that does not finish leaves no file, and names are taken once") {
  const NpzFolder folder;
  {
    NpzWriter writer(folder.file());
    writer.add("u", {"'|u1'", {1}}, std::vector<std::byte>(1));
    CHECK_THROWS_WITH(writer.add("u", {"'|u1'", {1}}, std::vector<std::byte>(1)),
                      Contains("it has two arrays 'u'"));
  }
  CHECK_FALSE(fs::exists(folder.file()));
  CHECK_THROWS_WITH(NpzWriter(folder.file() / "none"), Contains("cannot be written"));
  CHECK_THAT(errorOf(folder.file()), Contains("cannot be read"));
}

TEST_CASE("files that are cut off or changed are errors") {
  const NpzFolder folder;
  writeTwo(folder.file(), GENERATE(usual, std::uint64_t{0}));
  const std::string whole = contentOf(folder.file());
  const auto original = readNpz(folder.file());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    put(folder.file(), whole.substr(0, length));
    if (errorOf(folder.file()) == "no error") FAIL("cut off after " << length << " bytes");
  }
  // Bytes that mean nothing here, such as dates, may change; the elements may not.
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x55);
    put(folder.file(), changed);
    try {
      const auto read = readNpz(folder.file());
      const bool isSame = read.size() == 2 &&
                          (!read.contains("heat::diffuse/u") ||
                           read.at("heat::diffuse/u").elements == original.at("heat::diffuse/u").elements);
      if (!isSame) FAIL("byte " << at << " changes the elements");
    } catch (const Error&) {
    }
  }
}

TEST_CASE("what cannot be read is refused with a way out") {
  const NpzFolder folder;
  writeTwo(folder.file());
  const std::string whole = contentOf(folder.file());
  std::string changed = whole;
  const std::size_t directory = whole.find("PK\x01\x02");
  changed[directory + 10] = 8;  // deflated
  put(folder.file(), changed);
  CHECK_THAT(errorOf(folder.file()),
             Contains("'heat::diffuse/k.npy' is compressed") && Contains("numpy.savez"));
  changed = whole;
  changed[directory + 8] = 1;
  put(folder.file(), changed);
  CHECK_THAT(errorOf(folder.file()), Contains("is encrypted"));
  changed = whole;
  changed[whole.find("<f4") + 1] = 'g';
  put(folder.file(), changed);
  CHECK_THAT(errorOf(folder.file()), Contains("'heat::diffuse/u.npy'") && Contains("checksum"));
  const auto refusedType = [&](const char* type, std::vector<std::int64_t> extents, std::size_t bytes) {
    NpzWriter writer(folder.file());
    writer.add("u", {type, std::move(extents)}, std::vector<std::byte>(bytes));
    writer.finish();
    return errorOf(folder.file());
  };
  CHECK_THAT(refusedType("'>f4'", {1}, 4), Contains("'u.npy': it has elements of type '>f4'"));
  CHECK_THAT(refusedType("'<c8'", {1}, 8), Contains("type '<c8'"));
  CHECK_THAT(refusedType("'<f4'", {3}, 8), Contains("it has 8 bytes of elements") && Contains("(3,)"));
  put(folder.file(), "PK");
  CHECK_THAT(errorOf(folder.file()), Contains("it is no .npz file, or not whole"));
}

}  // namespace
}  // namespace sk::npy
