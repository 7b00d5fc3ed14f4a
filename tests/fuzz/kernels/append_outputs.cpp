// SPDX-License-Identifier: MIT
#include "kernels/append_outputs.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "kernels/types.hpp"

namespace fuzz {
namespace {

constexpr int depth = 2;

/// Combines one component of the old element and of the written value.
std::uint32_t combined(ScatterOp op, Scalar scalar, std::uint32_t old, std::uint32_t value) {
  if (op == ScatterOp::Store) return value;
  if (op == ScatterOp::Add) return old + value;
  const bool isMin = op == ScatterOp::Min;
  if (scalar == Scalar::Float) {
    const float a = std::bit_cast<float>(old), b = std::bit_cast<float>(value);
    return std::bit_cast<std::uint32_t>(isMin ? std::min(a, b) : std::max(a, b));
  }
  if (scalar == Scalar::Uint) return isMin ? std::min(old, value) : std::max(old, value);
  const auto a = static_cast<std::int32_t>(old), b = static_cast<std::int32_t>(value);
  return static_cast<std::uint32_t>(isMin ? std::min(a, b) : std::max(a, b));
}

std::string written(const AppendOutput& output, const std::string& index, const std::string& value) {
  const std::string place = fmt::format("{}[{}]", output.name, index);
  switch (output.op) {
    case ScatterOp::Store: return fmt::format("{} = {};", place, value);
    case ScatterOp::Add: return fmt::format("{} += {};", place, value);
    case ScatterOp::Min: return fmt::format("{} = min({}, {});", place, place, value);
    case ScatterOp::Max: return fmt::format("{} = max({}, {});", place, place, value);
  }
  return {};
}

/// The element number of an index, x first, in a stream; nullopt if it is out of bounds.
std::optional<std::size_t> placeIn(const HostStream& stream, const Value& index) {
  const std::size_t rank = stream.shape.size();
  std::int64_t number = 0;
  for (std::size_t d = 0; d < rank; ++d) {
    const std::int64_t at = index.asInt(static_cast<int>(rank - 1 - d));
    if (at < 0 || at >= stream.shape[d]) return std::nullopt;
    number = number * stream.shape[d] + at;
  }
  return static_cast<std::size_t>(number);
}

}  // namespace

ScatterOp randomScatterOp(const Type& type, Random& random) {
  static constexpr ScatterOp ofIntegers[] = {ScatterOp::Store, ScatterOp::Add, ScatterOp::Min,
                                             ScatterOp::Max};
  static constexpr ScatterOp ofFloats[] = {ScatterOp::Store, ScatterOp::Min, ScatterOp::Max};
  const bool isNumber = type.record < 0 && !type.isMatrix && !isNarrow(type.scalar);
  if (!isNumber || type.scalar == Scalar::Bool) return ScatterOp::Store;
  return type.scalar == Scalar::Float ? random.pick(ofFloats) : random.pick(ofIntegers);
}

Statement writeTo(const AppendOutput& output, Expressions& expressions, const Records& records,
                  Random& random, const std::string& indent) {
  const Expr value = expressions.makeKept(output.type, depth);
  const auto stream = static_cast<std::size_t>(output.stream);
  if (output.rank == 0) {
    return {fmt::format("{}push({}, {});\n", indent, output.name, value.text),
            [stream, made = value.value](Frame& frame) {
              (*frame.appendOutputs)[stream].elements.push_back(made(frame));
              return Flow::Next;
            }};
  }
  Expr index = expressions.make({Scalar::Int, output.rank}, depth);
  const bool isNear = random.chance(3, 4);
  const std::string at = isNear ? fmt::format("{} & {}", index.text, leastScattered - 1) : index.text;
  const int count = componentsOf(records, output.type);
  return {fmt::format("{}{}\n", indent, written(output, at, value.text)),
          [stream, output, isNear, count, where = index.value, made = value.value](Frame& frame) {
            Value place = where(frame);
            if (isNear) {
              for (int i = 0; i < output.rank; ++i) place.set(i, place.asUint(i) & (leastScattered - 1u));
            }
            const Value comes = made(frame);
            HostStream& target = (*frame.appendOutputs)[stream];
            const std::optional<std::size_t> number = placeIn(target, place);
            if (!number) return Flow::Next;
            Value& element = target.elements[*number];
            for (int i = 0; i < count; ++i) {
              element.set(i, combined(output.op, output.type.scalar, element.asUint(i), comes.asUint(i)));
            }
            return Flow::Next;
          }};
}

}  // namespace fuzz
