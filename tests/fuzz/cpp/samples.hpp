// SPDX-License-Identifier: MIT
//
// The elements that every generated kernel is called with, and what it gives for them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fuzz::cpp {

/// The parameters of every kernel, which follow its name.
constexpr std::string_view kernelParameters =
    "(int a<>, uint b<>, float c<>, out int r0<>, out uint r1<>, out float r2<>)";

/// Odd, so that native code has a remainder of lanes.
constexpr int sampleCount = 37;

struct Inputs {
  std::vector<std::int32_t> a;
  std::vector<std::uint32_t> b;
  std::vector<float> c;
};

/// The same for all kernels: corners of the types first, then random numbers. The floats are multiples of 1/4 up to 16.
const Inputs& inputs();

struct Outputs {
  std::string
      kernel;  ///< its name, and "_rank2" if its domain has two dimensions and it has parameters beside the common ones
  std::vector<std::int32_t> r0 = std::vector<std::int32_t>(sampleCount);
  std::vector<std::uint32_t> r1 = std::vector<std::uint32_t>(sampleCount);
  std::vector<float> r2 = std::vector<float>(sampleCount);
};

/// The name of a kernel in .sk, and the rank of its domain.
struct KernelName {
  std::string name;
  int rank = 1;
  bool hasOwnParameters = false;
};
KernelName nameOf(const Outputs& outputs);

/// The first difference, or "". The two zeros of a float are equal.
std::string difference(const Outputs& got, const Outputs& wanted);

/// Results of a program as text, one line for each element of each kernel, and back.
std::string written(const std::vector<Outputs>& outputs);
std::vector<Outputs> parsed(const std::string& text);

}  // namespace fuzz::cpp
