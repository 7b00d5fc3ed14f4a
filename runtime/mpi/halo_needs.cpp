// SPDX-License-Identifier: MIT
#include "halo_needs.hpp"

#include <algorithm>
#include <optional>

#include "assemble/append/append_passes.hpp"
#include "assemble/condition.hpp"
#include "call/check_call.hpp"
#include "call/halo_limits.hpp"
#include "call/resolved_call.hpp"
#include "sk/error.hpp"

namespace sk::mpi {

using domain::Depth;
using program::Kernel;
using program::Parameter;
using program::Reach;
using program::Role;

namespace {

class Needs {
 public:
  Needs(const DomainState& domain, const Kernel& kernel, std::span<const Argument> arguments)
      : domain_(domain), kernel_(kernel), arguments_(arguments), specs_(specsOf(kernel, arguments)) {}

  std::vector<SpreadArgument> get() const {
    std::vector<SpreadArgument> spread;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const Parameter& parameter = kernel_.parameters[i];
      refuseAppendOutput(parameter);
      if (!assemble::isNeeded(parameter, specs_)) continue;
      DomainStreamState* const stream = domainStream(arguments_[i].region);
      if (stream == nullptr) {
        checkOrdinary(parameter, arguments_[i]);
      } else {
        checkSpread(parameter, *stream, arguments_[i]);
        const bool isGather = parameter.role == Role::Gather;
        spread.push_back({i, stream, parameter.role == Role::Output, isGather,
                          isGather ? depthOf(i, stream->domain->parts) : Depth{}});
      }
    }
    return spread;
  }

 private:
  void refuseAppendOutput(const Parameter& parameter) const {
    if (!assemble::isAppendOutput(parameter)) return;
    fail(kernel_,
         "it pushes or scatters to '{}', which no rank has the right elements for; let a kernel gather in "
         "the place of "
         "the scatter, or run it on ordinary streams after gather()",
         parameter.name);
  }

  void checkSpread(const Parameter& parameter, const DomainStreamState& stream,
                   const Argument& argument) const {
    if (stream.domain != &domain_) checkOther(parameter, *stream.domain);
    if (argument.rows != nullptr || argument.fit != program::Fit::Same) {
      fail(kernel_,
           "'{}' is in rows, stretched or strided, but a stream of a domain is read element by element; give "
           "the "
           "stream itself",
           parameter.name);
    }
    const Role role = parameter.role;
    if (role == Role::Input || role == Role::Output) return;
    if (role != Role::Gather) {
      fail(kernel_,
           "'{}' takes one value, but a stream of a domain is given; give an ordinary stream of "
           "domain.device()",
           parameter.name);
    }
    const Shape& whole = stream.domain->parts.whole();
    if (parameter.rank != whole.rank()) {
      fail(Error::Kind::Shape, kernel_, "'{}' is a gather of {} dimension(s), but the domain has shape {}",
           parameter.name, parameter.rank, toString(whole));
    }
  }

  /// A gather may be of another domain, each part of which lies where the rank computes.
  void checkOther(const Parameter& parameter, const DomainState& other) const {
    if (parameter.role != Role::Gather) {
      fail(kernel_,
           "'{}' is of another sk::Domain than the elements that the call computes; give streams of one "
           "domain, and read grids of other sizes as gathers",
           parameter.name);
    }
    if (&other.device != &domain_.device) {
      fail(
          kernel_,
          "'{}' is of a sk::Domain with a device of its own; create one domain beside the other, on the same "
          "ranks and device: sk::Domain coarse(fine, {{.shape = ...}})",
          parameter.name);
    }
    const Index &split = domain_.parts.split(), &others = other.parts.split();
    for (int k = 1; k <= maxRank; ++k) {
      const std::int64_t parts = k <= split.rank() ? split[split.rank() - k] : 1;
      const std::int64_t otherParts = k <= others.rank() ? others[others.rank() - k] : 1;
      if (parts == otherParts) continue;
      fail(Error::Kind::Shape, kernel_,
           "'{}' is of a sk::Domain with split {}, but the call computes one with split {}, so that along {} "
           "a rank does not hold what it reads; create both with the same .split",
           parameter.name, toString(others), toString(split), "xyzw"[k - 1]);
    }
  }

  void checkOrdinary(const Parameter& parameter, const Argument& argument) const {
    if (argument.region.stream == nullptr) return;
    if (parameter.role == Role::Output ||
        (parameter.role == Role::Input && argument.region.shape.size() != 1)) {
      fail(kernel_,
           "'{}' is an ordinary stream of shape {}, but the others are divided over the ranks of a domain of "
           "shape {}; "
           "create it by domain.stream",
           parameter.name, toString(argument.region.shape), toString(domain_.parts.whole()));
    }
    if (parameter.role != Role::Gather) return;
    for (const Reach& reach : parameter.halo) {
      if (reach.kind != Reach::Kind::Near) continue;
      if (argument.region.shape != domain_.parts.whole()) continue;
      fail(kernel_,
           "'{}' is an ordinary stream, of which the kernel reads what is near its own element; create it by "
           "domain.stream, since only tables that are read anywhere are the same on all ranks",
           parameter.name);
    }
  }

  /// What gather number `i`, a stream of this or of another domain, reads in dimensions that are divided.
  Depth depthOf(std::size_t i, const domain::Decomposition& parts) const {
    const Parameter& gather = kernel_.parameters[i];
    Depth depth;
    for (int d = 0; d < parts.whole().rank(); ++d) {
      if (parts.split()[d] == 1) continue;
      const std::optional<HaloLimits> limits =
          haloLimits(kernel_, arguments_, i, d, specs_, domain_.parts.whole());
      if (!limits) refuseFarReads(gather, parts, d);
      auto [below, above] = &parts == &domain_.parts ? Distances{limits->below, limits->above}
                                                     : farthestOf(gather, *limits, parts, d);
      if (below + above > 0 && gather.boundary == program::Boundary::Wrap && !parts.isPeriodic(d)) {
        fail(kernel_,
             "'{}' wraps around, but the domain is divided in {} parts in dimension {} and does not wrap "
             "around there; "
             "set .periodic for it",
             gather.name, parts.split()[d], d);
      }
      // With two parts, each is the neighbor of the other on both sides. An element may lie in both halos, so both have
      // one depth.
      if (parts.split()[d] == 2 && parts.isPeriodic(d)) below = above = std::max(below, above);
      const auto k = static_cast<std::size_t>(d);
      depth.below[k] = below;
      depth.above[k] = above;
    }
    return depth;
  }

  struct Distances {
    std::int64_t below, above;
  };

  /// How far what any rank reads of another domain's stream, to compute its own elements, lies beyond its part of the stream in
  /// dimension `d`. The ranks of both domains lie at the same places.
  Distances farthestOf(const Parameter& gather, const HaloLimits& limits, const domain::Decomposition& parts,
                       int d) const {
    const GatherDimension dimension = gatherDimension(parts.whole(), d, domain_.parts.whole());
    int step = 1;  // from a rank to the next one along this dimension
    for (int k = d + 1; k < parts.split().rank(); ++k) step *= static_cast<int>(parts.split()[k]);
    Distances farthest{0, 0};
    for (int place = 0; place < parts.split()[d]; ++place) {
      const Box own = parts.boxOf(place * step);
      IndexRange read = readBy(domain_.parts.boxOf(place * step), limits, dimension);
      if (gather.boundary != program::Boundary::Wrap)
        read = broughtInside(gather.boundary, read, dimension.extent);
      farthest.below = std::max(farthest.below, own.begin[d] - read.begin);
      farthest.above = std::max(farthest.above, read.end - own.end[d]);
    }
    return farthest;
  }

  [[noreturn]] void refuseFarReads(const Parameter& gather, const domain::Decomposition& parts, int d) const {
    const int rank = parts.whole().rank();
    const char letter = "xyzw"[rank - 1 - d];
    const bool isTable = std::ranges::any_of(gather.halo, [&](const Reach& reach) {
      return reach.dimension == rank - 1 - d && reach.kind == Reach::Kind::Whole;
    });
    if (isTable) {
      fail(
          kernel_,
          "'{}' is read anywhere along {}, but it is divided there over {} ranks; give an ordinary stream of "
          "domain.device() that has the same elements on every rank, or do not divide dimension {}",
          gather.name, letter, parts.split()[d], d);
    }
    fail(kernel_,
         "how far '{}' is read along {} is not known, and it is divided there over {} ranks; promise a "
         "distance with "
         "[[halo(n)]] in the declaration, or do not divide dimension {}",
         gather.name, letter, parts.split()[d], d);
  }

  const DomainState& domain_;
  const Kernel& kernel_;
  std::span<const Argument> arguments_;
  assemble::SpecValues specs_;
};

}  // namespace

std::vector<SpreadArgument> spreadArguments(const DomainState& domain, const Kernel& kernel,
                                            std::span<const Argument> arguments) {
  if (arguments.size() != kernel.parameters.size()) {
    fail(kernel, "{} arguments are given, but {} are declared", arguments.size(), kernel.parameters.size());
  }
  return Needs(domain, kernel, arguments).get();
}

}  // namespace sk::mpi
