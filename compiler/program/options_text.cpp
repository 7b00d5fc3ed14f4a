// SPDX-License-Identifier: MIT
#include "program/options_text.hpp"

#include <cstddef>
#include <string_view>

#include <fmt/format.h>

namespace skc::emit {

std::string optionsText(const sk::CallOptions& options) {
  constexpr std::string_view accumulates[] = {"Default", "Tree", "Compensated", "Extended", "Exact"};
  constexpr std::string_view precisions[] = {"Default", "Half", "Single", "Extended", "Double"};
  constexpr std::string_view intrinsics[] = {"Default", "Fast", "Accurate"};
  constexpr std::string_view tables[] = {"Default", "Off", "On"};
  constexpr std::string_view contractions[] = {"Default", "Exact", "Fast"};
  constexpr std::string_view orders[] = {"Default", "Kept", "Any"};
  return fmt::format(
      "{{.accumulate = Accumulate::{}, .precision = Precision::{}, .intrinsics = Intrinsics::{}, "
      ".tables = Tables::{}, .contraction = Contraction::{}, .order = Order::{}}}",
      accumulates[static_cast<std::size_t>(options.accumulate)],
      precisions[static_cast<std::size_t>(options.precision)],
      intrinsics[static_cast<std::size_t>(options.intrinsics)],
      tables[static_cast<std::size_t>(options.tables)],
      contractions[static_cast<std::size_t>(options.contraction)],
      orders[static_cast<std::size_t>(options.order)]);
}

}  // namespace skc::emit
