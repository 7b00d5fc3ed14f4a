// SPDX-License-Identifier: MIT
//
// Lists the entries in the order of the report, and describes the processor that runs native code.

#include "info/device_info.hpp"

#include <chrono>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>

#include "support/cache_folder.hpp"

namespace sk_tool {

bool isNative(const sk::Device& device) { return device.profile() == "native"; }

sk::DeviceOptions optionsOf(const sk::Device& device) {
  return {.device = device.name(), .profile = std::string(device.profile())};
}

Json describe(const sk::Device& device) {
  Json info;
  info["name"] = device.name();
  info["profile"] = device.profile();
  if (isNative(device)) {
    info["processor"] = probeProcessor();
    return info;
  }
  info["driver"] = device.driver();
  info["shading_language"] = device.shadingLanguage();
  info["software"] = device.isSoftware();
  const sk::DeviceLimits& limits = device.limits();
  info["limits"] = {{"texture_side", limits.textureSize},   {"texture_layers", limits.textureLayers},
                    {"draw_buffers", limits.drawBuffers},   {"images", limits.images},
                    {"texture_units", limits.textureUnits}, {"uniform_components", limits.uniformComponents}};
  return info;
}

void addTraits(const sk::Device& device, Json& info) {
  info["kind"] = device.kind();
  info["traits"] = Json::array();
  for (const sk::DeviceTrait& trait : device.traits()) {
    info["traits"].push_back(
        {{"name", trait.name}, {"value", trait.value}, {"meaning", trait.meaning}, {"reason", trait.reason}});
  }
}

void measure(sk::Device& device, Json& info) {
  const auto start = std::chrono::steady_clock::now();
  const bool hasGl = !isNative(device);
  if (hasGl) info["allocates"] = probeAllocations(device);
  info["operations"] = probeOperations(device);
  info["contraction"] = probeContraction(device);
  info["own_operations"] = probeOwnOperations(device);
  info["functions"] = probeFunctions(device);
  info["special_values"] = probeSpecialValues(device);
  if (hasGl) {
    info["exact_sums"] = probeExactSums(device);
    info["half_stores"] = probeHalfStores(device);
    info["filter"] = probeFilter(device);
  }
  info["indices"] = probeIndices(device);
  info["doubles"] = probeDoubles(device);
  info["costs"] = probeCosts(device);
  info["compute_over_fragment"] = Json::object();
  for (const sk::TargetTrial& trial : device.trialTargets()) {
    info["compute_over_fragment"][std::string(trial.kernels)] = trial.computeOverFragment;
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  info["measured_in_seconds"] = std::round(10 * taken.count()) / 10;
}

std::string keyOf(const sk::Device& device) {
  std::string driver = device.driver();
  if (device.isSoftware()) driver += probeProcessor().dump();
  driver += std::to_string(device.limits().textureSize) + "," + std::to_string(device.limits().images);
  return sk::driverKey(device.name(), driver, device.profile());
}

namespace {

/// Linux's name of the processor; empty on other systems.
std::string processorName() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return {};
}

/// The processor's widest SIMD instructions for floats.
std::string simd() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) return "AVX-512";
  if (__builtin_cpu_supports("avx2")) return "AVX2";
  if (__builtin_cpu_supports("avx")) return "AVX";
  return "SSE2";
#elif defined(__aarch64__)
  return "NEON";
#else
  return "unknown";
#endif
}

}  // namespace

Json probeProcessor() {
  return {{"name", processorName()}, {"threads", std::thread::hardware_concurrency()}, {"simd", simd()}};
}

}  // namespace sk_tool
