// SPDX-License-Identifier: MIT
#include "call/iterator.hpp"

#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "sk/error.hpp"

namespace sk {

namespace {

std::uint32_t componentOf(const void* ends, int width, int end, int component) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, static_cast<const std::byte*>(ends) + std::size_t{4} * (end * width + component), 4);
  return bits;
}

/// The number of steps that a component takes between the ends.
std::int64_t stepsOf(const program::Parameter& parameter, const Shape& domain, int component) {
  return countsElements(parameter, domain.rank()) ? domain.size() : domain[domain.rank() - 1 - component];
}

std::int64_t integerOf(program::Scalar scalar, std::uint32_t bits) {
  return scalar == program::Scalar::Int ? std::int64_t{static_cast<std::int32_t>(bits)} : std::int64_t{bits};
}

}  // namespace

bool countsElements(const program::Parameter& parameter, int rank) {
  return rank == 1 || parameter.element->fields[0].width == 1;
}

void checkIterator(const program::Kernel& kernel, const program::Parameter& parameter, const void* ends,
                   const Shape& domain) {
  const program::Field& field = parameter.element->fields[0];
  if (!countsElements(parameter, domain.rank()) && field.width != domain.rank()) {
    throw Error(
        fmt::format("{}: the iterator '{}' has {} components, but the domain {} has {} dimensions; give it "
                    "one for each, or a scalar to count the elements",
                    kernel.name, parameter.name, field.width, toString(domain), domain.rank()),
        Error::Kind::Shape);
  }
  if (field.scalar == program::Scalar::Float) {
    return;
  }
  for (int c = 0; c < field.width; ++c) {
    const std::int64_t begin = integerOf(field.scalar, componentOf(ends, field.width, 0, c));
    const std::int64_t end = integerOf(field.scalar, componentOf(ends, field.width, 1, c));
    const std::int64_t steps = stepsOf(parameter, domain, c);
    if ((end - begin) % steps != 0) {
      throw Error(
          fmt::format(
              "{}: the iterator '{}' goes from {} to {} in {} steps, which are not whole; choose ends "
              "whose difference {} divides, or iterate over float",
              kernel.name, parameter.name, begin, end, steps, steps),
          Error::Kind::Shape);
    }
  }
}

IteratorStep stepOf(const program::Parameter& parameter, const void* ends, const Shape& domain) {
  const program::Field& field = parameter.element->fields[0];
  IteratorStep step{};
  for (int c = 0; c < field.width; ++c) {
    const std::uint32_t begin = componentOf(ends, field.width, 0, c);
    const std::uint32_t end = componentOf(ends, field.width, 1, c);
    const std::int64_t steps = stepsOf(parameter, domain, c);
    if (field.scalar == program::Scalar::Float) {
      const double difference = double{std::bit_cast<float>(end)} - double{std::bit_cast<float>(begin)};
      // one step may be too long for a float only if it is never taken
      const auto length = static_cast<float>(steps == 1 ? 0 : difference / static_cast<double>(steps));
      step[static_cast<std::size_t>(c)] = std::bit_cast<std::uint32_t>(length);
    } else {
      const std::int64_t difference = integerOf(field.scalar, end) - integerOf(field.scalar, begin);
      step[static_cast<std::size_t>(c)] = static_cast<std::uint32_t>(difference / steps);
    }
  }
  return step;
}

}  // namespace sk
