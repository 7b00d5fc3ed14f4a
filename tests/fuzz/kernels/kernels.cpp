// SPDX-License-Identifier: MIT
#include "kernels/kernels.hpp"

#include <algorithm>

namespace fuzz {
namespace {

/// The index of element `number`, x first.
std::array<int, 4> indexOf(const std::vector<std::int64_t>& domain, std::int64_t number) {
  std::array<int, 4> index{};
  for (std::size_t d = domain.size(); d-- > 0; number /= domain[d]) {
    index[domain.size() - 1 - d] = static_cast<int>(number % domain[d]);
  }
  return index;
}

std::int64_t sizeOf(const std::vector<std::int64_t>& shape) {
  std::int64_t size = 1;
  for (const std::int64_t extent : shape) size *= extent;
  return size;
}

/// The element of an input at an index of the domain; the input is broadcast in dimensions of extent 1.
const Value& repeated(const HostStream& stream, const std::array<int, 4>& index) {
  const std::size_t rank = stream.shape.size();
  std::int64_t number = 0;
  for (std::size_t d = 0; d < rank; ++d) {
    number = number * stream.shape[d] + std::min<std::int64_t>(index[rank - 1 - d], stream.shape[d] - 1);
  }
  return stream.elements[static_cast<std::size_t>(number)];
}

/// begin + k * step for each component. For a scalar or a one-dimensional domain, k is the element's number; otherwise it is
/// the component's index in the domain.
Value rampAt(const Parameter& iterator, const std::array<int, 4>& index, std::int64_t number,
             std::size_t rank) {
  const Type type = iterator.variable.type;
  Value value;
  for (int i = 0; i < type.width; ++i) {
    const bool countsAll = type.width == 1 || rank == 1;
    const auto k = countsAll ? static_cast<int>(number) : index[static_cast<std::size_t>(i)];
    const Value &begin = iterator.values[0], &step = iterator.values[1];
    if (type.scalar == Scalar::Float) {
      value.set(i, begin.asFloat(i) + static_cast<float>(k) * step.asFloat(i));
    } else {
      value.set(i, begin.asUint(i) + static_cast<std::uint32_t>(k) * step.asUint(i));
    }
  }
  return value;
}

}  // namespace

std::vector<HostStream> RandomKernel::results() const {
  std::vector<HostStream> results(parameters_.size());
  const std::int64_t count = sizeOf(domain_);
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    const Role role = parameters_[p].role;
    if (role == Role::Output) {
      results[p] = {parameters_[p].variable.type, domain_,
                    std::vector<Value>(static_cast<std::size_t>(count))};
    } else if (role == Role::VariableOutput || role == Role::Scatter) {
      results[p] = streams_[p];
    }
  }
  Frame frame;
  frame.streams = &streams_;
  frame.appendOutputs = &results;
  for (std::size_t d = 0; d < domain_.size(); ++d) {
    frame.extent[domain_.size() - 1 - d] = static_cast<int>(domain_[d]);
  }
  for (std::int64_t number = 0; number < count; ++number) {
    frame.index = indexOf(domain_, number);
    frame.slots.assign(static_cast<std::size_t>(slots_), {});
    for (const auto& [slot, value] : constants_) frame.slots[static_cast<std::size_t>(slot)] = value;
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      const Parameter& parameter = parameters_[p];
      const auto slot = static_cast<std::size_t>(parameter.variable.slot);
      if (parameter.role == Role::Input) {
        frame.slots[slot] = repeated(streams_[p], frame.index);
      } else if (parameter.role == Role::Iterator) {
        frame.slots[slot] = rampAt(parameter, frame.index, number, domain_.size());
      } else if (parameter.role == Role::Uniform || parameter.role == Role::Spec) {
        std::ranges::copy(parameter.values, frame.slots.begin() + static_cast<std::ptrdiff_t>(slot));
      }
    }
    body_(frame);
    for (std::size_t p = 0; p < parameters_.size(); ++p) {
      if (parameters_[p].role != Role::Output) continue;
      results[p].elements[static_cast<std::size_t>(number)] =
          frame.slots[static_cast<std::size_t>(parameters_[p].variable.slot)];
    }
  }
  return results;
}

}  // namespace fuzz
