// SPDX-License-Identifier: MIT
#include "analysis/index_values.hpp"

#include <cstddef>

namespace skc::analysis {

IndexValue joined(const ElementBounds& here, const IndexValue& a, const ElementBounds& there,
                  const IndexValue& b) {
  if (!a.isSet || !b.isSet) return a.isSet ? a : b;
  if (a == b) return a;
  IndexValue result{true, static_cast<std::uint8_t>(a.depends | b.depends)};
  if (a.range && b.range) result.range = either(seenFrom(here, *a.range), seenFrom(there, *b.range));
  return result;
}

void join(IndexState& into, const IndexState& from) {
  if (!from.isReachable) return;
  if (!into.isReachable) {
    into = from;
    return;
  }
  for (std::size_t v = 0; v < into.variables.size(); ++v) {
    for (std::size_t i = 0; i < into.variables[v].size(); ++i) {
      IndexValue& value = into.variables[v][i];
      value = joined(into.element, value, from.element, from.variables[v][i]);
    }
  }
  for (std::size_t d = 0; d < dimensions; ++d) {
    into.element[d] = either(rangeOf(into.element[d]), rangeOf(from.element[d])).value;
  }
}

void widen(const IndexState& last, IndexState& next) {
  for (std::size_t v = 0; v < next.variables.size(); ++v) {
    for (std::size_t i = 0; i < next.variables[v].size(); ++i) {
      const IndexValue& old = last.variables[v][i];
      IndexValue& value = next.variables[v][i];
      if (!old.isSet) continue;
      if (!old.range || !value.range) {
        value.range.reset();
      } else {
        value.range = widened(*old.range, *value.range);
      }
    }
  }
  for (std::size_t d = 0; d < dimensions; ++d)
    next.element[d] = widened(rangeOf(last.element[d]), rangeOf(next.element[d])).value;
}

}  // namespace skc::analysis
