// SPDX-License-Identifier: MIT
#include "program/native_symbols.hpp"

#include <utility>

#include <fmt/format.h>

#include "support/text.hpp"

namespace skc::emit {
NativeSymbols::NativeSymbols(std::string_view header)
    : prefix_(fmt::format("sk_{:016x}_", textHash(header))) {}

std::string NativeSymbols::add(const std::string& descriptor, native::KernelRequest request) {
  request.symbol = prefix_ + descriptor;
  return requests_.emplace_back(std::move(request)).symbol;
}

}  // namespace skc::emit
