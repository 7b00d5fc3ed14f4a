// SPDX-License-Identifier: MIT
#include "driver/listings.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "assemble/append/append_groups.hpp"
#include "assemble/append/append_passes.hpp"
#include "assemble/append/histo_pyramid.hpp"
#include "assemble/append/scatter_programs.hpp"
#include "assemble/assemble.hpp"
#include "assemble/program/texture_units.hpp"
#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "support/text.hpp"
#include "web/ahead_programs.hpp"
#include "web/offered.hpp"

namespace skc::driver {
namespace {

using sk::assemble::Profile;

/// The profile of the fragment programs that take the place of compute programs of ES, which write fewer images, of fewer formats.
Profile drawnProfile(const Profile& profile) {
  Profile drawn = *sk::assemble::findProfile("essl300");
  drawn.doubles = profile.doubles;
  drawn.barrier = profile.barrier;
  drawn.asWritten = profile.asWritten;
  return drawn;
}

/// Whether the profile's programs write all outputs and accumulators of a kernel, each element in a texel of its own.
bool mayStore(const Profile& profile, const sk::program::Kernel& kernel) {
  using sk::program::Role;
  if (profile.stage == sk::assemble::Stage::Fragment) return true;
  return std::ranges::all_of(kernel.parameters, [&](const sk::program::Parameter& parameter) {
    const bool isWritten = parameter.role == Role::Output || parameter.role == Role::Accumulator ||
                           sk::assemble::isAppendOutput(parameter);
    return !isWritten || sk::assemble::mayStore(profile, heldBy(parameter));
  });
}

/// Fragment programs in place of compute programs, which the comment in the second line then says. It adds no line, because programs
/// number theirs.
std::string asDrawn(const Profile& profile, std::string&& programs) {
  const std::size_t version = programs.find('\n');
  const std::size_t comment = version == std::string::npos ? version : programs.find('\n', version + 1);
  if (comment != std::string::npos)
    programs.insert(comment, fmt::format("; {} has no images for its outputs", profile.name));
  return std::move(programs);
}

/// Access to an input whose texels do not correspond to the domain's.
sk::assemble::StreamAccess foundByIndex(sk::assemble::Domain domain, bool isPacked) {
  using sk::assemble::Addressing;
  const bool isPlane = domain == sk::assemble::Domain::Plane;
  return {.addressing = isPlane ? Addressing::Plane : Addressing::Linear, .packed = isPacked};
}

/// The variant for the commonest call: all streams share one shape, and lie in plain layout if their
/// rank allows. Spec parameters are true or 1. `packed`: four scalars per texel.
sk::assemble::Variant plainVariant(const sk::program::Kernel& kernel, bool packed = true) {
  sk::assemble::Variant variant;
  variant.domainPacked = packed && sk::assemble::mayWritePacked(kernel);
  variant.domainEven = true;
  std::size_t specs = 0;
  for (const sk::program::Parameter& parameter : kernel.parameters) {
    sk::assemble::StreamAccess access;
    if (parameter.role == sk::program::Role::Gather) {
      const bool isLinear = parameter.rank > 2;
      access.addressing = isLinear ? sk::assemble::Addressing::Linear : sk::assemble::Addressing::Plane;
      access.nearby = parameter.reach >= 0;
      access.filtered = sk::assemble::mayFilter(parameter);
      access.packed = packed && !access.filtered && sk::assemble::mayPack(heldBy(parameter));
      if (isLinear) {
        variant.domain = sk::assemble::Domain::Linear;
        variant.domainRank = std::max(variant.domainRank, parameter.rank);
      }
    } else if (parameter.role == sk::program::Role::Iterator) {
      const bool isScalar = parameter.element->fields.front().width == 1;
      if (isScalar) access.addressing = sk::assemble::Addressing::Linear;
    } else if (parameter.role == sk::program::Role::Spec) {
      const bool isFloat = parameter.element->fields.front().scalar == sk::program::Scalar::Float;
      variant.specs[specs++] = isFloat ? std::bit_cast<std::uint32_t>(1.0F) : 1u;
    }
    variant.access.push_back(access);
  }
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const sk::program::Parameter& parameter = kernel.parameters[i];
    if (parameter.role != sk::program::Role::Input) continue;
    const bool isPacked = packed && sk::assemble::mayPack(heldBy(parameter));
    if (isPacked != variant.domainPacked) variant.access[i] = foundByIndex(variant.domain, isPacked);
  }
  return variant;
}

/// The compute programs of a kernel with append outputs: the owners of stores, if there are any, and everything else.
std::string groupListing(const Profile& profile, const sk::program::Kernel& kernel) {
  using sk::program::Role;
  const sk::Order order = kernel.options.order;
  const auto mayPack = [&](const sk::program::Parameter& parameter) {
    return parameter.role == Role::Input && sk::assemble::mayGroupPacked(kernel) &&
           sk::assemble::mayPack(heldBy(parameter));
  };
  sk::assemble::Variant variant = plainVariant(kernel);
  variant.domainPacked = std::any_of(kernel.parameters.begin(), kernel.parameters.end(), mayPack);
  variant.task.scattersInAnyOrder = order == sk::Order::Any;
  bool isOwned = false;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const sk::program::Parameter& parameter = kernel.parameters[i];
    isOwned = isOwned || sk::assemble::hasOwners(parameter, order);
    const bool isAligned = mayPack(parameter) == variant.domainPacked;
    if (parameter.role == Role::Scatter || (parameter.role == Role::Input && !isAligned)) {
      variant.access[i] = foundByIndex(variant.domain, /*isPacked=*/false);
    } else if (parameter.role == Role::Input) {
      variant.access[i] = {};
    }
  }
  std::vector<std::string> programs;
  for (const auto work : {sk::assemble::Work::Owners, sk::assemble::Work::Groups}) {
    variant.task.work = work;
    if (work == sk::assemble::Work::Groups || isOwned)
      programs.push_back(sk::assemble::kernelProgram(profile, kernel, variant));
  }
  for (const sk::program::Parameter& parameter : kernel.parameters) {
    if (sk::assemble::isListed(parameter, order)) {
      const bool isCounted = true;
      programs.push_back(sk::assemble::recordProgram(profile, parameter, isCounted));
    }
  }
  return skc::join(programs, "\n");
}

/// Whether compute programs have images for all that a kernel with append outputs writes: its outputs, the number of entries of each
/// list, and the records of scatters that atomic operations do not combine.
bool mayAppend(const Profile& profile, const sk::program::Kernel& kernel) {
  using sk::program::Role;
  const sk::Order order = kernel.options.order;
  std::size_t images = 0;
  bool hasRecords = false;
  for (const sk::program::Parameter& parameter : kernel.parameters) {
    const bool isListed = sk::assemble::isListed(parameter, order);
    hasRecords = hasRecords || isListed;
    if (parameter.role == Role::VariableOutput || isListed) ++images;
    if (parameter.role == Role::Output || sk::assemble::isAppendOutput(parameter))
      images += sk::assemble::imagesOf(parameter, order);
  }
  return mayStore(profile, kernel) && images <= static_cast<std::size_t>(profile.drawBuffers) &&
         (!hasRecords || sk::assemble::mayStore(profile, "rg32ui"));
}

/// All programs of a kernel with append outputs: counting, the sums of counts, each list, and its points.
std::string appendListing(const Profile& profile, const sk::program::Kernel& kernel) {
  if (profile.stage == sk::assemble::Stage::Compute) {
    return !profile.es || mayAppend(profile, kernel)
               ? groupListing(profile, kernel)
               : asDrawn(profile, appendListing(drawnProfile(profile), kernel));
  }
  sk::assemble::Variant variant = plainVariant(kernel);
  std::vector<std::string> programs;
  variant.task.work = sk::assemble::Work::Counts;
  const auto isDrawn = [](const sk::program::Parameter& parameter) {
    return parameter.role == sk::program::Role::Output ||
           (sk::assemble::isAppendOutput(parameter) && sk::assemble::isCounted(parameter));
  };
  if (std::any_of(kernel.parameters.begin(), kernel.parameters.end(), isDrawn)) {
    programs.push_back(sk::assemble::kernelProgram(profile, kernel, variant));
  }
  bool hasTree = false;
  variant.task.work = sk::assemble::Work::List;
  variant.domain = sk::assemble::Domain::Entry;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    sk::assemble::StreamAccess& access = variant.access[i];
    if (access.addressing == sk::assemble::Addressing::Aligned) {
      access.addressing = sk::assemble::Addressing::Plane;
    }
  }
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const sk::program::Parameter& appendOutput = kernel.parameters[i];
    if (!sk::assemble::isAppendOutput(appendOutput) || appendOutput.pushes == 0) continue;
    if (sk::assemble::isCounted(appendOutput) && !hasTree) {
      hasTree = true;
      for (const bool ofCounts : {true, false}) {
        programs.push_back(sk::assemble::pyramidProgram(profile, {.ofCounts = ofCounts}));
      }
    }
    variant.task.appendOutput = static_cast<std::uint8_t>(i);
    programs.push_back(sk::assemble::kernelProgram(profile, kernel, variant));
    if (appendOutput.role == sk::program::Role::VariableOutput) continue;
    for (const sk::assemble::PointStep step : sk::assemble::pointSteps(appendOutput)) {
      programs.push_back(sk::assemble::pointProgram(profile, appendOutput, step, {}));
    }
  }
  return skc::join(programs, "\n");
}

/// The kernel whose elements or partial results a pass reads.
const sk::program::Kernel& kernelOf(const sk::program::Reduction& reduction,
                                    const sk::assemble::ReduceVariant& variant) {
  return sk::assemble::isOfPartials(variant.walk) ? reduction.combine : reduction.fold;
}

/// Adds the accesses that depend on the arguments, for streams in plain layout.
void addPlainAccess(const sk::program::Reduction& reduction, sk::assemble::ReduceVariant& variant) {
  const bool isPartial = sk::assemble::isOfPartials(variant.walk);
  const sk::program::Kernel& kernel = kernelOf(reduction, variant);
  sk::assemble::Variant plain = plainVariant(kernel);
  for (std::size_t i = 0; i < plain.access.size(); ++i) {
    const bool isInput = kernel.parameters[i].role == sk::program::Role::Input;
    if (isInput)
      plain.access[i] = {.addressing =
                             isPartial ? sk::assemble::Addressing::Aligned : sk::assemble::Addressing::Plane};
  }
  variant.access = std::move(plain.access);
  variant.specs = plain.specs;
}

/// One pass, or several that each write as many planes as the profile guarantees draw buffers.
std::vector<sk::assemble::ReduceVariant> drawnVariants(const Profile& profile,
                                                       const sk::program::Reduction& reduction,
                                                       const sk::assemble::ReduceVariant& whole) {
  std::size_t planes = 0;
  for (const sk::program::Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role == sk::program::Role::Accumulator) planes += parameter.element->fields.size();
  }
  const auto most = static_cast<std::size_t>(profile.drawBuffers);
  if (planes <= most || whole.toBuffer) return {whole};
  std::vector<sk::assemble::ReduceVariant> parts;
  for (std::size_t first = 0; first < planes; first += most) {
    parts.push_back(whole);
    parts.back().firstPlane = static_cast<std::uint8_t>(first);
    parts.back().planeCount = static_cast<std::uint8_t>(std::min(most, planes - first));
  }
  return parts;
}

/// True if every stream that a fold reads element by element is packed.
bool readsScalars(const sk::program::Kernel& fold) {
  return std::ranges::all_of(fold.parameters, [](const sk::program::Parameter& parameter) {
    return parameter.role != sk::program::Role::Input || sk::assemble::mayPack(heldBy(parameter));
  });
}

/// The same for the accumulators, whose streams a scan writes.
bool writesScalars(const sk::program::Kernel& fold) {
  return std::ranges::all_of(fold.parameters, [](const sk::program::Parameter& parameter) {
    return parameter.role != sk::program::Role::Accumulator || sk::assemble::mayPack(heldBy(parameter));
  });
}

/// Whether a pass reads more planes than the profile guarantees texture units, so that the runtime rejects the reduce
/// on a device that has no more.
bool readsTooMuch(const Profile& profile, const sk::program::Kernel& kernel,
                  const sk::assemble::ReduceVariant& variant) {
  const sk::assemble::PassLimits limits{std::numeric_limits<int>::max(), profile.textureUnits};
  return !sk::assemble::fitsOnePass(kernel, limits, variant.specs);
}

/// Every program of these passes, once.
std::string passListing(const Profile& profile, const sk::program::Reduction& reduction,
                        std::vector<sk::assemble::ReducePass>&& passes) {
  std::string text;
  std::set<sk::assemble::ReduceVariant> seen;
  for (sk::assemble::ReducePass& pass : passes) {
    addPlainAccess(reduction, pass.variant);
    if (const sk::program::Kernel& kernel = kernelOf(reduction, pass.variant);
        readsTooMuch(profile, kernel, pass.variant)) {
      text += fmt::format(
          "// {} for {}: no program; its elements or partial results have more planes than {} texture "
          "units\n",
          kernel.name, profile.name, profile.textureUnits);
      continue;
    }
    for (const sk::assemble::ReduceVariant& variant : drawnVariants(profile, reduction, pass.variant)) {
      if (!seen.insert(variant).second) continue;
      if (!text.empty()) text += "\n";
      text += sk::assemble::reduceProgram(profile, reduction, variant);
    }
  }
  return text;
}

/// The passes that scan a stream of 2^20 elements.
std::vector<sk::assemble::ReducePass> passesOfScan(const Profile& profile,
                                                   const sk::program::Reduction& reduction) {
  constexpr std::int32_t count = 1 << 20;
  const bool isDispatched = profile.stage == sk::assemble::Stage::Compute;
  const sk::assemble::ReduceLimits limits{
      .texture = {16384, 256}, .fanIn = sk::assemble::scanRun, .grouped = isDispatched};
  const bool byIndex = sk::assemble::readsElementIndex(reduction.fold);
  const bool byTexel = !byIndex && readsScalars(reduction.fold) && writesScalars(reduction.fold);
  sk::assemble::RegionLayout elements =
      sk::assemble::linearLayout(count, *sk::assemble::linearTexture(count, limits.texture));
  elements.packed = byTexel;
  sk::assemble::ScanAccess access{byIndex, byTexel};
  if (isDispatched) sk::assemble::addTiles(access, reduction, true);
  sk::assemble::ScanPlan plan = sk::assemble::planScan(elements, elements, limits, {count, 1}, access, false);
  std::vector<sk::assemble::ReducePass> passes = std::move(plan.folds);
  std::ranges::move(plan.scans, std::back_inserter(passes));
  return passes;
}

bool has(const sk::program::Kernel& kernel, sk::program::Role role) {
  return std::ranges::find(kernel.parameters, role, &sk::program::Parameter::role) != kernel.parameters.end();
}

/// Every program that folds a 1024 x 1024 stream to a value, or scans a stream, for one variant of the reduce.
std::string formListing(const Profile& profile, const sk::program::Reduction& reduction, bool isScan) {
  if (!mayStore(profile, reduction.fold)) {
    return asDrawn(profile, formListing(drawnProfile(profile), reduction, isScan));
  }
  if (isScan) return passListing(profile, reduction, passesOfScan(profile, reduction));
  sk::assemble::RegionLayout input;
  input.extent = {1024, 1024, 1, 1};
  const bool byIndex =
      sk::assemble::readsElementIndex(reduction.fold) || !has(reduction.fold, sk::program::Role::Input);
  input.packed = !byIndex && readsScalars(reduction.fold);
  const bool isCompute = profile.stage == sk::assemble::Stage::Compute;
  const bool hasOutputs = has(reduction.fold, sk::program::Role::Output);
  const sk::assemble::ReduceLimits limits{
      .texture = {16384, 256},
      .grouped = isCompute,
      .toBuffer = isCompute && !hasOutputs && sk::assemble::mayEndInBuffer(reduction)};
  const sk::assemble::Division division{.blocks = {1, 1, 1, 1},
                                        .byIndex = byIndex,
                                        .byTexel = input.packed,
                                        .inAnyOrder = reduction.commutative,
                                        .inGroups = sk::assemble::foldsInGroups(reduction)};
  return passListing(profile, reduction,
                     sk::assemble::planReduction(input, sk::assemble::valueLayout(), limits, division));
}

/// The plain variant, and the one that calls use by default for sums of floats.
std::string reductionListing(const Profile& profile, const sk::program::Reduction& reduction, bool isScan) {
  const std::string plain = formListing(profile, reduction, isScan);
  return reduction.compensated == nullptr
             ? plain
             : plain + "\n" + formListing(profile, reduction.compensated->reduction, isScan);
}

/// The programs of the passes that a kernel needs within the profile's limits.
std::string kernelListing(const Profile& profile, const sk::program::Kernel& kernel) {
  const auto listed = [&](const sk::program::Kernel& one, const sk::assemble::Variant& variant) {
    if (variant.domainPacked || mayStore(profile, one))
      return sk::assemble::kernelProgram(profile, one, variant);
    return asDrawn(profile, sk::assemble::kernelProgram(drawnProfile(profile), one, variant));
  };
  const sk::assemble::PassLimits limits{profile.drawBuffers, profile.textureUnits};
  const sk::program::Plan* plan = sk::assemble::planWithin(kernel, limits);
  const sk::assemble::Variant whole = plainVariant(kernel);
  if (plan == nullptr || sk::assemble::fitsOnePass(kernel, limits, whole.specs)) {
    return listed(kernel, whole);
  }
  std::string text;
  for (const sk::program::Pass& pass : plan->passes) {
    if (!text.empty()) text += "\n";
    text += listed(pass.kernel, plainVariant(pass.kernel, false));
  }
  return text;
}

/// The programs of a kernel, or of its passes, that [[variants(views)]] adds for browsers.
std::string viewListing(const sk::program::Kernel& kernel) {
  std::vector<std::string> programs;
  const auto add = [&](const sk::program::Kernel& pass) {
    for (auto& [key, program] : web::viewPrograms(web::webProfile(), pass)) programs.push_back(program);
  };
  if (const sk::program::Plan* plan = web::planOf(kernel)) {
    for (const sk::program::Pass& pass : plan->passes) add(pass.kernel);
  } else if (!web::isTooLarge(kernel)) {
    add(kernel);
  }
  return skc::join(programs, "\n");
}

std::string wholeListing(const Profile& profile, const sk::program::Kernel& kernel) {
  const bool hasAppendOutputs =
      std::any_of(kernel.parameters.begin(), kernel.parameters.end(), sk::assemble::isAppendOutput);
  return hasAppendOutputs ? appendListing(profile, kernel) : kernelListing(profile, kernel);
}

/// Where the device does not store elements while it folds: the kernel of the outputs, and the reduce of these if there
/// is one.
std::string partsListing(const Profile& profile, const sk::program::FoldParts& parts) {
  const std::string map = wholeListing(profile, parts.map);
  return parts.after == nullptr ? map : map + "\n" + reductionListing(profile, *parts.after, false);
}

std::string withoutForm(const emit::Unit& unit, std::string_view precision, std::string_view why) {
  return fmt::format("// {} has no form for {} precision: {}\n", unit.kernel.name, precision,
                     why.empty() ? "it computes no floats" : why);
}

/// A kernel or reduce in one precision.
std::string unitListing(const Profile& profile, const emit::Unit& unit, std::string_view precision,
                        const ir::Choices& choices) {
  const sk::program::Kernel& kernel = unit.kernel;
  const sk::program::Reduction* reduction = unit.reduction;
  if (precision.empty() || precision == "single") {
    if (reduction == nullptr && profile.name == "webgl2" && ir::isAhead(choices, ir::Ahead::Views) &&
        !web::hasAppendOutputs(kernel)) {
      return wholeListing(profile, kernel) + "\n" + viewListing(kernel);
    }
    if (reduction == nullptr) return wholeListing(profile, kernel);
    const std::string folds = reductionListing(profile, *reduction, unit.isScan);
    return reduction->parts == nullptr ? folds : folds + "\n" + partsListing(profile, *reduction->parts);
  }
  if (precision == "half") {
    if (reduction != nullptr && reduction->half != nullptr)
      return formListing(profile, *reduction->half, unit.isScan);
    return kernel.half != nullptr ? wholeListing(profile, *kernel.half)
                                  : withoutForm(unit, precision, kernel.whyNotHalf);
  }
  if (reduction != nullptr && reduction->wide != nullptr) {
    return formListing(profile, reduction->wide->reduction, unit.isScan) + "\n" +
           wholeListing(profile, reduction->wide->finish);
  }
  return kernel.wide != nullptr ? wholeListing(profile, *kernel.wide)
                                : withoutForm(unit, precision, kernel.whyNotWide);
}

/// The barrier that most devices of the profile take, or the one of SK_BARRIER.
sk::Barrier barrierOf(const Profile& profile) {
  const char* const variable = std::getenv("SK_BARRIER");
  const std::string_view chosen = variable == nullptr ? "" : variable;
  if (chosen == "none") return sk::Barrier::None;
  return profile.es || chosen == "xor" ? sk::Barrier::Xor : sk::Barrier::Precise;
}

}  // namespace

std::string glslListing(const ir::Module& module, std::string_view profileName, std::string_view precision) {
  const emit::Program program(module);
  Profile profile = *sk::assemble::findProfile(profileName);
  if (precision == "extended") profile.doubles = sk::assemble::Doubles::Pairs;
  profile.barrier = barrierOf(profile);
  std::string text;
  for (const emit::Unit& unit : program.units()) {
    if (!text.empty()) text += "\n";
    const ir::Choices& choices = module.kernels[unit.id].choices;
    profile.asWritten = static_cast<sk::Contraction>(choices.contraction) != sk::Contraction::Fast;
    text += unitListing(profile, unit, precision, choices);
  }
  return text;
}

}  // namespace skc::driver
