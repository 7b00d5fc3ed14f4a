// SPDX-License-Identifier: MIT
#include "gl_device/pass/reduce_passes.hpp"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

#include "assemble/glsl/program_text.hpp"
#include "assemble/reduce/row_program.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "assemble/reduce/scan_program.hpp"
#include "call/check_call.hpp"
#include "call/resolved_call.hpp"
#include "device/region.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"

namespace sk {

using assemble::Addressing;
using assemble::Index4;
using assemble::ReducePass;
using assemble::RegionLayout;
using assemble::StreamAccess;
using assemble::Walk;
using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

/// The step of a pass in the trace.
std::string_view stepOf(Walk walk) {
  switch (walk) {
    case Walk::Partials:
    case Walk::PartialRows:
    case Walk::GroupedPartials: return "combine";
    case Walk::Nothing: return "identity";
    case Walk::Line:
    case Walk::Plane:
    case Walk::Box:
    case Walk::Rows:
    case Walk::Index: break;
  }
  return "fold";
}

}  // namespace

void takeAccumulators(const Kernel& fold, const assemble::TextureShape& shape, std::string_view whatFor,
                      PlanesLease& lease) {
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role == Role::Accumulator) lease.add(*parameter.element, shape, whatFor);
  }
}

std::vector<RenderTarget*> pointersTo(std::span<RenderTarget> planes) {
  std::vector<RenderTarget*> pointers;
  for (RenderTarget& plane : planes) {
    pointers.push_back(&plane);
  }
  return pointers;
}

ReducePasses::ReducePasses(GlDevice& device, const ResolvedReduction& call)
    : device_(device),
      reduction_(call.reduction),
      specs_(specsOf(call.reduction.fold, call.arguments)),
      isScan_(call.scan.has_value()),
      isInRows_(call.rows != nullptr),
      ofDigits_(foldsDigits(call)),
      placed_(call.placed),
      blocks_(xFirst(call.blocks)) {
  findOperands(call.arguments, call.domain);
  if (isInRows_) return;
  byGroups_ = !isScan_ && call.domain.size() > 0 && foldsByGroups();
  if (byGroups_) {
    byTexel_ = readsTexelsTogether();
    return;
  }
  byTexel_ = isScan_ ? mayScanByTexel(call.arguments) : foldsByTexel(blocks_);
  if (!byTexel_ && call.domain.size() > 0) {
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
      if (isRead(i)) glStream(call.arguments[i].region).unpack();
    }
    findOperands(call.arguments, call.domain);
  }
}

bool ReducePasses::mayEndInBuffer() const {
  return device_.programs().areDispatched() && assemble::mayEndInBuffer(reduction_);
}

void ReducePasses::run(const RegionLayout& result, std::span<RenderTarget* const> targets,
                       const std::function<void()>& begin) {
  if (assemble::elements(elements_.extent) == 0) return writeIdentities(result, targets, begin);
  assemble::ReduceLimits limits = limitsOfPasses();
  limits.toBuffer = targets.empty();
  PlanesLease partials(device_.memory());
  const assemble::Division division{.blocks = blocks_,
                                    .byIndex = foldsByIndex(),
                                    .byTexel = byTexel_,
                                    .inAnyOrder = reduction_.commutative,
                                    .inGroups = assemble::foldsInGroups(reduction_),
                                    .byGroups = byGroups_,
                                    .ofDigits = ofDigits_};
  const std::vector<ReducePass> passes = assemble::planReduction(elements_, result, limits, division);
  startAll(passes);
  for (const ReducePass& pass : passes) {
    if (pass.toResult) {
      prepare(pass, targets);
      begin();
      draw(pass, {partials.planes}, targets);
      continue;
    }
    PlanesLease next(device_.memory());
    takeAccumulators(reduction_.fold, pass.texture, "partial results", next);
    draw(pass, {partials.planes}, pointersTo(next.planes));
    std::swap(partials.planes, next.planes);
  }
}

void ReducePasses::writeIdentities(const RegionLayout& result, std::span<RenderTarget* const> targets,
                                   const std::function<void()>& begin) {
  const ReducePass identities = assemble::planIdentities(result);
  prepare(identities, targets);
  begin();
  draw(identities, {}, targets);
}

void ReducePasses::scan(const RegionLayout& result, std::span<RenderTarget* const> targets, bool isExclusive,
                        const std::function<void()>& begin) {
  const bool isDispatched = device_.programs().areDispatched();
  const assemble::ReduceLimits limits{
      .texture = device_.textureLimits(), .fanIn = assemble::scanRun, .grouped = isDispatched};
  const assemble::Lines lines = assemble::linesOf(elements_.extent, blocks_);
  assemble::ScanAccess access{foldsByIndex() || !assemble::isConsecutive(elements_), byTexel_};
  access.ofDigits = ofDigits_;
  if (isDispatched && device_.traits.tilesScans)
    assemble::addTiles(access, reduction_,
                       device_.traits.chainsScans && !device_.bound().isLogged() && mayChain());
  access.patience = device_.scanPatience.value_or(access.patience);
  const assemble::ScanPlan plan = assemble::planScan(elements_, result, limits, lines, access, isExclusive);
  startAll(plan.folds);
  startAll(plan.scans);
  std::deque<PlanesLease> levels;
  for (const ReducePass& pass : plan.folds) {
    const std::span<RenderTarget> source =
        levels.empty() ? std::span<RenderTarget>() : std::span<RenderTarget>(levels.back().planes);
    PlanesLease& next = levels.emplace_back(device_.memory());
    takeAccumulators(reduction_.fold, pass.texture, "partial results", next);
    draw(pass, {source}, pointersTo(next.planes));
  }
  PlanesLease carries(device_.memory());
  for (const ReducePass& pass : plan.scans) {
    if (pass.toResult) {
      prepare(pass, targets);
      if (pass.variant.chained) bindChain(pass);
      begin();
      draw(pass, {{}, carries.planes}, targets);
      continue;
    }
    PlanesLease next(device_.memory());
    takeAccumulators(reduction_.fold, pass.texture, "partial results", next);
    draw(pass, {levels.back().planes, carries.planes}, pointersTo(next.planes));
    std::swap(carries.planes, next.planes);
    levels.pop_back();
  }
}

void ReducePasses::startAll(std::span<const ReducePass> passes) {
  for (const ReducePass& pass : passes) {
    if (!start(pass)) break;  // then the other programs exist, too
  }
}

void ReducePasses::findOperands(std::span<const Argument> arguments, const Shape& domain) {
  operands_.clear();
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    operands_.push_back(operandOf(i, arguments[i], domain));
  }
  elements_ = layoutOfElements(xFirst(domain));
  if (!placed_.isPlaced()) return;
  elements_.placed = true;
  elements_.place = {xFirst(placed_.box.begin), {}, xFirst(placed_.whole)};
}

assemble::ReduceLimits ReducePasses::limitsOfPasses() const {
  assemble::ReduceLimits limits{.texture = device_.textureLimits(), .grouped = mayGroup()};
  if (device_.programs().areDispatched()) {
    limits.longRun = longRunOfGroups();
  } else {
    limits.longRun = static_cast<std::int32_t>(device_.traits.drawnRun);
  }
  return limits;
}

std::int32_t ReducePasses::longRunOfGroups() const {
  const std::int64_t texels = assemble::elements(elements_.extent) / (byTexel_ ? assemble::lanes : 1);
  return texels >= device_.traits.runOf32From ? 32 : texels >= device_.traits.runOf16From ? 16 : 0;
}

bool ReducePasses::mayGroup() const {
  constexpr std::size_t planeBytes = 4 * sizeof(float);  // the most: four components, or two doubles
  const std::size_t planes = assemble::accumulatorPlanes(reduction_.fold);
  return device_.programs().areDispatched() &&
         planes * planeBytes * assemble::groupSize <= assemble::groupBytes &&
         planes <= static_cast<std::size_t>(device_.limits.images);
}

bool ReducePasses::mayChain() const {
  constexpr std::size_t buffers = 2;  // results of tiles, and the check of loops
  return assemble::accumulatorPlanes(reduction_.fold) + buffers <=
         static_cast<std::size_t>(device_.capabilities.outputResources);
}

bool ReducePasses::foldsByTexel(const Index4& blocks) const {
  return elements_.packed && !foldsByIndex() && assemble::isWholeTexels(elements_) &&
         elements_.extent[0] / blocks[0] % assemble::lanes == 0;
}

bool ReducePasses::foldsByGroups() const {
  constexpr std::int32_t leastAcross = 64, least = 512;
  const std::int64_t blocks = assemble::elements(blocks_);
  return blocks > 1 && elements_.extent[0] / blocks_[0] >= leastAcross &&
         assemble::elements(elements_.extent) / blocks >= least && assemble::foldsInGroups(reduction_) &&
         mayGroup();
}

bool ReducePasses::readsTexelsTogether() const {
  if (assemble::readsElementIndex(reduction_.fold) || placed_.isPlaced() || !elements_.packed ||
      !assemble::isWholeTexels(elements_) || elements_.extent[0] / blocks_[0] % assemble::lanes != 0) {
    return false;
  }
  for (std::size_t i = 0; i < operands_.size(); ++i) {
    const RegionLayout& input = operands_[i].regionLayout;
    if (isRead(i) && (!input.packed || operands_[i].fitted || !assemble::isWholeTexels(input) ||
                      input.extent[0] != elements_.extent[0])) {
      return false;
    }
  }
  return true;
}

bool ReducePasses::mayScanByTexel(std::span<const Argument> arguments) const {
  const assemble::Lines lines = assemble::linesOf(elements_.extent, blocks_);
  if (!elements_.packed || !assemble::isConsecutive(elements_) || foldsByIndex() || lines.inner != 1 ||
      lines.length % assemble::lanes != 0 || !assemble::isWholeTexels(elements_)) {
    return false;
  }
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (reduction_.fold.parameters[i].role != Role::Accumulator) continue;
    const RegionLayout& result = operands_[i].regionLayout;
    if (!result.packed || !assemble::isWholeTexels(result)) return false;
  }
  return true;
}

Operand ReducePasses::operandOf(std::size_t i, const Argument& argument, const Shape& domain) const {
  const Parameter& parameter = reduction_.fold.parameters[i];
  switch (parameter.role) {
    case Role::Uniform: return uniformOperand(argument);
    case Role::Spec: return {.value = argument.value};
    case Role::Iterator:
      if (domain.size() == 0) return {};
      return iteration(parameter, argument.value, placed_.isPlaced() ? placed_.whole : domain);
    case Role::Input:
    case Role::Gather:
    case Role::Accumulator: break;
    case Role::Output:
    case Role::VariableOutput:
    case Role::Scatter: return {};
  }
  if (argument.region.stream == nullptr || !assemble::isNeeded(parameter, specs_)) {
    return {};
  }
  Operand operand = regionOperand(argument, domain);
  RegionLayout& layout = operand.regionLayout;
  if (parameter.role == Role::Gather && isPlaced(argument.region)) {
    layout = gatherLayout(layout, argument.region.placement, parameter.boundary);
  } else if (parameter.role == Role::Input && placed_.isPlaced()) {
    layout.placed = true;
    layout.place.whole = xFirst(seenShape(argument.region));
  }
  return operand;
}

RegionLayout ReducePasses::layoutOfElements(const Index4& shape) const {
  for (std::size_t i = 0; i < operands_.size(); ++i) {
    if (isRead(i) && operands_[i].regionLayout.extent == shape) {
      return operands_[i].regionLayout;
    }
  }
  return {.extent = shape};
}

bool ReducePasses::isRead(std::size_t i) const {
  const Parameter& parameter = reduction_.fold.parameters[i];
  return parameter.role == Role::Input && assemble::isNeeded(parameter, specs_);
}

bool ReducePasses::foldsByIndex() const {
  bool byIndex = assemble::readsElementIndex(reduction_.fold) || placed_.isPlaced();
  bool hasElements = false;  // a kernel with folded outputs may have no inputs
  for (std::size_t i = 0; i < operands_.size(); ++i) {
    hasElements = hasElements || isRead(i);
    byIndex = byIndex || (isRead(i) && !haveSameTexels(operands_[i].regionLayout, elements_));
  }
  return byIndex || !hasElements;
}

std::vector<Operand> ReducePasses::operandsOfCombine(std::span<RenderTarget> partials) const {
  std::vector<Operand> operands;
  const Kernel& combine = reduction_.combine;
  for (std::size_t i = 0; i < combine.parameters.size(); ++i) {
    const Parameter& parameter = combine.parameters[i];
    if (parameter.role == Role::Input) {
      const std::size_t count = std::min(parameter.element->fields.size(), partials.size());
      operands.push_back({.regionLayout = elements_, .planes = partials.first(count)});
      partials = partials.subspan(count);
    } else if (parameter.role == Role::Accumulator) {
      operands.emplace_back();
    } else {
      operands.push_back(operands_[reduction_.combineOperands[i]]);
    }
  }
  return operands;
}

void ReducePasses::addCarries(std::vector<Operand>& operands, std::span<RenderTarget> carries) const {
  for (const Parameter& parameter : reduction_.fold.parameters) {
    if (parameter.role != Role::Accumulator) continue;
    const std::size_t count = parameter.element->fields.size();
    operands.push_back({.planes = carries.first(count)});
    carries = carries.subspan(count);
  }
}

void ReducePasses::draw(const ReducePass& pass, const Source& source,
                        std::span<RenderTarget* const> targets) {
  const bool isPartial = assemble::isOfPartials(pass.variant.walk);
  const Kernel& own = isPartial ? reduction_.combine : reduction_.fold;
  const assemble::ContinuedKernel continued(own);
  const Kernel& read = pass.variant.carried ? continued.kernel() : own;
  std::optional<assemble::RowKernel> inRows;
  if (pass.variant.rows != assemble::RowPass::None) inRows.emplace(read, pass.variant.rows);
  const Kernel& kernel = inRows ? inRows->kernel() : read;
  std::vector<Operand> operands = isPartial ? operandsOfCombine(source.partials) : operands_;
  if (pass.variant.carried) addCarries(operands, source.carries);
  operands.insert(operands.end(), source.tables.begin(), source.tables.end());
  if (pass.variant.toBuffer)
    device_.passes().bind(PassBuffer::Values, valueBytes, reduction_.fold, "its value");
  forEachPart(
      pass, operands, [&](const assemble::ReduceVariant& variant, std::size_t first, std::size_t count) {
        ReduceProgram& program = device_.programs().selected().reduceProgram(reduction_, variant);
        const bool isInBuffer = variant.toBuffer;
        const auto planes = isInBuffer ? targets : targets.subspan(first, count);
        const std::size_t bytes = isInBuffer ? count * valuePlaneBytes : texelBytesOf(planes);
        const PassScope traced(device_, nameOf(reduction_.fold.name, stepOf(variant.walk), program.kernel),
                               program.kernel, operands, pass.draws, bytes);
        device_.bound().program(program.kernel.program.name());
        bindOperands(device_, program.kernel, kernel, operands);
        for (const assemble::UniformValue& value : pass.uniforms) {
          program.uniform(value).set(device_.bound(), value.value);
        }
        if (variant.placed) {
          for (const assemble::UniformValue& value :
               {assemble::UniformValue{"sk_item_low", true, elements_.place.low},
                assemble::UniformValue{"sk_item_whole", true, elements_.place.whole}})
            program.uniform(value).set(device_.bound(), value.value);
        }
        const bool storesItself = pass.groups.width > 0;
        writeRects(device_, preparedPass(device_, program.kernel, planes), planes,
                   storesItself ? std::span(&pass.groups, 1) : std::span(pass.draws));
      });
}

void ReducePasses::prepare(const ReducePass& pass, std::span<RenderTarget* const> targets) {
  const bool isPartial = assemble::isOfPartials(pass.variant.walk);
  forEachPart(pass, isPartial ? operandsOfCombine({}) : operands_,
              [&](const assemble::ReduceVariant& variant, std::size_t first, std::size_t count) {
                ReduceProgram& program = device_.programs().selected().reduceProgram(reduction_, variant);
                if (!variant.toBuffer) preparedPass(device_, program.kernel, targets.subspan(first, count));
              });
}

void ReducePasses::bindChain(const ReducePass& pass) {
  const auto groups =
      static_cast<std::size_t>(pass.groups.width) * static_cast<std::size_t>(pass.groups.height);
  const std::size_t bytes =
      sizeof(std::uint32_t) * (2 + 2 * assemble::accumulatorPlanes(reduction_.fold) * groups);
  device_.passes().bind(PassBuffer::TileResults, bytes, reduction_.fold, "the results of tiles");
  gl::StorageBuffer::clear(device_.bound(), bytes);
}

bool ReducePasses::start(const ReducePass& pass) {
  bool isNew = false;
  const bool isPartial = assemble::isOfPartials(pass.variant.walk);
  forEachPart(pass, isPartial ? operandsOfCombine({}) : operands_,
              [&](const assemble::ReduceVariant& variant, std::size_t, std::size_t) {
                isNew = device_.programs().selected().startReduceProgram(reduction_, variant) || isNew;
              });
  return isNew;
}

template <class Visit>
void ReducePasses::forEachPart(const ReducePass& pass, std::span<const Operand> operands,
                               Visit&& visit) const {
  assemble::ReduceVariant variant = pass.variant;
  if (variant.walk != Walk::Nothing) {
    addAccess(variant, assemble::isOfPartials(variant.walk) ? reduction_.combine : reduction_.fold, operands);
  }
  const auto most = static_cast<std::size_t>(device_.programs().areDispatched() ? device_.limits.images
                                                                                : device_.limits.drawBuffers);
  const std::size_t planes = assemble::accumulatorPlanes(reduction_.fold);
  if (variant.toBuffer) return visit(variant, 0, planes);  // which has room for all
  for (std::size_t first = 0; first < planes; first += most) {
    const std::size_t count = std::min(most, planes - first);
    if (planes > most) {
      variant.firstPlane = static_cast<std::uint8_t>(first);
      variant.planeCount = static_cast<std::uint8_t>(count);
    }
    visit(variant, first, count);
  }
}

void ReducePasses::addAccess(assemble::ReduceVariant& variant, const Kernel& kernel,
                             std::span<const Operand> operands) const {
  assemble::Variant chosen = chooseVariant(kernel, operands, elements_);
  variant.specs = chosen.specs;
  for (std::size_t i = 0; i < chosen.access.size(); ++i) {
    StreamAccess& access = chosen.access[i];
    if (variant.walk == Walk::Index && kernel.parameters[i].role == Role::Input) {
      const RegionLayout& regionLayout = operands[i].regionLayout;
      access.addressing = addressingOf(regionLayout);
      access.fitted = operands[i].fitted;
      access.view = regionLayout.origin != Index4{};
      access.packed =
          (isInRows_ || byGroups_) && regionLayout.packed;  // the inputs of others have been unpacked
    }
  }
  variant.access = std::move(chosen.access);
  variant.placed = variant.walk == Walk::Index && elements_.placed;
}

}  // namespace sk
