// SPDX-License-Identifier: MIT
//
// Construction and destruction of a device, its checks of calls, and how it reports the driver's errors.
#include "gl_device/gl_device.hpp"

#include <algorithm>
#include <exception>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "assemble/append/append_passes.hpp"
#include "call/check_call.hpp"
#include "device/loop_state.hpp"
#include "device/region.hpp"
#include "gl/commands.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/pass_trace.hpp"
#include "gl_device/transfer/buffered_transfer.hpp"
#include "probe/copy_bandwidth.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

/// What a device uses of its context. With the profile essl300, devices are like those of OpenGL ES 3.0; with guaranteed limits,
/// compute programs of ES write images of the formats that every device of 3.1 has.
gl::Capabilities usedOf(gl::Capabilities&& found, const DeviceChoices& choices) {
  if (found.api != gl::Api::Es) return std::move(found);
  if (choices.target == Target::Fragment) found.hasCompute = found.hasPrecise = false;
  if (choices.guaranteedLimits) found.storesAllFormats = false;
  return std::move(found);
}

}  // namespace

GlDevice::GlDevice(gl::OpenedContext&& opened, const DeviceChoices& choices)
    : capabilities(usedOf(std::move(opened.capabilities), choices)),
      traits(gl::traitsOf(capabilities.kind, choices.traits)),
      target(choices.target),
      scanPatience(choices.scanPatience),
      context_(std::move(opened.context), capabilities, choices.sharesContext),
      programs_(*this, choices) {
  limits.textureSize = capabilities.textureSize;
  limits.textureLayers = capabilities.textureLayers;
  if (choices.textureLimit > 0 && choices.textureLimit < limits.textureSize) {
    limits.textureSize = choices.textureLimit;
  }
  limits.elements = mostElements;
  limits.drawBuffers = capabilities.drawBuffers;
  limits.images = capabilities.hasCompute ? capabilities.images : 0;
  limits.textureUnits = capabilities.textureUnits;
  limits.uniformComponents = capabilities.uniformComponents;
  if (choices.guaranteedLimits) {
    const assemble::Profile& profile =
        target == Target::Compute ? programs_.computeProfile() : programs_.profile();
    limits.drawBuffers = profile.drawBuffers;
    limits.images = std::min(limits.images, programs_.computeProfile().drawBuffers);
    limits.textureUnits = profile.textureUnits;
    limits.uniformComponents = profile.uniformComponents;
  }
  // plans have passes that are dispatched
  if (target == Target::Compute) limits.drawBuffers = std::min(limits.drawBuffers, limits.images);
  const gl::CurrentScope current(context_.handle());
  limits.memory = memory_.info().whole;
  if (!context_.isGuest()) gl::setPassState(capabilities);
  if (capabilities.hasLabels && capabilities.isDebugged) context_.labels().turnOn();
}

GlDevice::~GlDevice() {
  std::optional<gl::CurrentScope> current;
  try {
    current.emplace(context_.handle());
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

std::vector<DeviceTrait> GlDevice::traitValues() const {
  std::vector<DeviceTrait> values;
  for (const gl::DeviceTraitRow& row : gl::deviceTraitRows())
    values.push_back({row.name, row.get(traits), row.most, row.meaning, row.reason});
  return values;
}

void GlDevice::startTrace(const std::string& file) {
  auto started = std::make_unique<Trace>(file, fmt::format("{} ({})", name(), profileName()));
  const UncountedPasses uncounted(passCount);
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

bool GlDevice::beginMeasuring() {
  if (isSoftware() || !gl::hasTimestamps(context_.capabilities())) return false;
  const GlContext::Scope scope(context_);
  if (!begun_) {
    begun_ = gl::Timestamp(context_.bound().deletions);
    ended_ = gl::Timestamp(context_.bound().deletions);
  }
  begun_.take();
  return true;
}

std::int64_t GlDevice::endMeasuring() {
  {
    const GlContext::Scope scope(context_);
    ended_.take();
  }
  finish();
  const GlContext::Scope scope(context_);
  return ended_.result().value_or(0) - begun_.result().value_or(0);
}

// Lists of append outputs, stacks and temporaries of plans have the element types that the kernel declares.
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

// Kernels read elements at any address, but draw to rectangles, and passes of reductions and of append outputs read these.
bool GlDevice::needsDense(const program::Kernel& kernel, std::span<const Argument> arguments, std::size_t i) {
  const program::Role role = kernel.parameters[i].role;
  if (role == program::Role::Uniform) return false;
  if (role == program::Role::Scatter) return true;  // points are placed by the rank of the stream
  if (!needsDense(arguments[i].region)) return false;
  if (isPlaced(arguments[i].region)) return true;
  const bool readsRectangles =
      std::ranges::any_of(kernel.parameters, [](const program::Parameter& parameter) {
        return parameter.role == program::Role::Accumulator || assemble::isAppendOutput(parameter);
      });
  return readsRectangles || (role != program::Role::Input && role != program::Role::Gather);
}

bool GlDevice::needsDense(const StreamRegion& region) {
  return regionLayoutOf(region, glStream(region).layout).strided;
}

// An adopted context is either current already, or cannot be made current.
std::optional<std::int64_t> GlDevice::availableMemory() {
  const gl::CurrentScope current(context_.handle());
  return memory_.info().available;
}

void GlDevice::makeCurrent() {
  if (!context_.handle().isCurrent()) context_.handle().makeCurrent();
}

void GlDevice::loseStreamsSince(std::int64_t period) {
  for (StreamState* state = firstStream(); state != nullptr; state = state->next()) {
    auto& stream = static_cast<GlStream&>(*state);
    if (stream.wasWrittenSince(period)) stream.markLost();
  }
}

void GlDevice::throwPendingError() {
  if (PassTrace* const passes = passes_.trace()) passes->collect();
  const std::int64_t unchecked = context_.unchecked();
  const LoopReports::Report cut = passes_.loopReports().take(bound());
  const GLenum error = context_.takeError();
  if (error != GL_NO_ERROR) {
    context_.throwIfLost();
    loseStreamsSince(unchecked);
    throw Error(
        fmt::format(
            "the driver of '{}' reports {}; the streams that were written since it was last asked are lost",
            capabilities.renderer, gl::errorName(error)),
        error == GL_OUT_OF_MEMORY ? Error::Kind::Memory : Error::Kind::Lost);
  }
  if (cut.kernel.empty() && cut.isKnown) return;
  loseStreamsSince(cut.period);
  if (!cut.isKnown) context_.failForMemory("what programs report of their loops");
  throw Error(
      fmt::format("{}: the driver of '{}' ends the loops of an element, and of those that are computed with "
                  "it, after "
                  "65,000 iterations together, and one needs more; the streams that were written since then "
                  "are lost; divide the iterations among several calls, or use another device "
                  "(SK_DEVICE=native)",
                  cut.kernel, capabilities.renderer),
      Error::Kind::Device);
}

}  // namespace sk
