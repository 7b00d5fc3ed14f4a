// SPDX-License-Identifier: MIT
//
// Implements sk::Device: resolves options with the environment, opens a DeviceState and forwards calls to it.
#include "sk/device.hpp"

#include <array>
#include <charconv>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "assemble/assemble.hpp"
#include "assemble/elements/planes.hpp"
#include "call/check_written.hpp"
#include "device/stream_state.hpp"
#include "gl_device/gl_device.hpp"
#include "native/native_device.hpp"
#include "probe/probe.hpp"
#include "results/recorder.hpp"
#include "shadow/shadow_device.hpp"
#include "sk/error.hpp"
#include "sk/linked_file.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

/// The option if it is set, else the environment variable.
std::string chosen(const std::string& option, const char* variable) {
  const char* value = std::getenv(variable);
  return !option.empty() || value == nullptr ? option : value;
}

std::optional<gl::Api> apiOf(const std::string& profile) {
  if (profile.empty()) {
    return std::nullopt;
  }
  const assemble::Profile* found = assemble::findProfile(profile);
  if (found != nullptr && !found->webgl) {
    return found->es ? gl::Api::Es : gl::Api::Gl;
  }
  std::string known;
  for (const assemble::Profile& row : assemble::profiles()) {
    if (!row.webgl) known += fmt::format("{}{}", known.empty() ? "" : ", ", row.name);
  }
  throw Error(
      fmt::format("there is no profile '{}'; choose one of {} (option or SK_PROFILE)", profile, known),
      Error::Kind::Device);
}

/// The target of a profile's programs; Default if no profile is named.
Target targetOf(const std::string& profile) {
  const assemble::Profile* found = assemble::findProfile(profile);
  if (found == nullptr) return Target::Default;
  return found->stage == assemble::Stage::Compute ? Target::Compute : Target::Fragment;
}

/// Whether the device must keep to the limits that its profile guarantees.
bool usesGuaranteedLimits(const std::string& limits) {
  if (!limits.empty() && limits != "device" && limits != "guaranteed") {
    throw Error(
        fmt::format("there are no limits '{}'; choose device or guaranteed (option or SK_LIMITS)", limits));
  }
  return limits == "guaranteed";
}

/// The option if it is set, else the environment variable. A smaller limit could not hold the results of a
/// device's own passes.
std::int32_t textureLimitOf(std::int32_t option) {
  constexpr int least = 4;
  const std::string text = option != 0 ? std::to_string(option) : chosen({}, "SK_TEXTURE_LIMIT");
  std::int32_t limit = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), limit);
  const bool isNumber = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
  if (!text.empty() && (!isNumber || limit < least)) {
    throw Error(
        fmt::format("the texture limit '{}' is no number of texels from {} on (option or SK_TEXTURE_LIMIT)",
                    text, least));
  }
  return limit;
}

/// Whether doubles are pairs of floats. Guaranteed limits imply pairs, because profiles guarantee no doubles.
bool usesPairs(const std::string& doubles, bool guaranteedLimits) {
  if (!doubles.empty() && doubles != "native" && doubles != "pairs") {
    throw Error(
        fmt::format("there are no doubles '{}'; choose native or pairs (option or SK_DOUBLES)", doubles));
  }
  return doubles.empty() ? guaranteedLimits : doubles == "pairs";
}

/// The requested barrier; nullopt if the name is empty.
std::optional<Barrier> barrierOf(const std::string& name) {
  if (name.empty()) {
    return std::nullopt;
  }
  for (const auto& [barrier, known] : barrierNames) {
    if (name == known) {
      return barrier;
    }
  }
  throw Error(
      fmt::format("there is no barrier '{}'; choose precise, xor or none (option or SK_BARRIER)", name));
}

DeviceChoices choicesOf(const DeviceOptions& options, bool sharesContext, const gl::TraitChoices& traits) {
  const bool guaranteedLimits = usesGuaranteedLimits(options.limits);
  return {textureLimitOf(options.textureLimit),
          guaranteedLimits,
          usesPairs(options.doubles, guaranteedLimits),
          barrierOf(options.barrier),
          targetOf(options.profile),
          sharesContext,
          traits};
}

/// The option if it is set, else the environment variable.
std::int64_t memoryLimitOf(std::int64_t option) {
  const std::string text = option != 0 ? std::to_string(option) : chosen({}, "SK_MEMORY_LIMIT");
  std::int64_t limit = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), limit);
  const bool isNumber = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
  if (!text.empty() && (!isNumber || limit < 1)) {
    throw Error(
        fmt::format("the memory limit '{}' is no number of bytes from 1 on (option or SK_MEMORY_LIMIT)",
                    text),
        Error::Kind::Device);
  }
  return limit;
}

/// No more than the limit, where there is one.
std::optional<std::int64_t> limited(std::optional<std::int64_t> bytes, std::int64_t limit) {
  return limit == 0 ? bytes : std::min(bytes.value_or(limit), limit);
}

/// The file that is named, if any.
Configuration configurationOf(const DeviceOptions& options) {
  const std::string name = chosen(options.configuration, "SK_CONFIG");
  if (name.empty()) return {};
  Configuration configuration(name);
  configuration.checkNames(program::LinkedFile::namesOfAll());
  return configuration;
}

/// Has SK_RESULTS record what the device does.
void startRecording(DeviceState& device) {
  device.results = results::Recorder::ofProcess();
  if (device.results == nullptr) return;
  device.runsCallByCall = device.runsCallByCall || device.results->measures();
  device.results->addDevice(device);
}

/// Gives a device its configuration, and the memory limit, the trace and the shadow that are named, if any.
detail::DeviceOwner configured(std::unique_ptr<DeviceState> state, const DeviceOptions& options,
                               Configuration configuration) {
  state->memoryLimit = memoryLimitOf(options.memoryLimit);
  state->limits.memory = limited(state->limits.memory, state->memoryLimit);
  state->configuration = std::move(configuration);
  state->runsCallByCall = checksWritten() || checksRanges();
  const std::string trace = chosen({}, "SK_TRACE");
  if (!trace.empty()) state->startTrace(trace);
  startRecording(*state);
  return detail::DeviceOwner(withShadow(std::move(state)).release());
}

constexpr std::array<std::pair<std::string_view, RealType>, 3> nativeDevices = {
    {{"native", RealType::Float}, {"reference", RealType::Double}, {"reference:quad", RealType::Quad}}};

/// Fills in unset options from the environment.
DeviceOptions withEnvironment(DeviceOptions options) {
  options.device = chosen(options.device, "SK_DEVICE");
  options.profile = chosen(options.profile, "SK_PROFILE");
  options.textureLimit = textureLimitOf(options.textureLimit);
  options.limits = chosen(options.limits, "SK_LIMITS");
  options.doubles = chosen(options.doubles, "SK_DOUBLES");
  options.barrier = chosen(options.barrier, "SK_BARRIER");
  return options;
}

/// Whether the options leave any device possible: none is named, and none of the options needs GL.
bool mayBeAny(const DeviceOptions& options) {
  return options.device.empty() && options.profile.empty() && options.textureLimit == 0 &&
         options.limits.empty() && options.doubles.empty() && options.barrier.empty() &&
         !options.sharesContext;
}

std::unique_ptr<DeviceState> openGl(const DeviceOptions& options, bool sharesContext,
                                    const Configuration& configuration, gl::OpenedContext context) {
  const gl::TraitChoices traits = configuration.traitsOf(context.capabilities.renderer);
  return std::make_unique<GlDevice>(std::move(context), choicesOf(options, sharesContext, traits));
}

/// Opens the fastest device that has code of every .sk file: a GPU, else native code, else a software
/// renderer.
std::unique_ptr<DeviceState> openBest(const DeviceOptions& options, const Configuration& configuration) {
  const program::LinkedFile::Code code = program::LinkedFile::ofAll();
  const auto with = [&](gl::OpenedContext context) {
    return openGl(options, options.sharesContext, configuration, std::move(context));
  };
  if (!code.native) return with(gl::openContext({}));
  if (std::optional<gl::OpenedContext> gpu = code.glsl ? gl::findGpu() : std::nullopt)
    return with(std::move(*gpu));
  return std::make_unique<NativeDevice>(RealType::Float);
}

std::unique_ptr<DeviceState> openState(const DeviceOptions& options, const Configuration& configuration) {
  for (const auto& [name, real] : nativeDevices) {
    if (options.device == name) return std::make_unique<NativeDevice>(real);
  }
  if (mayBeAny(options)) return openBest(options, configuration);
  return openGl(options, options.sharesContext, configuration,
                gl::openContext({options.device, apiOf(options.profile)}));
}

constexpr std::string_view aDevice = "a new device";

/// `options()` returns the requested options.
template <class Options>
detail::DeviceOwner open(Options&& options) {
  return withHostMemory(aDevice, [&] {
    requireKnownCheck();
    const DeviceOptions requested = withEnvironment(options());
    Configuration configuration = configurationOf(requested);
    std::unique_ptr<DeviceState> state = openState(requested, configuration);
    return configured(std::move(state), requested, std::move(configuration));
  });
}

detail::DeviceOwner openNative(RealType real) {
  return withHostMemory(aDevice, [&] {
    requireKnownCheck();
    return configured(std::make_unique<NativeDevice>(real), {}, configurationOf({}));
  });
}

}  // namespace

void detail::DeviceDeleter::operator()(DeviceState* state) const noexcept { delete state; }

Device::Device() : Device(DeviceOptions{}) {}
Device::Device(std::string_view device)
    : state_(open([&] { return DeviceOptions{.device = std::string(device)}; })) {}
Device::Device(const DeviceOptions& options) : state_(open([&] { return options; })) {}
Device::Device(detail::DeviceOwner state) : state_(std::move(state)) {}
Device::~Device() = default;
Device::Device(Device&& other) noexcept = default;
Device& Device::operator=(Device&& other) noexcept = default;

Device Device::adopt(const DeviceOptions& given) {
  return withHostMemory(aDevice, [&] {
    requireKnownCheck();
    const DeviceOptions options = withEnvironment(given);
    Configuration configuration = configurationOf(options);
    std::unique_ptr<DeviceState> state =
        openGl(options, true, configuration, gl::adoptContext(apiOf(options.profile), options.profile));
    return Device(configured(std::move(state), options, std::move(configuration)));
  });
}

Device Device::native() { return Device(openNative(RealType::Float)); }
Device Device::reference(Reference kind) {
  return Device(openNative(kind == Reference::Double ? RealType::Double : RealType::Quad));
}

DeviceState& detail::deviceStateOf(const Device& device) { return device.state(); }

DeviceState& Device::state() const {
  if (!state_) {
    throw Error("the device was moved from", Error::Kind::Lost);
  }
  return *state_;
}

detail::StreamOwner Device::createStream(const program::Element& element, const Shape& shape, Storage storage,
                                         std::string_view name) {
  return withHostMemory("a new stream", [&] {
    if (shape.rank() == 0) throw Error("a stream needs a shape of 1 to 4 dimensions", Error::Kind::Shape);
    const bool holdsFloats = assemble::holdsFloats(element);
    const bool isChosenByFile = storage == Storage::Default && holdsFloats;
    if (storage == Storage::Default) {
      storage = holdsFloats ? state().configuration.storageOf(name) : Storage::Single;
    }
    if (storage != Storage::Single && !holdsFloats) {
      throw Error(fmt::format("a stream of {} has no float or vector of floats to hold otherwise; make it "
                              "without a Storage",
                              element.name),
                  Error::Kind::Type);
    }
    detail::StreamOwner stream(state().createStream(element, shape, storage).release());
    if (!name.empty()) stream->setName(name);
    if (checksWritten()) trackWritten(*stream);
    if (results::Recorder* const recorder = state().results) {
      const std::optional<Storage> chosen = isChosenByFile ? std::optional(storage) : std::nullopt;
      if (holdsFloats && !isChosenByFile) {
        recorder->addNote(
            "some streams have a storage that the program chooses itself, which no file changes");
      }
      stream->resultNumber = recorder->addStream(name, chosen, shape.size() * std::uint64_t{element.size});
    }
    return stream;
  });
}

const std::string& Device::name() const { return state().name(); }
const std::string& Device::driver() const { return state().driver(); }
const std::string& Device::shadingLanguage() const { return state().shadingLanguage(); }
std::string_view Device::profile() const { return state().profileName(); }
const DeviceLimits& Device::limits() const { return state().limits; }
std::optional<std::int64_t> Device::availableMemory() const {
  return withHostMemory("availableMemory",
                        [&] { return limited(state().availableMemory(), state().memoryLimit); });
}
bool Device::isSoftware() const { return state().isSoftware(); }
const Arithmetic& Device::arithmetic() {
  return withHostMemory("arithmetic", [&]() -> const Arithmetic& { return state().arithmetic(); });
}
std::string_view Device::kind() const { return state().kind(); }
std::vector<DeviceTrait> Device::traits() const {
  return withHostMemory("traits", [&] { return state().traitValues(); });
}
std::vector<TargetTrial> Device::trialTargets() {
  return withHostMemory("trialTargets", [&] { return state().trialTargets(); });
}
std::vector<TableReport> Device::tables() const {
  return withHostMemory("tables", [&] { return state().underlying().tables.reports(); });
}
void Device::finish() {
  withHostMemory("finish", [&] {
    const TraceScope traced(state().trace.get(), "wait", "finish");
    state().finish();
  });
}
void Device::release() { state().release(); }
void Device::makeCurrent() {
  withHostMemory("makeCurrent", [&] { state().makeCurrent(); });
}

void Device::countPasses(bool on) {
  state().underlying().passCount = on ? std::optional<PassCount>(PassCount{}) : std::nullopt;
}
PassCount Device::passCount() const {
  const std::optional<PassCount>& count = state().underlying().passCount;
  if (!count) throw Error("nobody counts the device's passes; call countPasses(true) first");
  return *count;
}

}  // namespace sk
