// SPDX-License-Identifier: MIT
#include "memory.hpp"

#include <optional>

#include <fmt/format.h>

#include "layout.hpp"
#include "operator_matrix.hpp"
#include "residual.hpp"

namespace sk::linear {

namespace {

std::int64_t rounded(double bytes) { return static_cast<std::int64_t>(bytes); }

/// The layout in which the matrix takes the fewest bytes, as a part of advice; "" if there is none to advise.
std::string smallerLayout(const Operator& a, const MemoryChoices& choices, std::int64_t bytes) {
  std::string advice;
  const std::int64_t entryBytes = bytesOf(choices.arithmetic.matrix);
  if (a.isGrid())  // no other layout of a grid takes less
    return matrixBytes(a, "stencil", entryBytes) < bytes ? "the layout 'stencil', " : "";
  for (const LayoutKind& kind : layoutKinds()) {
    const std::int64_t other = matrixBytes(a, kind.name, entryBytes);
    if (other >= bytes) continue;
    bytes = other;
    advice = fmt::format("the layout '{}', ", kind.name);
  }
  return advice;
}

}  // namespace

MemoryNeed memoryNeed(const Operator& a, const MemoryChoices& choices, bool hasDoubles) {
  const auto devices = static_cast<double>(choices.devices);
  const auto unknowns = static_cast<double>(a.size) / devices;
  const double vector = unknowns * static_cast<double>(bytesOf(choices.arithmetic.vectors));
  // Copies of the matrix, or of a part of it, are in compressed rows.
  const double copy =
      static_cast<double>(entriesOf(a) * (bytesOf(choices.arithmetic.matrix) + 4)) / devices + 4.0 * unknowns;
  const int basis = choices.method.hasBasis ? choices.restart : 0;
  constexpr int residualVectors = 5;
  const std::int64_t copyInDoubles =
      keepsEntries(a, choices.arithmetic.matrix) ? 0 : matrixBytes(a, choices.layout, 8) / choices.devices;
  return {.matrix = matrixBytes(a, choices.layout, bytesOf(choices.arithmetic.matrix)) / choices.devices,
          .method = rounded((choices.method.vectors + basis) * vector),
          .preconditioner =
              rounded(choices.preconditioner.vectors * vector + choices.preconditioner.matrices * copy),
          .residual = hasDoubles ? rounded(residualVectors * 8.0 * unknowns) + copyInDoubles : 0};
}

void checkMemory(sk::Device& device, const Operator& a, std::string_view what, const MemoryChoices& choices) {
  const std::optional<std::int64_t> available = device.availableMemory();
  if (!available) return;
  const MemoryNeed need = memoryNeed(a, choices, hasDoubles(device));
  if (need.total() <= *available) return;
  const bool isHalf = choices.arithmetic.vectors == sk::Storage::Half;
  throw sk::Error(
      fmt::format("{} needs about {} bytes ({} for the matrix, {} for the solver '{}', {} for the "
                  "preconditioner '{}', "
                  "{} "
                  "for the residual), and '{}' has {} available; take {}{}a solver with fewer vectors, or a "
                  "device with "
                  "more memory",
                  what, need.total(), need.matrix, need.method, choices.method.name, need.preconditioner,
                  choices.preconditioner.name, need.residual, device.name(), *available,
                  smallerLayout(a, choices, need.matrix), isHalf ? "" : "storage in halves, "),
      sk::Error::Kind::Memory);
}

}  // namespace sk::linear
