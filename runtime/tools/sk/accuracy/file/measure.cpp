// SPDX-License-Identifier: MIT
//
// Calls a kernel on several sets of inputs: ordinary elements, which are also timed; if it has uniforms,
// fewer elements with several draws of the uniforms; elements at powers of 2; elements with extremes among them; and extreme uniforms.
// Then it looks for larger errors near the largest ones, and where errors jump. The reference is checked by MPFR at the worst inputs.

#include "accuracy/file/measure.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "accuracy/experiment.hpp"
#include "accuracy/file/call.hpp"
#include "accuracy/file/errors.hpp"
#include "accuracy/file/recorded.hpp"
#include "accuracy/progress.hpp"
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
constexpr std::int64_t exponentElements = 1 << 13;  ///< elements at powers of 2
constexpr std::int64_t mostSearched = 1 << 12;  ///< elements of a round of the search for larger errors
constexpr int searchRounds = 3;
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
  Set(sk::Device& device, sk::Device& reference, const Subject& subject, Inputs drawn, Extremes kind,
      bool areDrawn = true)
      : inputs(std::move(drawn)), extremes(kind), isDrawn(areDrawn), call(device, subject, inputs) {
    Call exact(reference, subject, inputs);
    for (int draw = 0; draw < inputs.extent.draws; ++draw) {
      exact.run({.precision = Precision::Single}, draw);  // overrides the kernel's declaration
      truths.push_back(exact.exactResults());
    }
  }
  Set(const Set&) = delete;
  Set& operator=(const Set&) = delete;

  bool isOrdinary() const { return extremes == Extremes::None || extremes == Extremes::AtExponents; }

  Inputs inputs;
  Extremes extremes;
  bool isDrawn;  ///< else looked for; such results do not count in means
  Call call;
  std::vector<Results> truths;  ///< one per draw
};

/// The reference, and the kernels in which MPFR computes it.
struct References {
  sk::Device quad = sk::Device::reference(sk::Reference::Quad);
  const sk::program::Library* precise = nullptr;
};

// ---- results --------------------------------------------------------------------------------------

class Measured {
 public:
  Measured(sk::Device& device, References& references, const Subject& subject,
           const FileMeasurement& measurement, const RecordedInputs* recorded)
      : device_(device),
        references_(references),
        subject_(subject),
        measurement_(measurement),
        isRecorded_(recorded != nullptr),
        scalars_(resultScalars(subject)),
        progress_(subject.name()) {
    if (recorded != nullptr) {
      addRecorded(*recorded);
      return;
    }
    const sk::Shape domain = domainOf();
    size_ = domain.size();
    add(ordinaryExtent(subject, domain, 1), Extremes::None);
    if (hasDrawnValues(subject, measurement.ranges)) {
      add(ordinaryExtent(subject, cubeOf(domain.rank(), std::max<std::int64_t>(size_ / draws, 1)), draws),
          Extremes::None);
    }
    if (extremeScalars(subject, measurement.ranges, Extremes::AtExponents) > 0 && !subject.isReduce()) {
      add(ordinaryExtent(subject, cubeOf(domain.rank(), std::min(size_, exponentElements)), 1),
          Extremes::AtExponents);
    }
    if (!measurement.hasExtremes) return;
    addExtremes(Extremes::InElements);
    addExtremes(Extremes::InValues);
  }

  Experiment experiment() {
    Experiment experiment{.program = subject_.name(),
                          .data = isRecorded_ ? "recorded" : "drawn",
                          .about = about(),
                          .bounded = ""};
    std::vector<Mode> modes;
    const std::vector<CallMode> all = modesOf(subject_, device_);
    for (std::size_t m = 0; m < all.size(); ++m) {
      modes.push_back({all[m].name, [this, m, &all] {
                         progress_.show(static_cast<double>(m) / static_cast<double>(all.size()));
                         return Trial{
                             [this, &options = all[m].options] { sets_.front()->call.run(options, 0); },
                             [this, &options = all[m].options] { return grade(options); }};
                       }});
    }
    experiment.rows = compareModes(device_, modes, measurement_.rounds);
    experiment.isReferenceChecked = references_.precise != nullptr && isElementwise(subject_) &&
                                    areAligned(subject_, sets_.front()->inputs);
    return experiment;
  }

 private:
  sk::Shape domainOf() const {
    const std::vector<std::int64_t>& extents = measurement_.extents;
    if (extents.size() > 1) return shapeOf(extents);
    return cubeOf(rankOf(subject_), extents.empty() ? usualSize : extents.front());
  }

  void add(const Extent& extent, Extremes extremes) {
    sets_.push_back(std::make_unique<Set>(device_, references_.quad, subject_,
                                          drawInputs(subject_, measurement_.ranges, extent, extremes),
                                          extremes));
  }

  void addRecorded(const RecordedInputs& recorded) {
    sets_.push_back(
        std::make_unique<Set>(device_, references_.quad, subject_, recorded.of(subject_), Extremes::None));
    size_ = sets_.front()->inputs.extent.domain.size();
  }

  /// Adds inputs that were looked for, and their errors.
  void addFound(Inputs inputs, const sk::CallOptions& options, ErrorSizes& sizes) {
    sets_.push_back(
        std::make_unique<Set>(device_, references_.quad, subject_, std::move(inputs), Extremes::None, false));
    Set& set = *sets_.back();
    set.call.run(options, 0);
    sizes.add(set.call.results(), set.truths.front(), sets_.size() - 1, 0, false);
  }

  /// An eighth of the drawn elements, within limits.
  std::int64_t searched() const { return std::clamp<std::int64_t>(size_ / 8, 512, mostSearched); }

  /// Looks for larger errors near the largest ones.
  void searchNearWorst(const sk::CallOptions& options, ErrorSizes& sizes) {
    for (int round = 0; round < searchRounds && !sizes.largest().empty(); ++round) {
      const ErrorPlace first = sizes.largest().front().place;
      std::vector<std::size_t> elements;
      for (const LargeError& one : sizes.largest()) {
        if (one.place.inputs == first.inputs && one.place.draw == first.draw)
          elements.push_back(one.place.result);
      }
      const Inputs centres = inputsAt(subject_, sets_[first.inputs]->inputs, first.draw, elements);
      addFound(inputsNear(subject_, measurement_.ranges, centres, searched(), static_cast<unsigned>(round)),
               options, sizes);
    }
  }

  /// Looks between drawn elements that are neighbours in the only scalar and whose errors differ most: branches may change there.
  void searchJumps(const sk::CallOptions& options, ErrorSizes& sizes) {
    const Set& drawn = *sets_.front();
    const std::vector<std::vector<double>> reals = drawnReals(subject_, measurement_.ranges, drawn.inputs);
    if (reals.size() != 1) return;
    const std::vector<double>& x = reals.front();
    std::vector<double> ulps(x.size(), 0);
    sets_.front()->call.run(options, 0);
    const Results results = sets_.front()->call.results();
    for (std::size_t c = 0; c < scalars_.size(); ++c) {
      for (std::size_t i = 0; i < x.size(); ++i)
        ulps[i] = std::max(ulps[i], ulpsOf(scalars_[c].scalar, results[c][i], drawn.truths.front()[c][i]));
    }
    std::vector<std::size_t> order(x.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return x[i]; });
    // A jump is as large as the ratio of errors, of which those below an ulp are alike.
    const auto jump = [&](std::size_t at) {
      const double a = std::max(ulps[order[at]], 1.0), b = std::max(ulps[order[at + 1]], 1.0);
      return a == b ? 0 : std::max(a, b) / std::min(a, b);
    };
    constexpr std::size_t most = 64;
    std::vector<std::size_t> jumps(order.empty() ? 0 : order.size() - 1);
    std::iota(jumps.begin(), jumps.end(), std::size_t{0});
    const auto end = jumps.begin() + static_cast<std::ptrdiff_t>(std::min(most, jumps.size()));
    std::partial_sort(jumps.begin(), end, jumps.end(),
                      [&](std::size_t a, std::size_t b) { return jump(a) > jump(b); });
    std::vector<std::size_t> elements;
    for (auto it = jumps.begin(); it != end; ++it) {
      if (jump(*it) > 0) elements.insert(elements.end(), {order[*it], order[*it + 1]});
    }
    if (elements.empty()) return;
    const Inputs ends = inputsAt(subject_, drawn.inputs, 0, elements);
    addFound(inputsBetween(subject_, ends, searched() / static_cast<std::int64_t>(most)), options, sizes);
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
    if (isRecorded_) return fmt::format("{} of {}", text, measurement_.inputs);
    if (const std::string ranges = measurement_.ranges.text(subject_); !ranges.empty()) text += "; " + ranges;
    return text;
  }

  Grade grade(const sk::CallOptions& options) {
    ErrorSizes sizes(scalars_, isRecorded_ ? Scale::RootMeanSquare : Scale::Result);
    ErrorCounts counts(scalars_);
    const std::size_t drawn = sets_.size();
    for (std::size_t s = 0; s < drawn; ++s) {
      Set& set = *sets_[s];
      for (int draw = 0; draw < set.inputs.extent.draws; ++draw) {
        set.call.run(options, draw);
        const Results results = set.call.results();
        const Results& truth = set.truths[static_cast<std::size_t>(draw)];
        if (set.isOrdinary()) {
          sizes.add(results, truth, s, draw, set.extremes == Extremes::None);
        } else {
          counts.add(results, truth, s, draw);
        }
      }
    }
    if (!isRecorded_ && isElementwise(subject_) &&
        !drawnReals(subject_, measurement_.ranges, sets_.front()->inputs).empty()) {
      searchJumps(options, sizes);
      searchNearWorst(options, sizes);
    }
    Grade grade{.metrics = sizes.metrics()};
    grade.worst = caseOf(sizes.worst(), !subject_.isReduce());
    if (scalars_.size() > 1) grade.outputs = outputsOf(sizes);
    if (counts.tried() > 0) grade.extremes = extremesOf(counts);
    sets_.resize(drawn);  // each mode has worst inputs of its own
    return grade;
  }

  std::vector<OutputErrors> outputsOf(const ErrorSizes& sizes) const {
    std::vector<OutputErrors> outputs;
    for (std::size_t c = 0; c < scalars_.size(); ++c) {
      if (!isReal(scalars_[c].scalar)) continue;
      const ScalarErrors& errors = sizes.scalars()[c];
      outputs.push_back({scalars_[c].name, errors.metrics(), caseOf(errors.worst, !subject_.isReduce())});
    }
    return outputs;
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
    if (const std::optional<double> precise = hasInputs ? preciselyAt(place) : std::nullopt) {
      json["by_mpfr"] = jsonOf(sk::program::Scalar::Double, *precise);
      json["reference_differs"] = !isSameIn(scalar.scalar, place.wanted, *precise);
    }
    return json;
  }

  /// The right result by MPFR; nullopt if there is none here.
  std::optional<double> preciselyAt(const ErrorPlace& place) const {
    if (references_.precise == nullptr || !isElementwise(subject_) ||
        !areAligned(subject_, sets_[place.inputs]->inputs))
      return std::nullopt;
    const auto isIt = [&](const sk::program::Kernel* kernel) {
      return kernel->name == subject_.signature().name;
    };
    const auto kernel = std::ranges::find_if(references_.precise->kernels, isIt);
    if (kernel == references_.precise->kernels.end()) return std::nullopt;
    const Subject subject{.kernel = *kernel};
    const std::size_t element[] = {place.result};
    const Inputs inputs = inputsAt(subject_, sets_[place.inputs]->inputs, place.draw, element);
    Call call(references_.quad, subject, inputs);
    call.run({.precision = Precision::Single}, 0);
    return call.exactResults()[place.scalar].front();
  }

  /// Whether two right results are the same as far as an error in this type can show: to an eighth of a unit in the last place.
  static bool isSameIn(sk::program::Scalar scalar, double a, double b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) == std::isnan(b);
    if (std::isinf(a) || std::isinf(b) || a == 0 || b == 0)
      return a == b || (roundedTo(scalar, a) == roundedTo(scalar, b));
    return std::fabs(a - b) <= ulpOf(scalar, b) / 8;
  }

  sk::Device& device_;
  References& references_;
  const Subject& subject_;
  const FileMeasurement& measurement_;
  const bool isRecorded_;
  std::vector<ResultScalar> scalars_;
  std::int64_t size_ = 0;
  std::vector<std::unique_ptr<Set>> sets_;  ///< the first one is timed
  Progress progress_;
};

}  // namespace

FileResults measureFile(sk::Device& device, const sk::program::Library& library,
                        const sk::program::Library* precise, const FileMeasurement& measurement,
                        const std::function<void(const Experiment&)>& report) {
  FileResults results;
  const std::vector<Subject> subjects = chosenSubjects(library, measurement.kernel, results.skipped);
  measurement.ranges.check(subjects);
  std::optional<RecordedInputs> recorded;
  if (!measurement.inputs.empty()) recorded.emplace(measurement.inputs).check(subjects);
  References references{.precise = precise};
  for (const Subject& subject : subjects) {
    if (recorded && !recorded->has(subject.name())) {
      results.skipped.push_back(recorded->lackOf(subject.name()));
      continue;
    }
    try {
      results.experiments.push_back(
          Measured(device, references, subject, measurement, recorded ? &*recorded : nullptr).experiment());
    } catch (const sk::Error& error) {  // even the plainest mode fails
      results.skipped.emplace_back(error.what());
      continue;
    } catch (const std::runtime_error& error) {  // an overload of the recorded kernel
      const auto hasName = [&](const Subject& other) { return other.name() == subject.name(); };
      if (!recorded || std::ranges::count_if(subjects, hasName) == 1) throw;
      results.skipped.emplace_back(error.what());
      continue;
    }
    if (measurement.addBounds) measurement.addBounds(results.experiments.back(), subject);
    report(results.experiments.back());
  }
  if (results.experiments.empty()) failWith(results.skipped);
  return results;
}

void FileOptions::addTo(CLI::App& command) {
  const auto add = [&command](const char* name, auto& variable, const char* help, const char* type) {
    return command.add_option(name, variable, help)->type_name(type)->group("Options for a .sk file");
  };
  add("--kernel", kernel, "Only this kernel or reduce", "NAME");
  add("--range", ranges,
      "Draw a parameter, or a member of it, from here: half of the numbers evenly, the other half with as "
      "many between 1 and 2 as between 100 and 200 (default: reals from [-1, 1] and, of either sign, 1e-4 to "
      "1e4; int -8 to 8, uint "
      "0 to 8)",
      "PARAM=LO:HI")
      ->allow_extra_args(false);
  add("--set", values, "Give a parameter, or a member, this value (default of spec parameters: 1)",
      "PARAM=V[,V...]")
      ->allow_extra_args(false);
  add("--inputs", inputs,
      "Measure kernels on the inputs that a program has recorded in this .npz file, instead of drawn ones",
      "FILE");
  command
      .add_flag(
          "--no-extremes", hasNoExtremes,
          "Leave out inputs like NaN, infinity, denormals, the largest float and the ends of ranges, where a "
          "kernel might never end")
      ->group("Options for a .sk file");
  add("-I", build.includes, "Look for #include files in this directory", "DIR")->allow_extra_args(false);
  add("-D", build.definitions, "Define a macro", "NAME[=VALUE]")->allow_extra_args(false);
  add("--skc", build.skc, "The compiler skc (default: SK_SKC, the one beside sk, the one on PATH)", "FILE");
}

FileMeasurement FileOptions::measurement(const std::vector<std::int64_t>& extents, int rounds) const {
  if (!inputs.empty() && !(ranges.empty() && values.empty() && extents.empty()))
    throw std::runtime_error(
        "--inputs has the elements, the values and the shapes; leave out --range, --set and --size");
  FileMeasurement measurement{.kernel = kernel,
                              .extents = extents,
                              .rounds = rounds,
                              .hasExtremes = !hasNoExtremes,
                              .ranges = {},
                              .inputs = inputs};
  for (const std::string& range : ranges) measurement.ranges.addRange(range);
  for (const std::string& value : values) measurement.ranges.addValues(value);
  return measurement;
}

std::string_view FileOptions::used() const {
  if (!kernel.empty()) return "--kernel";
  if (!ranges.empty()) return "--range";
  if (!values.empty()) return "--set";
  if (!inputs.empty()) return "--inputs";
  if (hasNoExtremes) return "--no-extremes";
  if (!build.includes.empty()) return "-I";
  if (!build.definitions.empty()) return "-D";
  return build.skc.empty() ? "" : "--skc";
}

}  // namespace sk_tool
