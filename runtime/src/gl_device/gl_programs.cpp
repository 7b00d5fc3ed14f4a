// SPDX-License-Identifier: MIT
#include "gl_device/gl_programs.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "assemble/append/append_passes.hpp"
#include "assemble/glsl/tables.hpp"
#include "call/check_call.hpp"
#include "call/resolved_call.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "probe/probe.hpp"
#include "sk/error.hpp"
#include "support/cache_folder.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

assemble::Profile profileOf(std::string_view name, const gl::Capabilities& capabilities,
                            const gl::DeviceTraits& traits, bool usesPairs) {
  assemble::Profile profile = *assemble::findProfile(name);
  if (!capabilities.hasDoubles || usesPairs) {
    profile.doubles = assemble::Doubles::Pairs;
  }
  profile.sharesTexels = traits.sharesTexels;
  profile.samples = traits.samplesTexels;
  profile.relaysUniforms = traits.relaysUniforms && profile.stage == assemble::Stage::Fragment;
  profile.highProducts = !capabilities.isSoftware;
  // The host of a virtual machine may render in software.
  profile.checksLoops = capabilities.storesFromDraws &&
                        (capabilities.isSoftware || capabilities.kind == gl::RendererKind::Virtual);
  const bool needsEs31 = profile.checksLoops || capabilities.hasPrecise;
  if (profile.es && needsEs31) profile.version = "#version 310 es";
  profile.subgroups = profile.stage == assemble::Stage::Compute && capabilities.hasSubgroups;
  profile.storesAllFormats = capabilities.storesAllFormats;
  return profile;
}

constexpr std::string_view needOfCompute = "OpenGL 4.3 or ES 3.1";

/// The requested barrier, else the strongest one that the language has.
Barrier barrierOf(const gl::Capabilities& capabilities, const DeviceChoices& choices) {
  if (choices.barrier == Barrier::Precise && !capabilities.hasPrecise) {
    throw Error(fmt::format("'{}' has no `precise` in its {}; choose xor or none (option or SK_BARRIER)",
                            capabilities.renderer,
                            capabilities.api == gl::Api::Gl ? "GLSL 3.30"
                            : capabilities.hasCompute       ? "ESSL 3.10"
                                                            : "ESSL 3.00"),
                Error::Kind::Device);
  }
  return choices.barrier.value_or(capabilities.hasPrecise ? Barrier::Precise : Barrier::Xor);
}

}  // namespace

GlPrograms::GlPrograms(GlDevice& device, const DeviceChoices& choices)
    : device_(device),
      profile_(profileOf(device.capabilities.api == gl::Api::Gl ? "glsl330" : "essl300", device.capabilities,
                         device.traits, choices.pairs)),
      computeProfile_(profileOf(device.capabilities.api == gl::Api::Gl ? "glsl430" : "essl310",
                                device.capabilities, device.traits, choices.pairs)),
      barrier_(barrierOf(device.capabilities, choices)),
      binaries_(device.cache, device.capabilities,
                driverKey(device.capabilities.renderer, device.capabilities.driver, profileName())) {
  if (device.target == Target::Compute && !device.capabilities.hasCompute) {
    throw Error(
        fmt::format(
            "'{}' runs no compute programs, which take {}; leave profile {} (option or SK_PROFILE) out",
            device.capabilities.renderer, needOfCompute, computeProfile_.name),
        Error::Kind::Device);
  }
  for (const gl::Format& format : gl::formats())
    stored_[format.index] = assemble::mayStore(computeProfile_, gl::lowerCase(format.name));
  if (choices.barrier) {
    arithmetic_ = {
        .exactSums = *choices.barrier != Barrier::None, .barrier = *choices.barrier, .asWritten = false};
  }
  select({}, assemble::Stage::Fragment);
}

std::string_view GlPrograms::profileName() const {
  return device_.target == Target::Compute ? computeProfile_.name : profile_.name;
}

std::unique_ptr<IntegerProgram> GlPrograms::build(gl::ProgramSources sources, std::string_view what) {
  std::string log;
  gl::Program program = ProgramBuild(device_, std::move(sources)).finish(device_, log);
  if (!program) {
    device_.context().throwIfLost();
    throw Error(fmt::format("the driver of '{}' refuses {}:\n{}", device_.name(), what, log),
                Error::Kind::Compile);
  }
  device_.bound().program(program.name());
  return std::make_unique<IntegerProgram>(std::move(program));
}

// Accumulate::Extended leaves the representation open: in software, doubles are more precise than pairs of
// floats, and faster.
bool GlPrograms::computesInPairs(const CallOptions& options) const {
  const bool requiresPairs = options.precision == Precision::Extended;
  return isExtended(options) &&
         (requiresPairs || !device_.capabilities.isSoftware || profile_.doubles == assemble::Doubles::Pairs);
}

bool GlPrograms::mayDispatch(const program::Kernel& kernel) const {
  return device_.capabilities.hasCompute && kernel.dispatched;
}

assemble::Stage GlPrograms::stageOf(const program::Kernel& kernel, KernelClass kernels,
                                    const CallOptions& options, std::int64_t elements) {
  using assemble::Stage;
  const Target wanted = options.target != Target::Default ? options.target : device_.target;
  if (!mayDispatch(kernel)) return Stage::Fragment;
  if (!kernel.drawn || wanted == Target::Compute) return Stage::Compute;
  if (wanted == Target::Fragment) return Stage::Fragment;
  if (kernels == KernelClass::OrderedScatters && elements < device_.traits.sortedByDispatchesFrom)
    return Stage::Fragment;
  return fasterFor(kernels);
}

// On some GPUs only compute programs reach every core; on others, and in software, drawing is faster.
assemble::Stage GlPrograms::fasterFor(KernelClass kernels) {
  std::optional<assemble::Stage>& known = faster_[static_cast<std::size_t>(kernels)];
  if (!known) {
    const UncountedPasses uncounted(device_.passCount);
    const std::optional<double> ratio = computeOverFragment(device_, kernels);
    known = ratio.value_or(1) < device_.traits.dispatchBelow ? assemble::Stage::Compute
                                                             : assemble::Stage::Fragment;
  }
  return *known;
}

std::vector<TargetTrial> GlPrograms::trialTargets() {
  const UncountedPasses uncounted(device_.passCount);
  std::vector<TargetTrial> trials;
  for (std::size_t i = 0; device_.capabilities.hasCompute && i < kernelClasses; ++i) {
    const auto kernels = static_cast<KernelClass>(i);
    if (const std::optional<double> ratio = computeOverFragment(device_, kernels)) {
      trials.push_back({nameOf(kernels), *ratio});
    }
  }
  return trials;
}

void GlPrograms::selectDrawn(const program::Kernel& kernel, const CallOptions& options) {
  if (!kernel.drawn || options.target == Target::Compute) failForImages(kernel);
  select(options, assemble::Stage::Fragment);
}

void GlPrograms::failForImages(const program::Kernel& kernel) const {
  fail(Error::Kind::Device, kernel,
       "compute programs write its outputs only to streams that need no texture with layers, that fit the "
       "device's {} images{}, and of which no two are regions of one stream; compile it with skc "
       "--target=fragment,compute and call it without Target::Compute",
       device_.limits.images, device_.capabilities.storesAllFormats ? "" : " and their formats");
}

void GlPrograms::select(const CallOptions& options, assemble::Stage stage) {
  const ProgramCacheKey key{
      .stage = stage,
      .accurate = options.intrinsics != Intrinsics::Fast,
      .doubles = computesInPairs(options) ? assemble::Doubles::Pairs : profile_.doubles,
      .barrier = barrier_,
      .asWritten = options.contraction != Contraction::Fast && !(arithmetic_ && arithmetic_->asWritten),
      .tables = options.tables != Tables::Off};
  if (selected_ != nullptr && key == selectedKey_) {
    return;
  }
  selected_ = &cacheOf(key);
  selectedKey_ = key;
}

ProgramCache& GlPrograms::cacheOf(const ProgramCacheKey& key) {
  const auto found = caches_.find(key);
  if (found != caches_.end()) return found->second;
  assemble::Profile cacheProfile = key.stage == assemble::Stage::Compute ? computeProfile_ : profile_;
  cacheProfile.accurate = key.accurate;
  cacheProfile.doubles = key.doubles;
  cacheProfile.barrier = key.barrier;
  cacheProfile.asWritten = key.asWritten;
  cacheProfile.tables = key.tables;
  return caches_.try_emplace(key, device_, cacheProfile).first->second;
}

ProgramCache& GlPrograms::selectedFor(const program::Kernel& kernel, std::span<RenderTarget* const> planes) {
  return selectedIf(!areDispatched() || mayStore(planes), kernel);
}

ProgramCache& GlPrograms::selectedFor(const program::Kernel& kernel, const gl::Format& format) {
  return selectedIf(mayStore(format), kernel);
}

ProgramCache& GlPrograms::selectedIf(bool mayStore, const program::Kernel& kernel) {
  if (mayStore || !areDispatched()) return *selected_;
  if (!kernel.drawn) failForImages(kernel);
  ProgramCacheKey key = selectedKey_;
  key.stage = assemble::Stage::Fragment;
  return cacheOf(key);
}

bool GlPrograms::mayStore(const program::Element& element) const {
  return std::ranges::all_of(element.fields,
                             [&](const program::Field& field) { return mayStore(gl::formatOf(field)); });
}

bool GlPrograms::mayStore(std::span<RenderTarget* const> planes) const {
  return planes.size() <= static_cast<std::size_t>(device_.limits.images) &&
         std::ranges::all_of(planes,
                             [&](const RenderTarget* plane) { return mayStore(plane->texture.format()); });
}

GLuint GlPrograms::textureOf(const FunctionTable& table) {
  if (unloads_.hasChanged()) {
    std::erase_if(tableTextures_, [&](const auto& entry) { return !device_.tables.has(entry.first); });
  }
  gl::Texture& texture = tableTextures_[table.number];
  if (texture.name() == 0) {
    const int width = assemble::coefficientsOf(table.report.interpolation);
    const std::int32_t rows =
        (table.report.range.intervals + assemble::tableWidth - 1) / assemble::tableWidth;
    std::vector<float> texels = table.coefficients;
    texels.resize(static_cast<std::size_t>(rows) * assemble::tableWidth * static_cast<std::size_t>(width));
    texture = gl::Texture(device_.bound(), gl::formatOf(program::Scalar::Float, width),
                          {assemble::tableWidth, rows});
    if (texture.name() == 0) {
      device_.context().failForMemory(
          fmt::format("the table of '{}': {}", table.report.function,
                      bytesText(static_cast<std::int64_t>(texels.size() * sizeof(float)))));
    }
    texture.write(device_.bound(), {0, 0, assemble::tableWidth, rows}, 0, texels.data());
  }
  return texture.name();
}

const Arithmetic& GlPrograms::arithmetic() {
  if (!arithmetic_) {
    const UncountedPasses uncounted(device_.passCount);
    arithmetic_ = probeArithmetic(device_);
  }
  return *arithmetic_;
}

void GlPrograms::needExactSums(const program::Kernel& kernel) {
  if (!arithmetic().exactSums) {
    fail(Error::Kind::Device, kernel,
         "it computes with pairs of floats, and the compiler of '{}' simplifies their rounding errors away; "
         "use float, or a device that has doubles (SK_DEVICE=native)",
         device_.name());
  }
}

void GlPrograms::checkKernel(const program::Kernel& kernel) {
  if (kernel.usesDoubles && profile_.doubles == assemble::Doubles::Pairs) {
    needExactSums(kernel);
  } else if (kernel.usesExactSums || barrier_ == Barrier::Xor) {
    arithmetic();
  }
}

void GlPrograms::checkTarget(const program::Kernel& kernel, const CallOptions& options) const {
  const Target requested = options.target;
  if (requested == Target::Native) {
    fail(Error::Kind::Device, kernel,
         "its streams are on '{}'; native code runs on streams of sk::Device::native()", device_.name());
  }
  constexpr std::string_view compileForBoth = "compile its .sk file with skc --target=fragment,compute";
  const bool mustDispatch = requested == Target::Compute || !kernel.drawn;
  const std::string_view wayOut = kernel.drawn ? "call it without Target::Compute" : compileForBoth;
  if (mustDispatch && !device_.capabilities.hasCompute) {
    fail(Error::Kind::Device, kernel, "'{}' runs no compute programs, which take {}; {}", device_.name(),
         needOfCompute, wayOut);
  }
  if (mustDispatch && !kernel.dispatched) {
    fail(Error::Kind::Compile, kernel, "it has no compute programs; {}", compileForBoth);
  }
  if (requested == Target::Fragment && !kernel.drawn) {
    fail(Error::Kind::Compile, kernel, "it has no fragment programs; {}", compileForBoth);
  }
}

void GlPrograms::checkOptions(const program::Kernel& kernel, const CallOptions& options) {
  checkTarget(kernel, options);
  if (computesInPairs(options)) {
    needExactSums(kernel);
  }
  if (options.precision == Precision::Double && profile_.doubles != assemble::Doubles::Native) {
    fail(Error::Kind::Device, kernel, "'{}' has no doubles of its own; call it in Precision::Extended",
         device_.name());
  }
}

}  // namespace sk
