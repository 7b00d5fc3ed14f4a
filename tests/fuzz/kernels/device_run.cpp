// SPDX-License-Identifier: MIT
#include "kernels/device_run.hpp"

#include <cstddef>
#include <cstring>
#include <deque>
#include <optional>

#include <fmt/format.h>

#include "kernels/untyped.hpp"
#include "sk/call.hpp"
#include "sk/scalar_bytes.hpp"

namespace fuzz {
namespace {

using Bytes = std::vector<std::byte>;

std::size_t sizeOf(Scalar scalar) { return sk::program::hostBytes(static_cast<sk::program::Scalar>(scalar)); }

/// The storage bits of a component whose arithmetic type has these bits.
std::uint32_t stored(Scalar scalar, std::uint32_t bits) {
  const auto value = std::bit_cast<float>(bits);
  if (scalar == Scalar::Half) return sk::half(value).bits();
  if (!isNormalized(scalar)) return bits;
  if (scalar == Scalar::Unorm8) return sk::unorm8(value).integer();
  if (scalar == Scalar::Snorm8) return static_cast<std::uint32_t>(sk::snorm8(value).integer());
  if (scalar == Scalar::Unorm16) return sk::unorm16(value).integer();
  return static_cast<std::uint32_t>(sk::snorm16(value).integer());
}

/// Calls visit(scalar, byte offset, component number) for each component of an element.
template <class Visit>
void components(const sk::program::Element& element, Visit visit) {
  int number = 0;
  for (const sk::program::Field& field : element.fields) {
    for (std::size_t i = 0; i < field.width; ++i)
      visit(field.scalar, field.offset + i * sizeOf(field.scalar), number++);
  }
}

/// Writes values as they lie in host memory. A uniform array is one element of many values, `perValue` components each.
void pack(const sk::program::Element& element, std::span<const Value> values, int perValue,
          std::byte* target) {
  components(element, [&](Scalar scalar, std::size_t offset, int number) {
    const Value& value = values[static_cast<std::size_t>(number / perValue)];
    const std::uint32_t bits = stored(scalar, value.asUint(number % perValue));
    std::memcpy(target + offset, &bits, sizeOf(scalar));  // the low bytes: the host is little-endian
  });
}

sk::Shape shapeOf(const std::vector<std::int64_t>& extents) {
  sk::Shape shape = extents.size() == 1   ? sk::Shape(0)
                    : extents.size() == 2 ? sk::Shape(0, 0)
                                          : sk::Shape(0, 0, 0);
  for (std::size_t d = 0; d < extents.size(); ++d) shape = shape.with(static_cast<int>(d), extents[d]);
  return shape;
}

std::string show(Scalar scalar, std::uint32_t bits) {
  const Scalar arithmetic = arithmeticScalar(scalar);
  if (arithmetic == Scalar::Float) return fmt::format("{}", std::bit_cast<float>(bits));
  return arithmetic == Scalar::Uint ? fmt::format("{}", bits)
                                    : fmt::format("{}", static_cast<std::int32_t>(bits));
}

class Run {
 public:
  Run(sk::Device& device, const sk::program::Kernel& compiled, const RandomKernel& kernel)
      : device_(device), compiled_(compiled), kernel_(kernel) {}

  std::string difference() {
    std::vector<sk::Argument> arguments;
    for (std::size_t p = 0; p < kernel_.parameters().size(); ++p) arguments.push_back(argument(p));
    sk::run(compiled_, arguments);
    const std::vector<HostStream> expected = kernel_.results();
    std::string text;
    for (std::size_t p = 0; p < expected.size(); ++p) {
      const Role role = kernel_.parameters()[p].role;
      const bool isWritten = role == Role::Output || role == Role::VariableOutput || role == Role::Scatter;
      if (isWritten) text += compare(p, expected[p]);
    }
    return text;
  }

 private:
  const sk::program::Element& element(std::size_t p) const { return *compiled_.parameters[p].element; }

  sk::Argument argument(std::size_t p) {
    const Parameter& parameter = kernel_.parameters()[p];
    switch (parameter.role) {
      case Role::Uniform:
      case Role::Spec: return {.value = packed(p, parameter.values)};
      case Role::Iterator: return {.value = ends(p)};
      case Role::Output: return {.region = stream(p, shapeOf(kernel_.domain())).region()};
      case Role::VariableOutput: return {.region = stream(p, sk::Shape(0)).handle()};
      default: {
        const HostStream& host = kernel_.streams()[p];
        sk::Stream<Untyped>& made = stream(p, shapeOf(host.shape));
        Bytes& bytes = bytes_.emplace_back(host.elements.size() * element(p).size);
        const int count = componentsOf(kernel_.records(), host.type);
        for (std::size_t i = 0; i < host.elements.size(); ++i) {
          pack(element(p), {&host.elements[i], 1}, count, bytes.data() + i * element(p).size);
        }
        sk::detail::write(made.region(), bytes.data(), host.elements.size());
        return {.region = made.region()};
      }
    }
  }

  const void* packed(std::size_t p, const std::vector<Value>& values) {
    Bytes& bytes = bytes_.emplace_back(element(p).size);
    pack(element(p), values, componentsOf(kernel_.records(), kernel_.parameters()[p].variable.type),
         bytes.data());
    return bytes.data();
  }

  /// The begin and the end of an iterator, one after the other.
  const void* ends(std::size_t p) {
    const Parameter& parameter = kernel_.parameters()[p];
    const std::vector<std::int64_t>& domain = kernel_.domain();
    const Type type = parameter.variable.type;
    std::int64_t all = 1;
    for (const std::int64_t extent : domain) all *= extent;
    Value end;
    for (int i = 0; i < type.width; ++i) {
      const std::int64_t n = type.width == 1 || domain.size() == 1
                                 ? all
                                 : domain[domain.size() - 1 - static_cast<std::size_t>(i)];
      const Value &begin = parameter.values[0], &step = parameter.values[1];
      if (type.scalar == Scalar::Float) {
        end.set(i, begin.asFloat(i) + static_cast<float>(n) * step.asFloat(i));
      } else {
        end.set(i, begin.asUint(i) + static_cast<std::uint32_t>(n) * step.asUint(i));
      }
    }
    Bytes& bytes = bytes_.emplace_back(2 * element(p).size);
    pack(element(p), {&parameter.values[0], 1}, type.width, bytes.data());
    pack(element(p), {&end, 1}, type.width, bytes.data() + element(p).size);
    return bytes.data();
  }

  sk::Stream<Untyped>& stream(std::size_t p, const sk::Shape& shape) {
    Untyped::element = &element(p);
    streams_.resize(kernel_.parameters().size());
    return streams_[p].emplace(device_.stream<Untyped>(shape));
  }

  std::string compare(std::size_t p, const HostStream& expected) {
    const sk::program::Element& type = element(p);
    const auto count = static_cast<std::int64_t>(expected.elements.size());
    if (streams_[p]->size() != count) {
      return fmt::format("output {} has {} elements, not {}\n", kernel_.parameters()[p].variable.name,
                         streams_[p]->size(), count);
    }
    Bytes bytes(expected.elements.size() * type.size);
    sk::detail::read(streams_[p]->region(), bytes.data(), expected.elements.size());
    const std::vector<Scalar> scalars = scalarsOf(kernel_.records(), expected.type);
    for (std::size_t i = 0; i < expected.elements.size(); ++i) {
      std::string text;
      components(type, [&](Scalar scalar, std::size_t offset, int number) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, bytes.data() + i * type.size + offset, sizeOf(scalar));
        const std::uint32_t wanted = expected.elements[i].asUint(number);
        if (agree(scalar, bits, stored(scalar, wanted)) || !text.empty()) return;
        text = fmt::format("output {} at element {}, component {} of {}: {:#x}, not {:#x} ({})\n",
                           kernel_.parameters()[p].variable.name, i, number,
                           spelling(kernel_.records(), expected.type), bits, stored(scalar, wanted),
                           show(scalar, wanted));
      });
      if (!text.empty()) return text;
    }
    return {};
  }

  /// Whether two components are the same in the bytes that the host stores, apart from the sign of a zero.
  static bool agree(Scalar scalar, std::uint32_t a, std::uint32_t b) {
    if (scalar == Scalar::Float) return std::bit_cast<float>(a) == std::bit_cast<float>(b);
    if (scalar == Scalar::Half) return a == b || ((a | b) & 0x7fffu) == 0;
    const std::uint32_t mask = sizeOf(scalar) == 1 ? 0xffu : sizeOf(scalar) == 2 ? 0xffffu : ~0u;
    return (a & mask) == (b & mask);
  }

  sk::Device& device_;
  const sk::program::Kernel& compiled_;
  const RandomKernel& kernel_;
  std::deque<Bytes> bytes_;
  std::vector<std::optional<sk::Stream<Untyped>>> streams_;
};

}  // namespace

std::string difference(sk::Device& device, const sk::program::Kernel& compiled, const RandomKernel& kernel) {
  return Run(device, compiled, kernel).difference();
}

}  // namespace fuzz
