// SPDX-License-Identifier: MIT
//
// Calls a kernel on several sets of inputs: ordinary elements, which are also timed; if it has uniforms,
// fewer elements with several draws of the uniforms; elements with extremes among them; and extreme uniforms.
#include "accuracy/file/measure.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "accuracy/compare_modes.hpp"
#include "accuracy/file/call.hpp"
#include "accuracy/file/errors.hpp"
#include "sk/error.hpp"
#include "sk/native/code.hpp"

namespace sk_tool {

namespace {

using sk::Accumulate;
using sk::Contraction;
using sk::Intrinsics;
using sk::Precision;
using sk::Tables;
using sk::program::Parameter;
using sk::program::Role;

constexpr std::int64_t usualSize = std::int64_t{1} << 20;
constexpr int draws = 16;  ///< of uniforms
constexpr std::int64_t extremeMixes = 512;  ///< elements beyond those with a single extreme scalar
constexpr std::int64_t extremeBlock = 64;  ///< elements of a reduction, one of which is extreme

// ---- what is measured -----------------------------------------------------------------------------

/// Why a kernel cannot be measured; empty if it can.
std::string obstacleTo(const Subject& subject) {
  if (subject.reduction != nullptr && subject.reduction->parts != nullptr) {
    return "it folds beside its outputs; measure a kernel that computes the outputs and a reduce that folds "
           "the same";
  }
  for (const Parameter& parameter : subject.parameters()) {
    if (parameter.role == Role::VariableOutput || parameter.role == Role::Scatter) {
      return fmt::format(
          "'{}' is a {} output, whose elements belong to no inputs; measure a kernel that computes "
          "the same into 'out T r<>'",
          parameter.name, parameter.role == Role::Scatter ? "scatter" : "variable");
    }
  }
  const std::vector<ResultScalar> results = resultScalars(subject);
  if (std::none_of(results.begin(), results.end(),
                   [](const ResultScalar& one) { return isReal(one.scalar); })) {
    return "there are no floats in its results, so that nothing is rounded; give it an output of those that "
           "it computes";
  }
  return {};
}

bool isNamed(const Subject& subject, const std::string& name) {
  const std::string whole = subject.name();
  return name.empty() || whole == name || whole.ends_with("::" + name);
}

[[noreturn]] void failWith(const std::vector<std::string>& skipped) {
  throw std::runtime_error(fmt::format("no kernel can be measured\n  {}", fmt::join(skipped, "\n  ")));
}

std::vector<Subject> chosenSubjects(const sk::program::Library& library, const std::string& name,
                                    std::vector<std::string>& skipped) {
  std::vector<Subject> all;
  for (const sk::program::Kernel* kernel : library.kernels) all.push_back({.kernel = kernel});
  for (const sk::program::Reduction* reduction : library.reductions) all.push_back({.reduction = reduction});
  std::vector<Subject> chosen;
  std::string known;
  for (const Subject& subject : all) {
    known += fmt::format("{}{}", known.empty() ? "" : ", ", subject.name());
    if (!isNamed(subject, name)) continue;
    const std::string obstacle = obstacleTo(subject);
    if (obstacle.empty()) {
      chosen.push_back(subject);
    } else {
      skipped.push_back(fmt::format("{}: {}", subject.name(), obstacle));
    }
  }
  if (!chosen.empty()) return chosen;
  if (skipped.empty()) {
    throw std::runtime_error(
        fmt::format("the file has no kernel '{}'; it has {}", name, known.empty() ? "none" : known));
  }
  failWith(skipped);
}

// ---- modes ----------------------------------------------------------------------------------------

struct CallMode {
  std::string name;
  sk::CallOptions options;
};

/// Whether products and sums of a kernel may be fused; native code of other kernels has no such entries.
bool hasContractedCode(const sk::program::Kernel& kernel) {
  if (kernel.code == nullptr) return false;
  const std::span<const sk::native::Entry> entries(kernel.code->entries, kernel.code->entryCount);
  return std::ranges::any_of(entries, [](const sk::native::Entry& entry) { return entry.isContracted != 0; });
}

/// Sets every option, so that choices of the kernel's declaration have no effect.
std::vector<CallMode> modesOf(const Subject& subject, const sk::Device& device) {
  const sk::program::Kernel& kernel = subject.signature();
  const bool isNative = device.shadingLanguage().empty();
  const bool hasFast = !kernel.intrinsics.empty() && !isNative;
  const auto said = [](Accumulate accumulate, Precision precision) {
    return sk::CallOptions{.accumulate = accumulate,
                           .precision = precision,
                           .intrinsics = Intrinsics::Accurate,
                           .tables = Tables::Off,
                           .contraction = Contraction::Exact};
  };
  const Accumulate plain = subject.isReduce() ? Accumulate::Tree : Accumulate::Default;
  std::vector<CallMode> modes{{subject.isReduce() ? "tree" : "single", said(plain, Precision::Single)}};
  const std::string first = modes.front().name;
  if (hasFast) {
    sk::CallOptions fast = said(plain, Precision::Single);
    fast.intrinsics = Intrinsics::Fast;
    modes.push_back({first + ", fast", fast});
  }
  if (!kernel.tables.empty()) {
    sk::CallOptions tables = said(plain, Precision::Single);
    tables.tables = Tables::On;
    modes.push_back({first + ", tables", tables});
  }
  if (isNative && hasContractedCode(kernel)) {
    sk::CallOptions contracted = said(plain, Precision::Single);
    contracted.contraction = Contraction::Fast;
    modes.push_back({first + ", contracted", contracted});
  }
  if (subject.isReduce()) modes.push_back({"compensated", said(Accumulate::Compensated, Precision::Single)});
  modes.push_back({"extended", said(plain, Precision::Extended)});
  modes.push_back({"double", said(plain, Precision::Double)});
  if (subject.isReduce()) modes.push_back({"exact", said(Accumulate::Exact, Precision::Single)});
  modes.push_back({"half", said(plain, Precision::Half)});
  return modes;
}

// ---- inputs ---------------------------------------------------------------------------------------

sk::Shape ones(int rank) { return cubeOf(rank, 1); }

Extent ordinaryExtent(const Subject& subject, const sk::Shape& domain, int drawn) {
  return {.domain = domain, .results = subject.isReduce() ? ones(domain.rank()) : domain, .draws = drawn};
}

/// For a reduction: `count` blocks with one result each.
Extent extremeExtent(const Subject& subject, std::int64_t count, int drawn) {
  const int rank = rankOf(subject);
  if (!subject.isReduce()) return ordinaryExtent(subject, cubeOf(rank, count), drawn);
  if (rank == 1) return {.domain = {count * extremeBlock}, .results = {count}, .draws = drawn};
  return {.domain = ones(rank).with(0, count).with(1, extremeBlock),
          .results = ones(rank).with(0, count),
          .draws = drawn};
}

/// Inputs with their results, on the device and on the reference.
struct Set {
  Set(sk::Device& device, sk::Device& reference, const Subject& subject, Inputs drawn, Extremes kind)
      : inputs(std::move(drawn)), extremes(kind), call(device, subject, inputs) {
    Call exact(reference, subject, inputs);
    for (int draw = 0; draw < inputs.extent.draws; ++draw) {
      exact.run({.precision = Precision::Single}, draw);  // overrides the kernel's declaration
      truths.push_back(exact.exactResults());
    }
  }
  Set(const Set&) = delete;
  Set& operator=(const Set&) = delete;

  Inputs inputs;
  Extremes extremes;
  Call call;
  std::vector<Results> truths;  ///< one per draw
};

// ---- results --------------------------------------------------------------------------------------

class Measured {
 public:
  Measured(sk::Device& device, sk::Device& reference, const Subject& subject,
           const FileMeasurement& measurement)
      : device_(device),
        reference_(reference),
        subject_(subject),
        measurement_(measurement),
        scalars_(resultScalars(subject)) {
    const sk::Shape domain = domainOf();
    size_ = domain.size();
    add(ordinaryExtent(subject, domain, 1), Extremes::None);
    if (hasDrawnValues(subject, measurement.ranges)) {
      add(ordinaryExtent(subject, cubeOf(domain.rank(), std::max<std::int64_t>(size_ / draws, 1)), draws),
          Extremes::None);
    }
    if (!measurement.hasExtremes) return;
    addExtremes(Extremes::InElements);
    addExtremes(Extremes::InValues);
  }

  Experiment experiment() {
    Experiment experiment{.program = subject_.name(), .data = "drawn", .about = about(), .bounded = ""};
    std::vector<Mode> modes;
    for (const CallMode& mode : modesOf(subject_, device_)) {
      modes.push_back({mode.name, [this, options = mode.options] {
                         return Trial{[this, options] { sets_.front()->call.run(options, 0); },
                                      [this, options] { return grade(options); }};
                       }});
    }
    experiment.rows = compareModes(device_, modes, measurement_.rounds);
    return experiment;
  }

 private:
  sk::Shape domainOf() const {
    const std::vector<std::int64_t>& extents = measurement_.extents;
    if (extents.size() > 1) return shapeOf(extents);
    return cubeOf(rankOf(subject_), extents.empty() ? usualSize : extents.front());
  }

  void add(const Extent& extent, Extremes extremes) {
    sets_.push_back(std::make_unique<Set>(device_, reference_, subject_,
                                          drawInputs(subject_, measurement_.ranges, extent, extremes),
                                          extremes));
  }

  void addExtremes(Extremes where) {
    const auto scalars = static_cast<std::int64_t>(extremeScalars(subject_, measurement_.ranges, where));
    if (scalars == 0) return;
    const std::int64_t apart = scalars * static_cast<std::int64_t>(mostExtremes);
    if (where == Extremes::InElements) {
      add(extremeExtent(subject_, apart + extremeMixes, 1), where);
    } else {
      add(extremeExtent(subject_, 16, static_cast<int>(std::min<std::int64_t>(apart, 256))), where);
    }
  }

  std::string about() const {
    std::string text = fmt::format("{} elements", size_);
    if (const std::string ranges = measurement_.ranges.text(); !ranges.empty()) text += "; " + ranges;
    return text;
  }

  Grade grade(const sk::CallOptions& options) {
    ErrorSizes sizes(scalars_);
    ErrorCounts counts(scalars_);
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      Set& set = *sets_[s];
      for (int draw = 0; draw < set.inputs.extent.draws; ++draw) {
        set.call.run(options, draw);
        const Results results = set.call.results();
        const Results& truth = set.truths[static_cast<std::size_t>(draw)];
        if (set.extremes == Extremes::None) {
          sizes.add(results, truth, s, draw);
        } else {
          counts.add(results, truth, s, draw);
        }
      }
    }
    Grade grade{.metrics = sizes.metrics()};
    grade.worst = caseOf(sizes.worst(), !subject_.isReduce());
    if (counts.tried() > 0) grade.extremes = extremesOf(counts);
    return grade;
  }

  ExtremeCounts extremesOf(const ErrorCounts& counts) const {
    ExtremeCounts extremes{counts.tried(), counts.otherClass(), counts.otherValue(), {}};
    if (counts.otherClass() + counts.otherValue() > 0) extremes.example = caseOf(counts.example(), true);
    return extremes;
  }

  /// Describes a result with its expected value and its inputs, which a reduction to one value lacks.
  Json caseOf(const ErrorPlace& place, bool hasInputs) const {
    const ResultScalar& scalar = scalars_[place.scalar];
    Json json = Json::object();
    if (hasInputs) {
      const Inputs& inputs = sets_[place.inputs]->inputs;
      json["index"] = indexOf(inputs, place.result);
      json["inputs"] = inputsOf(subject_, inputs, place.draw, place.result);
    }
    json["result"] = scalar.name;
    json["got"] = jsonOf(scalar.scalar, place.got);
    json["wanted"] = jsonOf(sk::program::Scalar::Double, place.wanted);
    return json;
  }

  sk::Device& device_;
  sk::Device& reference_;
  const Subject& subject_;
  const FileMeasurement& measurement_;
  std::vector<ResultScalar> scalars_;
  std::int64_t size_ = 0;
  std::vector<std::unique_ptr<Set>> sets_;  ///< the first one is timed
};

}  // namespace

FileResults measureFile(sk::Device& device, const sk::program::Library& library,
                        const FileMeasurement& measurement,
                        const std::function<void(const Experiment&)>& report) {
  FileResults results;
  const std::vector<Subject> subjects = chosenSubjects(library, measurement.kernel, results.skipped);
  measurement.ranges.check(subjects);
  sk::Device reference = sk::Device::reference(sk::Reference::Quad);
  for (const Subject& subject : subjects) {
    try {
      results.experiments.push_back(Measured(device, reference, subject, measurement).experiment());
    } catch (const sk::Error& error) {  // even the plainest mode fails
      results.skipped.emplace_back(error.what());
      continue;
    }
    report(results.experiments.back());
  }
  if (results.experiments.empty()) failWith(results.skipped);
  return results;
}

}  // namespace sk_tool
