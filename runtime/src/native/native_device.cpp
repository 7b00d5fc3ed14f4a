// SPDX-License-Identifier: MIT
#include "native/native_device.hpp"

#include <limits>

#include "call/check_call.hpp"
#include "native/entries.hpp"
#include "native/native_stream.hpp"
#include "probe/copy_bandwidth.hpp"
#include "support/host_limits.hpp"

namespace sk {

namespace {

[[noreturn]] void failWithoutCode(const program::Kernel& kernel) {
  fail(Error::Kind::Compile, kernel,
       "it has no native code; compile its .sk file with skc --target=fragment,native, or run it on a device "
       "with GL (SK_DEVICE=gl)");
}

[[noreturn]] void failWithoutQuad(const program::Kernel& kernel) {
  fail(Error::Kind::Compile, kernel,
       "it has no native code in __float128; compile its .sk file with skc --quad");
}

void checkCode(const program::Kernel& kernel, RealType real) {
  if (kernel.code == nullptr) failWithoutCode(kernel);
  if (real == RealType::Quad && !hasCodeFor(*kernel.code, real)) failWithoutQuad(kernel);
}

}  // namespace

NativeDevice::NativeDevice(RealType real)
    : real_(real),
      name_(real == RealType::Float    ? "native"
            : real == RealType::Double ? "reference (native, double)"
                                       : "reference (native, __float128)") {
  constexpr std::int32_t unlimited = std::numeric_limits<std::int32_t>::max();
  limits = {.textureSize = unlimited,
            .textureLayers = 1,
            .drawBuffers = unlimited,
            .images = unlimited,
            .textureUnits = unlimited,
            .uniformComponents = unlimited,
            .elements = std::numeric_limits<std::int64_t>::max(),
            .memory = hostMemory().whole};
  static_cast<void>(levelOfCpu());  // throws where SK_CPU names no level
}

std::optional<std::int64_t> NativeDevice::availableMemory() { return hostMemory().available; }

void NativeDevice::makeCurrent() {
  throw Error(
      fmt::format("'{}' has no GL context to make current; draw in that of a device with GL (SK_DEVICE=gl)",
                  name_),
      Error::Kind::Device);
}

NativeDevice::~NativeDevice() {
  while (firstStream() != nullptr) {
    auto& stream = static_cast<NativeStream&>(*firstStream());
    stream.leave();
    stream.empty();
  }
}

void NativeDevice::checkProgram(const program::Kernel& kernel) { checkCode(kernel, real_); }

void NativeDevice::checkProgram(const program::Reduction& reduction) { checkCode(reduction.fold, real_); }

void NativeDevice::checkTarget(const program::Kernel& kernel, Target requested) const {
  if (requested == Target::Fragment || requested == Target::Compute) {
    fail(Error::Kind::Device, kernel,
         "its streams are on '{}', which runs native code; {} programs run on streams of a device with GL "
         "(SK_DEVICE=gl)",
         name_, requested == Target::Fragment ? "fragment" : "compute");
  }
}

std::unique_ptr<StreamState> NativeDevice::createStream(const program::Element& element, const Shape& shape,
                                                        Storage storage) {
  return std::make_unique<NativeStream>(*this, element, shape, storage);
}

void NativeDevice::startTrace(const std::string& file) {
  trace = std::make_unique<Trace>(file, name_);
  trace->setBandwidth(hostCopyBandwidth());
}

}  // namespace sk
