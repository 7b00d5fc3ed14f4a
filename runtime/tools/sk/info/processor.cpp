// SPDX-License-Identifier: MIT
//
// Describes the processor that runs native code.
#include <fstream>
#include <string>
#include <thread>

#include "info/probes.hpp"

namespace sk_tool {

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
