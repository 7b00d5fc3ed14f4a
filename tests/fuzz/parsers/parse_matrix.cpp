// SPDX-License-Identifier: MIT
//
// The matrices that sk::linear reads, in the Matrix Market format.
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "matrix_market.hpp"
#include "parsers/entry.hpp"

namespace {

/// Rows in order, columns ascending and inside, entries finite.
bool isWhole(const sk::linear::SparseMatrix& a) {
  if (a.starts.size() != static_cast<std::size_t>(a.rows) + 1 || a.column.size() != a.value.size())
    return false;
  if (a.starts.front() != 0 || a.starts.back() != static_cast<std::int64_t>(a.column.size())) return false;
  for (std::int64_t i = 0; i < a.rows; ++i) {
    const auto first = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i)]);
    const auto last = static_cast<std::size_t>(a.starts[static_cast<std::size_t>(i) + 1]);
    if (first > last) return false;
    for (std::size_t k = first; k < last; ++k) {
      if (a.column[k] < 0 || a.column[k] >= a.columns || !std::isfinite(a.value[k])) return false;
      if (k > first && a.column[k - 1] >= a.column[k]) return false;
    }
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const sk::linear::MarketFile file =
        sk::linear::parseMarket({reinterpret_cast<const char*>(data), size}, "input.mtx");
    if (!isWhole(file.matrix)) std::abort();
  } catch (const std::runtime_error&) {
    return 0;
  }
  return 0;
}
