// SPDX-License-Identifier: MIT
//
// .npz files: arrays with names, as numpy.savez writes and numpy.load reads them. Such a file is a zip archive (PKWARE, APPNOTE 6.3) of
// .npy files (support/npy_header.hpp) that are stored as they are: nothing here compresses. What is longer than 4 GiB has the numbers of
// zip64 beside, as in NumPy's own files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "support/npy_header.hpp"

namespace sk::npy {

/// Writes arrays one after the other. The file is complete once finish() has returned; a writer that ends before removes it.
class NpzWriter {
 public:
  /// Throws sk::Error if the file cannot be written. Lengths and offsets from `longFrom` on are written as numbers of 64 bits; only tests
  /// choose it.
  explicit NpzWriter(std::filesystem::path file, std::uint64_t longFrom = 0xffffffff);
  ~NpzWriter();
  NpzWriter(const NpzWriter&) = delete;
  NpzWriter& operator=(const NpzWriter&) = delete;

  /// Adds an array, whose elements are row-major and have the array's type, under a name of its own, such as "heat::diffuse/u". Throws
  /// sk::Error if the name is taken or too long, or if the array cannot be written.
  void add(std::string_view name, const NpyArray& array, std::span<const std::byte> elements);
  /// Ends the file. Throws sk::Error if it cannot be written.
  void finish();

  /// The bytes that have been written.
  std::uint64_t size() const { return size_; }

 private:
  struct Entry {
    std::uint32_t checksum;
    std::uint64_t bytes, offset;
  };
  void write(std::string_view bytes);
  bool isLong(std::uint64_t number) const { return number >= longFrom_; }
  std::string directoryEntry(std::string_view name, const Entry& entry) const;
  std::string endOfDirectory(std::uint64_t begin) const;

  const std::uint64_t longFrom_;
  const std::filesystem::path file_;
  std::ofstream out_;
  std::uint64_t size_ = 0;
  std::map<std::string, Entry, std::less<>> entries_;  ///< by name, with ".npy"
  bool isFinished_ = false;
};

struct NpzArray {
  NpyArray array;
  std::vector<std::byte> elements;  ///< row-major
};

/// The arrays of a file by name, without ".npy". Throws sk::Error, which names the file and the array, if it cannot be read, is not
/// whole, is compressed, or has arrays of types other than numbers and bools in this machine's byte order.
std::map<std::string, NpzArray, std::less<>> readNpz(const std::filesystem::path& file);

}  // namespace sk::npy
