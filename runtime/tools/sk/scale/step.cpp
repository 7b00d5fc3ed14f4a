// SPDX-License-Identifier: MIT
#include "scale/step.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace sk_tool {

namespace {

using sk::program::Parameter;
using sk::program::Reach;
using sk::program::Role;

/// The farthest that a gather is read in one dimension.
struct FarthestReach {
  Halo halo;
  bool isUnbounded = false;
};

bool isNamed(const std::string& whole, const std::string& name) {
  return whole == name || whole.ends_with("::" + name);
}

/// Reads one kernel or reduction.
class CallReader {
 public:
  CallReader(const Subject& subject, const Extents& grid, const StepOptions& options)
      : subject_(subject), grid_(grid), options_(options) {
    for (const Parameter& parameter : subject.parameters()) {
      if (parameter.role == Role::Spec)
        specs_.push_back(options.ranges.of(parameter).front().value_or(Range{1, 1}).low);
    }
  }

  /// Why the kernel cannot be distributed; empty if it can.
  std::string obstacle() const {
    std::size_t nearRank = 0;
    std::string nearest;
    for (const Parameter& parameter : subject_.parameters()) {
      if (parameter.role == Role::VariableOutput || parameter.role == Role::Scatter) {
        return fmt::format(
            "'{}' is a {} output, which cannot be split over devices; compute the same into 'out T r<>'",
            parameter.name, parameter.role == Role::Scatter ? "scatter" : "variable");
      }
      if (parameter.role != Role::Gather || isTable(parameter)) continue;
      for (std::size_t d = 0; d < parameter.rank; ++d) {
        if (parameter.rank != grid_.size() || isConstant(parameter) || !reachOf(parameter, d).isUnbounded)
          continue;
        return fmt::format(
            "'{}' is read along {} at indices that are not near the element's; promise how far with "
            "[[halo(N)]], or "
            "pass --constant {} "
            "if no step changes it, so that every device can have a copy",
            parameter.name, "xyzw"[d], parameter.name);
      }
      if (parameter.rank > nearRank) {
        nearRank = parameter.rank;
        nearest = parameter.name;
      }
    }
    if (nearRank == 0 || nearRank == grid_.size()) return {};
    return fmt::format("'{}' has {} dimension(s), but --grid has {}", nearest, nearRank, grid_.size());
  }

  StepCall call(std::vector<bool>& periodic) const {
    StepCall call{.name = subject_.name(), .gathers = {}};
    for (const Parameter& parameter : subject_.parameters()) {
      if (parameter.role == Role::Accumulator) call.reducedBytes += parameter.element->size;
      if (parameter.role != Role::Gather || parameter.rank != grid_.size() || isTable(parameter)) continue;
      ExchangedGather gather{.name = std::string(parameter.name),
                             .stream = {.bytes = sk::program::heldBy(parameter).size, .halo = {}}};
      std::vector<Halo>& halo = gather.stream.halo;
      for (std::size_t d = parameter.rank; d-- > 0;) halo.push_back(reachOf(parameter, d).halo);
      for (std::size_t d = 0; d < periodic.size(); ++d) {
        if (parameter.boundary == sk::program::Boundary::Wrap && halo[d].both() > 0) periodic[d] = true;
      }
      if (!isConstant(parameter)) call.gathers.push_back(std::move(gather));
    }
    return call;
  }

  /// The bytes per element of the grid's streams, by parameter name.
  void addStreams(std::map<std::string, double>& bytes) const {
    for (const Parameter& parameter : subject_.parameters()) {
      const bool isElement = parameter.role == Role::Input || parameter.role == Role::Output;
      const bool isGather =
          parameter.role == Role::Gather && parameter.rank == grid_.size() && !isTable(parameter);
      if (isElement || isGather) bytes[std::string(parameter.name)] = sk::program::heldBy(parameter).size;
    }
  }

 private:
  /// Whether no index depends on the element: every device has a copy.
  static bool isTable(const Parameter& parameter) {
    const auto isWhole = [](const Reach& reach) { return reach.kind == Reach::Kind::Whole; };
    return !parameter.halo.empty() && std::ranges::all_of(parameter.halo, isWhole);
  }

  bool isConstant(const Parameter& parameter) const {
    return std::ranges::any_of(options_.constants, [&](const std::string& name) {
      return name == parameter.name || isNamed(subject_.name() + "." + std::string(parameter.name), name);
    });
  }

  std::int64_t valueOf(const sk::program::Distance& distance) const {
    auto value = static_cast<double>(distance.constant);
    for (std::size_t s = 0; s < specs_.size(); ++s) value += distance.perSpec[s] * specs_[s];
    return static_cast<std::int64_t>(std::clamp(value, 0.0, 0x1p40));
  }

  /// Dimension 0 is x.
  FarthestReach reachOf(const Parameter& gather, std::size_t dimension) const {
    FarthestReach farthest{.halo = {}, .isUnbounded = gather.halo.empty()};
    for (const Reach& reach : gather.halo) {
      if (reach.dimension != dimension) continue;
      if (reach.kind != Reach::Kind::Near) {
        farthest.isUnbounded = true;
        continue;
      }
      farthest.halo.below = std::max(farthest.halo.below, valueOf(reach.below));
      farthest.halo.above = std::max(farthest.halo.above, valueOf(reach.above));
    }
    if (farthest.isUnbounded) farthest.halo = {};
    return farthest;
  }

  const Subject& subject_;
  const Extents& grid_;
  const StepOptions& options_;
  std::vector<double> specs_;
};

std::vector<Subject> subjectsOf(const sk::program::Library& library) {
  std::vector<Subject> all;
  for (const sk::program::Kernel* kernel : library.kernels) all.push_back({.kernel = kernel});
  for (const sk::program::Reduction* reduction : library.reductions) all.push_back({.reduction = reduction});
  return all;
}

Subject subjectNamed(const std::vector<Subject>& all, const std::string& name) {
  std::string known;
  for (const Subject& subject : all) {
    if (isNamed(subject.name(), name)) return subject;
    known += (known.empty() ? "" : ", ") + subject.name();
  }
  throw std::runtime_error(
      fmt::format("the file has no kernel '{}'; it has {}", name, known.empty() ? "none" : known));
}

void checkConstants(const std::vector<Subject>& subjects, const std::vector<std::string>& constants) {
  for (const std::string& constant : constants) {
    const bool isKnown = std::ranges::any_of(subjects, [&](const Subject& subject) {
      return std::ranges::any_of(subject.parameters(), [&](const Parameter& parameter) {
        return parameter.role == Role::Gather &&
               (constant == parameter.name ||
                isNamed(subject.name() + "." + std::string(parameter.name), constant));
      });
    });
    if (!isKnown) throw std::runtime_error(fmt::format("no kernel of the step has a gather '{}'", constant));
  }
}

}  // namespace

StepOfFile stepOf(const sk::program::Library& library, const Extents& grid, const StepOptions& options) {
  const std::vector<Subject> all = subjectsOf(library);
  StepOfFile result;
  std::vector<Subject> chosen = options.kernels.empty() ? all : std::vector<Subject>{};
  for (const std::string& name : options.kernels) chosen.push_back(subjectNamed(all, name));
  options.ranges.check(chosen);
  checkConstants(chosen, options.constants);
  result.step.grid = grid;
  result.step.periodic.resize(grid.size());
  std::map<std::string, double> streams;
  for (const Subject& subject : chosen) {
    const CallReader reader(subject, grid, options);
    if (const std::string obstacle = reader.obstacle(); !obstacle.empty()) {
      result.leftOut.push_back(fmt::format("{}: {}", subject.name(), obstacle));
      continue;
    }
    result.step.calls.push_back(reader.call(result.step.periodic));
    result.subjects.push_back(subject);
    reader.addStreams(streams);
  }
  if (result.subjects.empty() && result.leftOut.empty()) throw std::runtime_error("the file has no kernel");
  if (result.subjects.empty() || (!options.kernels.empty() && !result.leftOut.empty())) {
    throw std::runtime_error(
        fmt::format("the step cannot be distributed\n  {}", fmt::join(result.leftOut, "\n  ")));
  }
  for (const auto& [name, bytes] : streams) result.step.bytesPerElement += bytes;
  return result;
}

}  // namespace sk_tool
