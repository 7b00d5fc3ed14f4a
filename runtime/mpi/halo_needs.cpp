// SPDX-License-Identifier: MIT
#include "halo_needs.hpp"

#include <algorithm>
#include <optional>

#include "assemble/append/append_passes.hpp"
#include "assemble/condition.hpp"
#include "call/check_argument.hpp"
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
        spread.push_back(
            {i, stream, parameter.role == Role::Output, isGather, isGather ? depthOf(i) : Depth{}});
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
    if (stream.domain != &domain_) {
      fail(kernel_, "'{}' is of another sk::Domain than the other streams; give streams of one domain",
           parameter.name);
    }
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
    if (parameter.rank != domain_.parts.whole().rank()) {
      fail(Error::Kind::Shape, kernel_, "'{}' is a gather of {} dimension(s), but the domain has shape {}",
           parameter.name, parameter.rank, toString(domain_.parts.whole()));
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

  /// What gather number `i` reads around an element, in dimensions that are divided.
  Depth depthOf(std::size_t i) const {
    const Parameter& gather = kernel_.parameters[i];
    const domain::Decomposition& parts = domain_.parts;
    const int rank = parts.whole().rank();
    Depth depth;
    for (int d = 0; d < rank; ++d) {
      if (parts.split()[d] == 1) continue;
      const std::optional<HaloLimits> limits =
          hasDomainsShapes(gather) ? haloLimits(gather, rank - 1 - d, specs_) : std::nullopt;
      if (!limits) refuseFarReads(gather, d);
      std::int64_t below = limits->below, above = limits->above;
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

  /// Whether all that the reach of a gather depends on is spread, so that it has the shape of the domain.
  bool hasDomainsShapes(const Parameter& gather) const {
    if (gather.halo.empty()) return false;
    for (std::size_t i = 0; i < arguments_.size() && i < 64; ++i) {
      if ((gather.haloShapes >> i & 1) != 0 && arguments_[i].region.distributed == nullptr) return false;
    }
    return true;
  }

  [[noreturn]] void refuseFarReads(const Parameter& gather, int d) const {
    const int rank = domain_.parts.whole().rank();
    const char letter = "xyzw"[rank - 1 - d];
    const bool isTable = std::ranges::any_of(gather.halo, [&](const Reach& reach) {
      return reach.dimension == rank - 1 - d && reach.kind == Reach::Kind::Whole;
    });
    if (isTable) {
      fail(
          kernel_,
          "'{}' is read anywhere along {}, but it is divided there over {} ranks; give an ordinary stream of "
          "domain.device() that has the same elements on every rank, or do not divide dimension {}",
          gather.name, letter, domain_.parts.split()[d], d);
    }
    fail(kernel_,
         "how far '{}' is read along {} is not known, and it is divided there over {} ranks; promise a "
         "distance with "
         "[[halo(n)]] in the declaration, or do not divide dimension {}",
         gather.name, letter, domain_.parts.split()[d], d);
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
