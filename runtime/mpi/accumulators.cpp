// SPDX-License-Identifier: MIT
#include "accumulators.hpp"

#include <algorithm>
#include <cstring>

#include "call/check_reduction.hpp"
#include "native/components.hpp"
#include "native/entries.hpp"
#include "native/fold_state.hpp"
#include "native/native_stream.hpp"
#include "native/operands.hpp"
#include "sk/native/parallel.hpp"

namespace sk::mpi {

namespace {

/// The arrays of the scalars of all accumulators.
std::vector<std::byte*> arraysOf(const Accumulators& accumulators) {
  std::vector<std::byte*> arrays;
  for (const StreamRegion& region : accumulators.regions) {
    for (void* const array : nativeStream(region).components.arrays())
      arrays.push_back(static_cast<std::byte*>(array));
  }
  return arrays;
}

/// What the combining kernel reads beside accumulators: uniforms and tables.
std::vector<native::Operand> combineOperands(const program::Reduction& reduction, Operands& fold) {
  std::vector<native::Operand> operands;
  for (const std::uint8_t operand : reduction.combineOperands) operands.push_back(fold.list()[operand]);
  operands.resize(reduction.combine.parameters.size());
  return operands;
}

void combineNatively(const ResolvedReduction& call, const Accumulators& earlier, Accumulators& later,
                     const LinesOf& lines) {
  const program::Reduction& reduction = call.reduction;
  const RealType real = nativeStream(later.regions.front()).components.real();
  const CodeChoice choice{.real = real, .mayContract = call.options.contraction == Contraction::Fast};
  Operands fold(real, reduction.fold, call.arguments, call.domain, {});
  const std::vector<native::Operand> operands = combineOperands(reduction, fold);
  const native::Entry& entry = entryOf(reduction.combine, native::EntryKind::Combine, choice);
  const CodeFrame frame(reduction.combine, {operands});
  const StateShape shape(reduction.fold.parameters, real);
  const std::vector<std::byte*> from = arraysOf(earlier), to = arraysOf(later);
  const auto count = static_cast<std::int64_t>(later.elements());
  constexpr std::int64_t together = 512;
  native::inParallel(
      (count + together - 1) / together, together, native::Deal::Evenly, [&](native::Range range) {
        StateColumns state(shape, together), elements(shape, together);
        ColumnCombiner combiner(shape, functionOf<native::CombineFunction>(entry), entry.lanes, frame.get());
        for (std::int64_t piece = range.begin; piece < range.end; ++piece) {
          const std::int64_t first = piece * together, now = std::min(together, count - first);
          for (std::size_t scalar = 0; scalar < shape.scalars(); ++scalar) {
            const std::size_t bytes = shape.bytesOf(scalar);
            std::memcpy(elements.at(scalar, 0), to[scalar] + static_cast<std::size_t>(first) * bytes,
                        static_cast<std::size_t>(now) * bytes);
            for (std::int64_t k = 0; k < now; ++k) {
              const auto line = static_cast<std::size_t>(lines.lineOf(first + k));
              std::memcpy(state.at(scalar, k), from[scalar] + line * bytes, bytes);
            }
          }
          combiner.combine(state, elements, 0, now);
          for (std::size_t scalar = 0; scalar < shape.scalars(); ++scalar) {
            const std::size_t bytes = shape.bytesOf(scalar);
            std::memcpy(to[scalar] + static_cast<std::size_t>(first) * bytes, state.at(scalar, 0),
                        static_cast<std::size_t>(now) * bytes);
          }
        }
      });
}

/// Two rows: what each element follows, and the elements.
detail::StreamOwner stacked(const StreamRegion& earlier, const StreamRegion& later, const LinesOf& lines) {
  const program::Element& element = *later.stream->element;
  const std::int64_t count = later.shape.size();
  detail::StreamOwner both(
      later.stream->device->createStream(element, {2, count}, later.stream->storage).release());
  const StreamRegion all = detail::wholeRegion(both.get());
  const StreamRegion row = detail::reshaped(later, {1, count});
  detail::copy(row, detail::partOf(all, {1, 0}, {2, count}));
  Bytes lineBytes(static_cast<std::size_t>(earlier.shape.size()) * element.size);
  detail::read(earlier, lineBytes.data(), static_cast<std::size_t>(earlier.shape.size()));
  Bytes bytes(static_cast<std::size_t>(count) * element.size);
  for (std::int64_t k = 0; k < count; ++k) {
    std::memcpy(bytes.data() + static_cast<std::size_t>(k) * element.size,
                lineBytes.data() + static_cast<std::size_t>(lines.lineOf(k)) * element.size, element.size);
  }
  detail::write(detail::partOf(all, {0, 0}, {1, count}), bytes.data(), static_cast<std::size_t>(count));
  return both;
}

}  // namespace

void combineAsReduction(DomainState& domain, const ResolvedReduction& call,
                        std::span<const StreamRegion> parts, std::span<const StreamRegion> results) {
  const program::Reduction& combination = domain.rankDevice->combinations.of(call.reduction, call.device);
  std::vector<Argument> arguments;
  std::size_t nextInput = 0, nextResult = 0;
  for (std::size_t i = 0; i < combination.fold.parameters.size(); ++i) {
    const program::Role role = combination.fold.parameters[i].role;
    if (role == program::Role::Input) {
      arguments.push_back({.region = parts[nextInput++]});
    } else if (role == program::Role::Accumulator) {
      arguments.push_back({.region = results[nextResult++]});
    } else {
      arguments.push_back(call.arguments[call.reduction.combineOperands[i]]);
    }
  }
  ResolvedReduction whole = checkReduction(combination, arguments, {});
  whole.options = call.options;
  whole.device.reduce(whole);
}

void combineEach(DomainState& domain, const ResolvedReduction& call, const Accumulators& earlier,
                 Accumulators& later, const LinesOf& lines) {
  if (isInMemory(later.regions.front())) return combineNatively(call, earlier, later, lines);
  std::vector<detail::StreamOwner> owned;
  std::vector<StreamRegion> inputs, results;
  for (std::size_t k = 0; k < later.regions.size(); ++k) {
    owned.push_back(stacked(earlier.regions[k], later.regions[k], lines));
    inputs.push_back(detail::wholeRegion(owned.back().get()));
    results.push_back(detail::reshaped(later.regions[k], {1, static_cast<std::int64_t>(later.elements())}));
  }
  combineAsReduction(domain, call, inputs, results);
}

}  // namespace sk::mpi
