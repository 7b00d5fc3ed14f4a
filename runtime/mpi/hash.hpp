// SPDX-License-Identifier: MIT
//
// A hash that is the same in every process (FNV-1a: Fowler, Noll and Vo), for comparing calls of several ranks.
#pragma once

#include <cstdint>
#include <string_view>

namespace sk::mpi {

class Hash {
 public:
  void add(std::string_view text) {
    addBytes(text);
    addByte(0);
  }
  void add(std::int64_t number) {
    for (int k = 0; k < 8; ++k) addByte(static_cast<unsigned char>(number >> (8 * k)));
  }
  void addBytes(std::string_view bytes) {
    for (const char c : bytes) addByte(static_cast<unsigned char>(c));
  }
  std::uint64_t value() const { return value_; }

 private:
  void addByte(unsigned char byte) { value_ = (value_ ^ byte) * 0x100000001b3; }

  std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace sk::mpi
