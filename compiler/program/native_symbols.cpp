// SPDX-License-Identifier: MIT
#include "program/native_symbols.hpp"

#include <cstdint>
#include <utility>

#include <fmt/format.h>

namespace skc::emit {
namespace {

/// 64-bit FNV-1a: G. Fowler, L. C. Noll, K.-P. Vo, "The FNV Non-Cryptographic Hash Algorithm" (IETF draft).
std::uint64_t hashOf(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

}  // namespace

NativeSymbols::NativeSymbols(std::string_view header) : prefix_(fmt::format("sk_{:016x}_", hashOf(header))) {}

std::string NativeSymbols::add(const std::string& descriptor, native::KernelRequest request) {
  request.symbol = prefix_ + descriptor;
  return requests_.emplace_back(std::move(request)).symbol;
}

}  // namespace skc::emit
