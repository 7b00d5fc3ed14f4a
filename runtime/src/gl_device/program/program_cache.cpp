// SPDX-License-Identifier: MIT
#include "gl_device/program/program_cache.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "assemble/append/append_passes.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/tables.hpp"
#include "assemble/program/texture_units.hpp"
#include "assemble/reduce/row_program.hpp"
#include "assemble/reduce/scan_program.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/program/shader_log.hpp"
#include "sk/error.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk {

namespace {

/// The fields of an element, one span for each scalar, vector or matrix.
std::vector<std::span<const program::Field>> valuesOf(const program::Element& element) {
  std::vector<std::span<const program::Field>> values;
  for (std::size_t begin = 0, end = 0; begin < element.fields.size(); begin = end) {
    for (end = begin + 1; end < element.fields.size() && element.fields[end].part > 0;) ++end;
    values.push_back(element.fields.subspan(begin, end - begin));
  }
  return values;
}

KernelProgram::Read readOf(const gl::Program& program, std::size_t i, const program::Parameter& parameter) {
  return {i,
          LayoutUniforms(program, fmt::format("sk_*_{}", parameter.symbol)),
          {program.location(fmt::format("sk_ratio_{}", parameter.symbol)), true}};
}

/// Calls `use` with the kernel that has a parameter for everything that a pass of a reduction reads, if it reads any.
template <class Use>
void withReadKernel(const program::Kernel& kernel, const assemble::ReduceVariant& variant, Use&& use) {
  if (variant.walk == assemble::Walk::Nothing) return;
  const assemble::HeldKernel held(kernel, variant.access);
  const assemble::ContinuedKernel continued(held.kernel());
  const program::Kernel& read = variant.carried ? continued.kernel() : held.kernel();
  const bool isInRows = variant.rows != assemble::RowPass::None;
  use(isInRows ? assemble::RowKernel(read, variant.rows).kernel() : read);
}

}  // namespace

ProgramCache::ProgramCache(GlDevice& device, const assemble::Profile& profile)
    : device_(device), profile_(profile) {}

template <class Programs, class IsOfKernel>
void ProgramCache::makeRoom(Programs& programs, IsOfKernel&& isOfKernel) {
  std::ptrdiff_t count = 0;
  auto oldest = programs.end();
  for (auto program = programs.begin(); program != programs.end(); ++program) {
    if (!isOfKernel(program->first)) continue;
    ++count;
    if (oldest == programs.end() || program->second.used < oldest->second.used) oldest = program;
  }
  if (count >= mostVariants) programs.erase(oldest);
}

void ProgramCache::forgetUnloadedNow() {
  const auto isUnloaded = [](const auto& entry) {
    return !program::LinkedFile::isLoaded(entry.second.object);
  };
  std::erase_if(kernels_, isUnloaded);
  std::erase_if(reductions_, isUnloaded);
  startedKernels_.clear();  // whatever their kernels: nothing is lost but a head start
  startedReductions_.clear();
}

void ProgramCache::forget(const program::Kernel& kernel) noexcept {
  const auto isOfKernel = [&](const auto& entry) { return entry.first.kernel == &kernel; };
  std::erase_if(kernels_, isOfKernel);
  std::erase_if(startedKernels_, isOfKernel);
}

void ProgramCache::forget(const program::Reduction& reduction) noexcept {
  const auto isOfReduction = [&](const auto& entry) { return entry.first.first == &reduction; };
  std::erase_if(reductions_, isOfReduction);
  std::erase_if(startedReductions_, isOfReduction);
  forget(reduction.fold);
}

void ProgramCache::checkUnits(const program::Kernel& kernel, const assemble::SpecValues& specs,
                              std::span<const assemble::StreamAccess> access,
                              const assemble::Task& task) const {
  assemble::OtherUnits others;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    if (parameter.role == program::Role::Uniform && access[i].view)
      others.uniforms += heldBy(parameter).fields.size();
  }
  if (task.work == assemble::Work::List && assemble::isCounted(kernel.parameters[task.appendOutput])) {
    others.pyramid = assemble::pyramidUnits;
  }
  if (profile_.tables) others.tables = kernel.tables.size();
  const std::size_t units = assemble::textureUnits(kernel, specs, others);
  if (units <= static_cast<std::size_t>(device_.limits.textureUnits)) return;
  throw Error(fmt::format("{}: its streams{} take {} texture units, but this device has {}; {}", kernel.name,
                          others.tables > 0 ? " and the tables of its functions" : "", units,
                          device_.limits.textureUnits,
                          others.tables > 0 ? "call it with Tables::Off" : "divide the kernel"),
              Error::Kind::Device);
}

const ProgramKey& ProgramCache::look(const program::Kernel& kernel, std::span<const Operand> operands,
                                     const assemble::RegionLayout& domain, const assemble::Task& task) {
  looked_.kernel = &kernel;
  chooseVariant(kernel, operands, domain, task, device_.capabilities.filtersFloats, looked_.variant);
  return looked_;
}

KernelProgram& ProgramCache::kernelProgram(const program::Kernel& kernel, const Whole& whole,
                                           std::span<const Operand> operands,
                                           const assemble::RegionLayout& domain, const assemble::Task& task) {
  forgetUnloaded();
  const auto found = kernels_.find(look(kernel, operands, domain, task));
  if (found == kernels_.end()) {
    const TraceScope traced(device_.trace.get(), "program", kernel.name);
    const ProgramKey key = looked_;
    const assemble::Variant& variant = key.variant;
    checkUnits(assemble::HeldKernel(kernel, variant.access).kernel(), variant.specs, variant.access, task);
    auto started = startedKernels_.extract(key);
    auto result = makeKernelProgram(
        kernel, variant, started.empty() ? begin(kernel, variant, whole) : std::move(started.mapped()));
    if (whole.tiles != nullptr) result->workGroup = {whole.tiles->stored()[0], whole.tiles->stored()[1], 1};
    makeRoom(kernels_, [&](const ProgramKey& other) { return other.kernel == &kernel; });
    Kept<KernelProgram> kept{std::move(result), ++clock_, program::LinkedFile::objectOf(&kernel)};
    return *kernels_.insert_or_assign(key, std::move(kept)).first->second.program;
  }
  found->second.used = ++clock_;
  return *found->second.program;
}

bool ProgramCache::startKernelProgram(const program::Kernel& kernel, std::span<const Operand> operands,
                                      const assemble::RegionLayout& domain) {
  forgetUnloaded();
  const ProgramKey& key = look(kernel, operands, domain, {});
  if (kernels_.contains(key)) {
    return false;
  }
  if (!startedKernels_.contains(key)) {
    startedKernels_.emplace(key, begin(kernel, key.variant, {}));
  }
  return true;
}

std::unique_ptr<KernelProgram> ProgramCache::makeKernelProgram(const program::Kernel& kernel,
                                                               const assemble::Variant& variant,
                                                               ProgramBuild&& begun) {
  auto result = std::make_unique<KernelProgram>();
  result->isPacked = variant.domainPacked;
  finish(*result, kernel, std::move(begun));
  result->domain = LayoutUniforms(result->program, "sk_domain_*");
  findParameters(*result, assemble::HeldKernel(kernel, variant.access).kernel(), variant.specs,
                 variant.access);
  for (KernelProgram::Read& read : result->reads) {
    const bool isFiltered = variant.access[read.parameter].filtered;
    read.sampler =
        isFiltered ? device_.passes().samplers().linear(kernel.parameters[read.parameter].boundary) : 0;
  }
  if (variant.task.work == assemble::Work::Counts || variant.task.work == assemble::Work::List)
    findTargetUniforms(*result, kernel);
  if (variant.task.work == assemble::Work::List) {
    findListUniforms(*result);
  } else if (variant.task.work == assemble::Work::Groups || variant.task.work == assemble::Work::Owners) {
    findAppendUniforms(*result, kernel);
  } else if (variant.task.work == assemble::Work::Folds) {
    result->foldGroups = {result->program.location("sk_groups"), true};
    result->foldResult = {result->program.location("sk_result"), true};
  }
  return result;
}

void ProgramCache::findParameters(KernelProgram& result, const program::Kernel& kernel,
                                  const assemble::SpecValues& specs,
                                  std::span<const assemble::StreamAccess> access) {
  int unit = 0;
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    if (!assemble::isNeeded(parameter, specs) || parameter.role == program::Role::Spec) {
      continue;
    }
    if (parameter.role == program::Role::Iterator) {
      const program::Field& field = parameter.element->fields.front();
      const auto find = [&](std::string_view kind) {
        return gl::FieldUniform(result.program.location(fmt::format("sk_{}_{}", kind, parameter.symbol)),
                                {&field, 1});
      };
      result.values.push_back({i, find("begin")});
      result.steps.push_back({i, find("step")});
      result.reads.push_back(readOf(result.program, i, parameter));
    } else if (parameter.role == program::Role::Uniform && !access[i].view) {
      findValue(result, i, parameter);
    } else if (parameter.role == program::Role::Input || parameter.role == program::Role::Gather ||
               parameter.role == program::Role::Uniform) {
      result.reads.push_back(readOf(result.program, i, parameter));
      bindSamplers(result.program, parameter, unit);
    }
  }
  result.stacks = assemble::stacksOf(kernel);
  for (const std::size_t stack : result.stacks) {
    result.program.setSampler(assemble::stackName(stack), unit++);
  }
  if (profile_.tables) {
    findTables(result, kernel, unit);
  }
  result.units = unit;
}

void ProgramCache::findTables(KernelProgram& result, const program::Kernel& kernel, int& unit) {
  static constexpr program::Field range{"", program::Scalar::Float, 3, 0};
  for (const program::TableUse& use : kernel.tables) {
    const FunctionTable& table = device_.tables.of(*use.table, device_.configuration);
    result.tables.push_back(
        {device_.programs().textureOf(table),
         gl::FieldUniform(result.program.location(assemble::rangeName(use.name)), {&range, 1}),
         {table.report.range.low, table.perUnit, static_cast<float>(table.report.range.intervals)}});
    device_.bound().program(result.program.name());
    result.program.setSampler(assemble::tableName(use.name), unit++);
  }
}

void ProgramCache::findValue(KernelProgram& result, std::size_t number, const program::Parameter& parameter) {
  for (const auto parts : valuesOf(*parameter.element)) {
    const program::Field& first = parts.front();
    const bool isMember = !first.path.empty() && first.path.front() != '[';
    const std::string name = fmt::format("sk_arg_{}{}{}", parameter.symbol, isMember ? "." : "", first.path);
    if (program::is64Bit(first.scalar)) {
      addWide(result, number, name, parts);
    } else {
      result.values.push_back({number, gl::FieldUniform(result.program.location(name), parts)});
    }
  }
}

/// In GLSL, a double is a struct of its bits or of two floats, an integer of 64 bits one of its bits, and a vector of these is a
/// struct of its components.
void ProgramCache::addWide(KernelProgram& result, std::size_t number, const std::string& name,
                           std::span<const program::Field> parts) const {
  const auto location = [&](const std::string& member) { return result.program.location(member); };
  std::size_t width = 0;
  for (const program::Field& part : parts) width += part.width;
  for (std::size_t c = 0; c < width; ++c) {
    const std::string one = width == 1 ? name : fmt::format("{}.{}", name, "xyzw"[c]);
    const auto offset = static_cast<std::uint32_t>(parts.front().offset + c * sizeof(double));
    const bool areBits =
        parts.front().scalar != program::Scalar::Double || profile_.doubles == assemble::Doubles::Native;
    result.wide.push_back(
        {number, areBits ? gl::WideUniform::bits(location(one + ".bits"), offset)
                         : gl::WideUniform::pair(location(one + ".hi"), location(one + ".lo"), offset)});
  }
}

void ProgramCache::findAppendUniforms(KernelProgram& result, const program::Kernel& kernel) {
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    if (!assemble::isAppendOutput(parameter)) continue;
    result.appends.push_back(
        {i,
         LayoutUniforms(result.program, fmt::format("sk_*_{}", parameter.symbol)),
         {result.program.location(fmt::format("sk_room_{}", parameter.symbol)), false},
         {result.program.location(fmt::format("sk_list_shift_{}", parameter.symbol)), false},
         {result.program.location(fmt::format("sk_owners_{}", parameter.symbol)), true}});
  }
}

void ProgramCache::findTargetUniforms(KernelProgram& result, const program::Kernel& kernel) {
  for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    if (parameter.role != program::Role::Scatter) continue;
    result.targets.push_back({i, LayoutUniforms(result.program, fmt::format("sk_*_{}", parameter.symbol))});
  }
}

void ProgramCache::findListUniforms(KernelProgram& result) {
  result.pyramid.shift = {result.program.location("sk_tree_shift"), false};
  result.pyramid.levels = {result.program.location("sk_levels"), false};
  for (std::size_t level = 0; level < result.pyramid.rows.size(); ++level) {
    result.pyramid.rows[level] = {result.program.location(fmt::format("sk_rows[{}]", level)), false};
  }
  device_.bound().program(result.program.name());
  result.program.setSampler("sk_odd", result.units);
  result.program.setSampler("sk_even", result.units + 1);
}

void KernelProgram::Pyramid::set(gl::BoundState& bound, const assemble::PyramidPlan& plan) {
  shift.set(bound, plan.shift);
  levels.set(bound, static_cast<std::int32_t>(plan.levels.size()));
  for (std::size_t level = 0; level < plan.levels.size(); ++level) {
    rows[level + 1].set(bound, plan.levels[level].row);
  }
}

void ProgramCache::bindSamplers(const gl::Program& program, const program::Parameter& parameter, int& unit) {
  device_.bound().program(program.name());
  for (std::size_t plane = 0; plane < heldBy(parameter).fields.size(); ++plane) {
    if (!parameter.layers.empty() && parameter.layers[plane].stack >= 0) {
      continue;
    }
    program.setSampler(assemble::samplerName(parameter, plane), unit++);
  }
}

ProgramBuild ProgramCache::begin(const program::Kernel& kernel, const assemble::Variant& variant,
                                 const Whole& whole) {
  if (whole.tiles != nullptr)
    return {device_, {.vertex = {}, .main = assemble::tileProgram(profile_, kernel, variant, *whole.tiles)}};
  assemble::ProgramPair programs = assemble::kernelPrograms(profile_, kernel, variant, whole.reduction);
  return {device_, {std::move(programs.vertex), std::move(programs.main)}};
}

ProgramBuild ProgramCache::begin(const program::Reduction& reduction,
                                 const assemble::ReduceVariant& variant) {
  return {device_,
          {isCompute() ? std::string() : assemble::vertexProgram(profile_),
           assemble::reduceProgram(profile_, reduction, variant)}};
}

void ProgramCache::finish(KernelProgram& result, const program::Kernel& kernel, ProgramBuild&& begun) {
  std::string log;
  result.program = begun.finish(device_, log);
  if (!result.program) {
    log.clear();
    device_.context().throwIfLost();
    gl::Program::build(device_.bound(), {begun.sources().vertex, withEncodedLines(begun.sources().main)},
                       log);
    throw Error(
        fmt::format("{}: the driver of '{}' refuses the kernel's {} program:\n{}", kernel.name,
                    device_.capabilities.renderer, profile_.name, withSourceNames(log, kernel.sources)),
        Error::Kind::Compile);
  }
  device_.context().labels().program(result.program.name(), kernel.name);
  result.stage = profile_.stage;
  result.domainRow = {result.program.location("sk_domain_row"), false};
  const GLint loopNumber = result.program.location("sk_loop_number");
  if (loopNumber >= 0) {
    result.loopNumber = device_.passes().loopReports().numberOf(kernel.name);
    result.loopNumberUniform = {loopNumber, false};
  }
  if (result.stage == assemble::Stage::Compute) {
    result.rect = {result.program.location("sk_rect"), true};
    result.workGroup = result.program.workGroup();
  }
}

bool ProgramCache::startReduceProgram(const program::Reduction& reduction,
                                      const assemble::ReduceVariant& variant) {
  forgetUnloaded();
  const ReduceKey key{&reduction, variant};
  if (reductions_.contains(key)) {
    return false;
  }
  if (!startedReductions_.contains(key)) {
    startedReductions_.emplace(key, begin(reduction, variant));
  }
  return true;
}

ReduceProgram& ProgramCache::reduceProgram(const program::Reduction& reduction,
                                           const assemble::ReduceVariant& variant) {
  forgetUnloaded();
  const ReduceKey key{&reduction, variant};
  const auto found = reductions_.find(key);
  if (found == reductions_.end()) {
    const TraceScope traced(device_.trace.get(), "program", reduction.fold.name);
    auto result = std::make_unique<ReduceProgram>();
    const bool isPartial = assemble::isOfPartials(variant.walk);
    const program::Kernel& kernel = isPartial ? reduction.combine : reduction.fold;
    withReadKernel(kernel, variant,
                   [&](const program::Kernel& read) { checkUnits(read, variant.specs, variant.access, {}); });
    auto started = startedReductions_.extract(key);
    finish(result->kernel, kernel, started.empty() ? begin(reduction, variant) : std::move(started.mapped()));
    result->kernel.isGrouped = variant.grouped || variant.walk == assemble::Walk::GroupedPartials ||
                               variant.unit != assemble::ScanUnit::Item ||
                               variant.rows == assemble::RowPass::Groups;
    withReadKernel(kernel, variant, [&](const program::Kernel& read) {
      findParameters(result->kernel, read, variant.specs, variant.access);
    });
    makeRoom(reductions_, [&](const ReduceKey& other) { return other.first == &reduction; });
    Kept<ReduceProgram> kept{std::move(result), ++clock_, program::LinkedFile::objectOf(&reduction)};
    return *reductions_.insert_or_assign(key, std::move(kept)).first->second.program;
  }
  found->second.used = ++clock_;
  return *found->second.program;
}

gl::IntUniform& ReduceProgram::uniform(const assemble::UniformValue& value) {
  const auto found = std::find_if(uniforms.begin(), uniforms.end(),
                                  [&](const auto& known) { return known.first == value.name; });
  if (found != uniforms.end()) {
    return found->second;
  }
  const std::string name(value.name);
  return uniforms.emplace_back(name, gl::IntUniform(kernel.program.location(name), value.isVector)).second;
}

}  // namespace sk
