// SPDX-License-Identifier: MIT
//
// Construction and destruction of a device, its checks of calls, and how it reports the driver's errors.
#include "gl_device/gl_device.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "assemble/append/append_groups.hpp"
#include "assemble/append/append_passes.hpp"
#include "assemble/glsl/tables.hpp"
#include "call/check_argument.hpp"
#include "call/precision.hpp"
#include "device/loop_state.hpp"
#include "gl/commands.hpp"
#include "gl_device/append/append_call.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/memory/keep_heap.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/transfer/pending_read.hpp"
#include "probe/copy_bandwidth.hpp"
#include "probe/probe.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

/// Leaves the passes of trials out of the user's count.
class UncountedPasses {
 public:
  explicit UncountedPasses(GlDevice& device) : device_(device), before_(device.passCount) {}
  ~UncountedPasses() { device_.passCount = before_; }
  UncountedPasses(const UncountedPasses&) = delete;
  UncountedPasses& operator=(const UncountedPasses&) = delete;

 private:
  GlDevice& device_;
  std::optional<PassCount> before_;
};

assemble::Profile profileOf(std::string_view name, const gl::Capabilities& capabilities,
                            const gl::DeviceTraits& traits, bool usesPairs) {
  assemble::Profile profile = *assemble::findProfile(name);
  if (!capabilities.hasDoubles || usesPairs) {
    profile.doubles = assemble::Doubles::Pairs;
  }
  profile.sharesTexels = traits.sharesTexels;
  profile.samples = traits.samplesTexels;
  profile.relaysUniforms = traits.relaysUniforms && profile.stage == assemble::Stage::Fragment;
  return profile;
}

/// The requested barrier, else the strongest one that the language has.
Barrier barrierOf(const gl::Capabilities& capabilities, const DeviceChoices& choices) {
  if (choices.barrier == Barrier::Precise && !capabilities.hasPrecise) {
    throw Error(
        fmt::format("'{}' has no `precise` in its {}; choose xor or none (option or SK_BARRIER)",
                    capabilities.renderer, capabilities.api == gl::Api::Gl ? "GLSL 3.30" : "ESSL 3.00"),
        Error::Kind::Device);
  }
  return choices.barrier.value_or(capabilities.hasPrecise ? Barrier::Precise : Barrier::Xor);
}

}  // namespace

GlDevice::GlDevice(gl::OpenedContext&& opened, const DeviceChoices& choices)
    : capabilities(std::move(opened.capabilities)),
      traits(gl::traitsOf(capabilities.kind, choices.traits)),
      profile(profileOf(capabilities.api == gl::Api::Gl ? "glsl330" : "essl300", capabilities, traits,
                        choices.pairs)),
      computeProfile(profileOf("glsl430", capabilities, traits, choices.pairs)),
      target(choices.target),
      scanPatience(choices.scanPatience),
      barrier(barrierOf(capabilities, choices)),
      context_(std::move(opened.context), capabilities, choices.sharesContext),
      appendPrograms(*this),
      sortPrograms(*this),
      stagingPrograms(*this),
      binaries(cache, capabilities, driverKey(name(), driver(), profileName())) {
  if (target == Target::Compute && !capabilities.hasCompute) {
    throw Error(
        fmt::format("'{}' runs no compute programs, which take OpenGL 4.3; leave profile glsl430 (option or "
                    "SK_PROFILE) out",
                    capabilities.renderer),
        Error::Kind::Device);
  }
  selectPrograms({}, assemble::Stage::Fragment);
  limits.textureSize = capabilities.textureSize;
  limits.textureLayers = capabilities.textureLayers;
  if (choices.textureLimit > 0 && choices.textureLimit < limits.textureSize) {
    limits.textureSize = choices.textureLimit;
  }
  limits.elements = mostElements;
  limits.drawBuffers = capabilities.drawBuffers;
  limits.textureUnits = capabilities.textureUnits;
  limits.uniformComponents = capabilities.uniformComponents;
  if (choices.guaranteedLimits) {
    limits.drawBuffers = profile.drawBuffers;
    limits.textureUnits = profile.textureUnits;
    limits.uniformComponents = profile.uniformComponents;
  }
  if (choices.barrier) {
    arithmetic_ = {
        .exactSums = *choices.barrier != Barrier::None, .barrier = *choices.barrier, .asWritten = false};
  }
  const gl::CurrentScope current(context_.any());
  limits.memory = memory_.info().whole;
  if (!context_.isGuest()) gl::setPassState(capabilities);
  if (capabilities.hasLabels && capabilities.isDebugged) context_.labels().turnOn();
  if (capabilities.isSoftware) keepHeap();
}

GlDevice::~GlDevice() {
  std::optional<gl::CurrentScope> current;
  try {
    current.emplace(context_.any());
  } catch (const std::exception&) {
    current.reset();  // it is current on another thread, or the application has destroyed it
  }
  {
    PendingReads& pending = *memory_.pendingReads();
    const std::lock_guard lock(pending.mutex);
    while (!pending.list.empty()) {
      PendingRead& read = *pending.list.back();
      current ? read.land() : read.abandon();
    }
  }
  if (passes_.trace() != nullptr && current) passes_.trace()->complete();
  for (LoopState* loop : loops) loop->leave();
  while (firstStream() != nullptr) {
    auto& stream = static_cast<GlStream&>(*firstStream());
    stream.leave();
    stream.planes.clear();
    stream.total_ = {};
  }
}

std::unique_ptr<StreamState> GlDevice::createStream(const program::Element& element, const Shape& shape,
                                                    Storage storage) {
  const DeviceScope scope(*this);
  return std::make_unique<GlStream>(*this, element, shape, storage);
}

// Accumulate::Extended leaves the representation open: in software, doubles are more precise than pairs of
// floats, and faster.
bool GlDevice::computesInPairs(const CallOptions& options) const {
  const bool requiresPairs = options.precision == Precision::Extended;
  return isExtended(options) &&
         (requiresPairs || !capabilities.isSoftware || profile.doubles == assemble::Doubles::Pairs);
}

bool GlDevice::mayDispatch(const program::Kernel& kernel) const {
  return capabilities.hasCompute && kernel.dispatched;
}

assemble::Stage GlDevice::stageOf(const program::Kernel& kernel, KernelClass kernels,
                                  const CallOptions& options, std::int64_t elements) {
  using assemble::Stage;
  const Target wanted = options.target != Target::Default ? options.target : target;
  if (!mayDispatch(kernel)) return Stage::Fragment;
  if (!kernel.drawn || wanted == Target::Compute) return Stage::Compute;
  if (wanted == Target::Fragment) return Stage::Fragment;
  if (kernels == KernelClass::OrderedScatters && elements < traits.sortedByDispatchesFrom)
    return Stage::Fragment;
  return fasterFor(kernels);
}

// On some GPUs only compute programs reach every core; on others, and in software, drawing is faster.
assemble::Stage GlDevice::fasterFor(KernelClass kernels) {
  std::optional<assemble::Stage>& known = faster_[static_cast<std::size_t>(kernels)];
  if (!known) {
    const UncountedPasses uncounted(*this);
    const std::optional<double> ratio = computeOverFragment(*this, kernels);
    known = ratio.value_or(1) < traits.dispatchBelow ? assemble::Stage::Compute : assemble::Stage::Fragment;
  }
  return *known;
}

std::vector<DeviceTrait> GlDevice::traitValues() const {
  std::vector<DeviceTrait> values;
  for (const gl::DeviceTraitRow& row : gl::deviceTraitRows())
    values.push_back({row.name, row.get(traits), row.most, row.meaning, row.reason});
  return values;
}

std::vector<TargetTrial> GlDevice::trialTargets() {
  const UncountedPasses uncounted(*this);
  std::vector<TargetTrial> trials;
  for (std::size_t i = 0; capabilities.hasCompute && i < kernelClasses; ++i) {
    const auto kernels = static_cast<KernelClass>(i);
    if (const std::optional<double> ratio = computeOverFragment(*this, kernels)) {
      trials.push_back({nameOf(kernels), *ratio});
    }
  }
  return trials;
}

void GlDevice::selectDrawnPrograms(const program::Kernel& kernel, const CallOptions& options) {
  if (!kernel.drawn || options.target == Target::Compute) {
    fail(Error::Kind::Device, kernel,
         "compute programs write its outputs only to streams that need no texture with layers, that fit the "
         "device's {} "
         "images, and of which no two are regions of one stream; compile it with skc "
         "--target=fragment,compute and call "
         "it without Target::Compute",
         limits.drawBuffers);
  }
  selectPrograms(options, assemble::Stage::Fragment);
}

void GlDevice::selectPrograms(const CallOptions& options, assemble::Stage stage) {
  const ProgramCacheKey key{
      .stage = stage,
      .accurate = options.intrinsics != Intrinsics::Fast,
      .doubles = computesInPairs(options) ? assemble::Doubles::Pairs : profile.doubles,
      .barrier = barrier,
      .asWritten = options.contraction != Contraction::Fast && !(arithmetic_ && arithmetic_->asWritten),
      .tables = options.tables != Tables::Off};
  if (programs_ != nullptr && key == cacheKey_) {
    return;
  }
  auto found = caches_.find(key);
  if (found == caches_.end()) {
    assemble::Profile cacheProfile = stage == assemble::Stage::Compute ? computeProfile : profile;
    cacheProfile.accurate = key.accurate;
    cacheProfile.doubles = key.doubles;
    cacheProfile.barrier = key.barrier;
    cacheProfile.asWritten = key.asWritten;
    cacheProfile.tables = key.tables;
    found = caches_.try_emplace(key, *this, cacheProfile).first;
  }
  programs_ = &found->second;
  cacheKey_ = key;
}

GLuint GlDevice::textureOf(const FunctionTable& table) {
  if (unloads_.hasChanged()) {
    std::erase_if(tableTextures_, [&](const auto& entry) { return !tables.has(entry.first); });
  }
  gl::Texture& texture = tableTextures_[table.number];
  if (texture.name() == 0) {
    const int width = assemble::coefficientsOf(table.report.interpolation);
    const std::int32_t rows =
        (table.report.range.intervals + assemble::tableWidth - 1) / assemble::tableWidth;
    std::vector<float> texels = table.coefficients;
    texels.resize(static_cast<std::size_t>(rows) * assemble::tableWidth * static_cast<std::size_t>(width));
    texture = gl::Texture(bound(), gl::formatOf(program::Scalar::Float, width), {assemble::tableWidth, rows});
    if (texture.name() == 0) {
      context_.throwIfLost();
      throw Error(fmt::format("'{}' has no memory for the table of '{}': {} KiB", capabilities.renderer,
                              table.report.function, texels.size() * sizeof(float) >> 10),
                  Error::Kind::Memory);
    }
    texture.write(bound(), {0, 0, assemble::tableWidth, rows}, 0, texels.data());
  }
  return texture.name();
}

void GlDevice::startTrace(const std::string& file) {
  auto started = std::make_unique<Trace>(file, fmt::format("{} ({})", name(), profileName()));
  const UncountedPasses uncounted(*this);
  started->setBandwidth(copyBandwidth(*this));
  trace = std::move(started);
  const DeviceScope scope(*this);
  passes_.startTrace(*trace);
  if (capabilities.hasLabels) context_.labels().turnOn();
}

void GlDevice::finish() {
  const DeviceScope scope(*this);
  gl::finish();
  throwPendingError();
}

const Arithmetic& GlDevice::arithmetic() {
  if (!arithmetic_) {
    const UncountedPasses uncounted(*this);
    arithmetic_ = probeArithmetic(*this);
  }
  return *arithmetic_;
}

void GlDevice::needExactSums(const program::Kernel& kernel) {
  if (!arithmetic().exactSums) {
    fail(Error::Kind::Device, kernel,
         "it computes with pairs of floats, and the compiler of '{}' simplifies their rounding errors away; "
         "use float, or a device that has doubles (SK_DEVICE=native)",
         name());
  }
}

void GlDevice::checkProgram(const program::Kernel& kernel) {
  if (kernel.usesDoubles && profile.doubles == assemble::Doubles::Pairs) {
    needExactSums(kernel);
  } else if (kernel.usesExactSums || barrier == Barrier::Xor) {
    arithmetic();
  }
}

void GlDevice::checkProgram(const program::Reduction& reduction) {
  checkProgram(reduction.fold);
  checkProgram(reduction.combine);
}

void GlDevice::checkTarget(const program::Kernel& kernel, const CallOptions& options) const {
  const Target requested = options.target;
  if (requested == Target::Native) {
    fail(Error::Kind::Device, kernel,
         "its streams are on '{}'; native code runs on streams of sk::Device::native()", name());
  }
  constexpr std::string_view compileForBoth = "compile its .sk file with skc --target=fragment,compute";
  const bool mustDispatch = requested == Target::Compute || !kernel.drawn;
  const std::string_view wayOut = kernel.drawn ? "call it without Target::Compute" : compileForBoth;
  if (mustDispatch && !capabilities.hasCompute) {
    fail(Error::Kind::Device, kernel, "'{}' runs no compute programs, which take OpenGL 4.3; {}", name(),
         wayOut);
  }
  if (mustDispatch && !kernel.dispatched) {
    fail(Error::Kind::Compile, kernel, "it has no compute programs; {}", compileForBoth);
  }
  if (requested == Target::Fragment && !kernel.drawn) {
    fail(Error::Kind::Compile, kernel, "it has no fragment programs; {}", compileForBoth);
  }
}

void GlDevice::checkOptions(const program::Kernel& kernel, const CallOptions& options) {
  checkTarget(kernel, options);
  if (computesInPairs(options)) {
    needExactSums(kernel);
  }
  if (options.precision == Precision::Double && profile.doubles != assemble::Doubles::Native) {
    fail(Error::Kind::Device, kernel, "'{}' has no doubles of its own; call it in Precision::Extended",
         name());
  }
}

// Lists of append outputs, bundles and temporaries of plans have the element types that the kernel declares.
// Other storages may exceed the device's limits: a vector of doubles may have more planes than one of floats.
void GlDevice::checkStorages(const program::Kernel& kernel, std::span<const Argument> arguments,
                             const assemble::SpecValues& specs, const program::Plan* plan) const {
  std::size_t written = 0;
  std::size_t read = 0;
  bool isOther = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const program::Parameter& parameter = kernel.parameters[i];
    if (arguments[i].region.stream == nullptr || !assemble::isNeeded(parameter, specs)) continue;
    const GlStream& stream = glStream(arguments[i].region);
    const std::size_t planes = stream.held().fields.size();
    if (parameter.role == program::Role::Output) written += planes;
    const bool isRead = parameter.role == program::Role::Input || parameter.role == program::Role::Gather ||
                        parameter.role == program::Role::Uniform;
    if (isRead) read += planes;
    if (stream.storage == Storage::Single) continue;
    isOther = true;
    if (assemble::isAppendOutput(parameter)) {
      fail(kernel,
           "'{}' is a variable or scatter output, whose stream holds floats; make it with Storage::Single",
           parameter.name);
    }
    if (plan != nullptr) {
      fail(kernel,
           "it takes several passes on this device, for which the stream of '{}' has to hold floats; make it "
           "with Storage::Single",
           parameter.name);
    }
  }
  if (!isOther) return;
  if (written > static_cast<std::size_t>(limits.drawBuffers) ||
      read > static_cast<std::size_t>(limits.textureUnits)) {
    fail(Error::Kind::Device, kernel,
         "its streams hold {} planes to write and {} to read, but this device has room for {} and {}; make "
         "those of vectors with Storage::Single",
         written, read, limits.drawBuffers, limits.textureUnits);
  }
}

// An adopted context is either current already, or cannot be made current.
std::optional<std::int64_t> GlDevice::availableMemory() {
  const gl::CurrentScope current(context_.any());
  return memory_.info().available;
}

void GlDevice::makeCurrent() {
  if (!context_.any().isCurrent()) context_.any().makeCurrent();
}

void GlDevice::throwPendingError() {
  if (PassTrace* const passes = passes_.trace()) passes->collect();
  const std::int64_t unchecked = context_.period();
  const GLenum error = context_.endPeriod();
  if (error == GL_NO_ERROR) return;
  context_.throwIfLost();
  for (StreamState* state = firstStream(); state != nullptr; state = state->next()) {
    auto& stream = static_cast<GlStream&>(*state);
    if (stream.wasWrittenIn(unchecked)) stream.markLost();
  }
  throw Error(
      fmt::format(
          "the driver of '{}' reports {}; the streams that were written since it was last asked are lost",
          capabilities.renderer, gl::errorName(error)),
      error == GL_OUT_OF_MEMORY ? Error::Kind::Memory : Error::Kind::Lost);
}

}  // namespace sk
