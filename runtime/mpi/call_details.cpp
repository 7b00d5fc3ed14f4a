// SPDX-License-Identifier: MIT
#include "call_details.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "call_plan.hpp"
#include "device/configuration.hpp"
#include "domain_state.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk::mpi {

using program::Element;
using program::Field;
using program::Role;
using program::Scalar;

namespace {

template <class T>
std::string numberText(const std::byte* from) {
  T number;
  std::memcpy(&number, from, sizeof number);
  return fmt::format("{}", number);
}

std::string scalarText(Scalar scalar, const std::byte* from) {
  switch (scalar) {
    case Scalar::Bool: return *from == std::byte{0} ? "false" : "true";
    case Scalar::Int: return numberText<std::int32_t>(from);
    case Scalar::Uint: return numberText<std::uint32_t>(from);
    case Scalar::Float: return numberText<float>(from);
    case Scalar::Double: return numberText<double>(from);
    case Scalar::Long: return numberText<std::int64_t>(from);
    case Scalar::Ulong: return numberText<std::uint64_t>(from);
    case Scalar::Short:
    case Scalar::Snorm16: return numberText<std::int16_t>(from);
    case Scalar::Ushort:
    case Scalar::Unorm16: return numberText<std::uint16_t>(from);
    case Scalar::Char:
    case Scalar::Snorm8: return std::to_string(static_cast<std::int8_t>(*from));
    case Scalar::Uchar:
    case Scalar::Unorm8: return std::to_string(static_cast<std::uint8_t>(*from));
    case Scalar::Half: break;
  }
  std::uint16_t bits;
  std::memcpy(&bits, from, sizeof bits);
  return fmt::format("half {:#06x}", bits);
}

/// Calls visit(scalar, bytes) for each scalar of the elements of a value, and for nothing that is between them.
template <class Visit>
void forEachScalar(const program::Parameter& parameter, const void* value, Visit&& visit) {
  const std::size_t ends = parameter.role == Role::Iterator ? 2 : 1;
  const Element& element = *parameter.element;
  for (std::size_t k = 0; k < ends; ++k) {
    const std::byte* const from = static_cast<const std::byte*>(value) + k * element.size;
    for (const Field& field : element.fields) {
      for (std::size_t c = 0; c < field.width; ++c)
        visit(field.scalar, from + field.offset + c * program::hostBytes(field.scalar));
    }
  }
}

std::string valueText(const program::Parameter& parameter, const void* value) {
  std::vector<std::string> scalars;
  forEachScalar(parameter, value,
                [&](Scalar scalar, const std::byte* from) { scalars.push_back(scalarText(scalar, from)); });
  if (scalars.size() == 1) return scalars.front();
  return fmt::format("{{{}}}", fmt::join(scalars, ", "));
}

const DomainStreamState* spreadStream(const Argument& argument) {
  return static_cast<const DomainStreamState*>(argument.region.distributed);
}

/// The number of the stream's domain; 0 if it has ended.
std::int64_t domainOf(const DomainStreamState& stream) {
  return stream.domain == nullptr ? 0 : stream.domain->number;
}

void add(Hash& hash, const Index& index) {
  hash.add(index.rank());
  for (int d = 0; d < index.rank(); ++d) hash.add(index[d]);
}

}  // namespace

void KernelDetails::addTo(Call& call) const {
  Hash hash;
  add(hash, options_.box.begin);
  add(hash, options_.box.end);
  for (std::size_t i = 0; i < arguments_.size() && i < kernel_.parameters.size(); ++i) {
    const Argument& argument = arguments_[i];
    const DomainStreamState* const stream = spreadStream(argument);
    hash.add(stream == nullptr ? 0 : domainOf(*stream));
    hash.add(stream == nullptr ? 0 : stream->number);
    for (int d = 0; d < argument.region.shape.rank(); ++d) hash.add(argument.region.shape[d]);
    if (argument.value == nullptr) continue;
    forEachScalar(kernel_.parameters[i], argument.value, [&](Scalar scalar, const std::byte* from) {
      hash.addBytes({reinterpret_cast<const char*>(from), program::hostBytes(scalar)});
    });
  }
  call.add(hash.value());
}

std::string KernelDetails::wordsOf(const Argument& argument, const program::Parameter& parameter) const {
  if (argument.isNone) return "none";
  if (argument.value != nullptr) return valueText(parameter, argument.value);
  const DomainStreamState* const stream = spreadStream(argument);
  if (stream == nullptr)
    return fmt::format("an ordinary stream of shape {}", toString(argument.region.shape));
  return fmt::format("stream {} of domain {}", stream->number, domainOf(*stream));
}

std::string KernelDetails::details() const {
  std::string lines = linesOf(domain_, options_, options_.box);
  for (std::size_t i = 0; i < arguments_.size() && i < kernel_.parameters.size(); ++i)
    lines +=
        fmt::format("{} = {}\n", kernel_.parameters[i].name, wordsOf(arguments_[i], kernel_.parameters[i]));
  if (plan_ != nullptr) lines += fmt::format("{}\n", plan_->halos());
  return lines;
}

std::string linesOf(const DomainState& domain, const CallOptions& options, const Box& box) {
  std::string lines = fmt::format("domain {}\n", domain.number);
  for (const std::string& choice : choicesOf(options)) lines += choice + '\n';
  if (options.scan == Scan::Exclusive) lines += "exclusive\n";
  if (options.along) lines += fmt::format("along {}\n", *options.along);
  if (options.over) lines += fmt::format("over {}\n", toString(options.over->shape));
  if (!box.isWhole()) lines += fmt::format("box from {} to {}\n", toString(box.begin), toString(box.end));
  return lines;
}

StreamCall::StreamCall(std::string_view what, const DomainState& domain) : what_(what) {
  hash_.add(what);
  with("domain", domain.number);
}

StreamCall::StreamCall(std::string_view what, const DomainStreamState& stream)
    : StreamCall(what, *stream.domain) {
  with("elements", stream.element.name);
  with("storage", nameOf(stream.storage()));
  if (stream.domain->agreement.isAlways()) with("stream", stream.number);
}

StreamCall& StreamCall::with(std::string_view name, std::string_view value) {
  hash_.add(name);
  hash_.add(value);
  const std::size_t room = text_.size() - length_;
  const auto end = fmt::format_to_n(text_.data() + length_, room, "{} {}\n", name, value);
  length_ += std::min(room, end.size);
  return *this;
}

StreamCall& StreamCall::with(std::string_view name, std::int64_t value) {
  std::array<char, 24> digits;
  const auto end = fmt::format_to_n(digits.data(), digits.size(), "{}", value);
  return with(name, std::string_view(digits.data(), end.size));
}

}  // namespace sk::mpi
