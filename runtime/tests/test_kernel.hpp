// SPDX-License-Identifier: MIT
//
// Kernels and reductions written by hand, with the descriptors that skc would write, for tests of the
// runtime alone. They must live as long as the devices that run them: make them static.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "sk/call.hpp"
#include "sk/sk.hpp"

namespace sk::test {

/// The profiles that each test of results runs on.
inline const std::vector<std::string> profileNames{"glsl330", "essl300"};

template <class T>
program::Parameter parameter(std::string_view name, program::Role role) {
  program::Parameter result{
      .name = name, .symbol = name, .role = role, .element = &ElementTraits<T>::element()};
  return result;
}
template <class T>
program::Parameter uniform(std::string_view name) {
  return parameter<T>(name, program::Role::Uniform);
}
template <class T>
program::Parameter input(std::string_view name) {
  return parameter<T>(name, program::Role::Input);
}
template <class T>
program::Parameter output(std::string_view name) {
  return parameter<T>(name, program::Role::Output);
}
template <class T>
program::Parameter gather(std::string_view name, int rank,
                          program::Boundary boundary = program::Boundary::Clamp) {
  program::Parameter result = parameter<T>(name, program::Role::Gather);
  result.rank = static_cast<std::uint8_t>(rank);
  result.boundary = boundary;
  return result;
}
/// A scatter output to which each element writes `pushes` values.
template <class T>
program::Parameter scatter(std::string_view name, int rank, std::int32_t pushes) {
  program::Parameter result = parameter<T>(name, program::Role::Scatter);
  result.rank = static_cast<std::uint8_t>(rank);
  result.pushes = pushes;
  return result;
}
template <class T>
program::Parameter variableOutput(std::string_view name) {
  return parameter<T>(name, program::Role::VariableOutput);
}
template <class T>
program::Parameter accumulator(std::string_view name, std::string_view identity = {}) {
  program::Parameter result = parameter<T>(name, program::Role::Accumulator);
  result.identity = identity;
  return result;
}

template <class T>
Argument argumentOf(const T& value) {
  if constexpr (requires { regionOf(value); }) {
    return {nullptr, regionOf(value)};
  } else {
    return {&value, {}};
  }
}

/// A kernel whose entry function has its name, with "_" for "::". The constructor searches the body's text for what it
/// uses of each parameter. `reach` applies to every parameter.
class TestKernel {
 public:
  TestKernel(std::string_view name, std::string_view body, std::vector<program::Parameter> parameters,
             std::string_view declarations = {}, int reach = -1);
  TestKernel(const TestKernel&) = delete;
  TestKernel& operator=(const TestKernel&) = delete;

  template <class... Arguments>
  void operator()(const Arguments&... values) const {
    const std::array<Argument, sizeof...(values)> arguments{argumentOf(values)...};
    run(kernel_, arguments);
  }
  const program::Kernel& kernel() const { return kernel_; }

 private:
  std::string entry_;
  std::vector<program::Parameter> parameters_;
  std::array<std::string_view, 1> sources_{"test.sk"};
  program::Kernel kernel_;
};

/// A reduction of one input. The function with its name folds; `combine`, another function of the body, combines partial
/// results. Without `combine`, the fold combines them, too.
class TestReduction {
 public:
  TestReduction(std::string_view name, std::string_view body, std::vector<program::Parameter> parameters,
                bool seeded, std::string_view declarations = {}, std::string_view combine = {});
  TestReduction(const TestReduction&) = delete;
  TestReduction& operator=(const TestReduction&) = delete;

  template <class A, class S>
  A value(const S& stream) const {
    A result{};
    const Argument arguments[] = {argumentOf(stream), {}};
    void* const results[] = {&result};
    reduce(reduction_, arguments, results);
    return result;
  }
  template <class S, class R>
  void operator()(const S& stream, const R& result) const {
    const Argument arguments[] = {argumentOf(stream), argumentOf(result)};
    reduce(reduction_, arguments);
  }

 private:
  std::vector<program::Parameter> parameters_;
  std::array<program::Parameter, 2> combined_;
  std::array<std::string_view, 1> sources_{"test.sk"};
  program::Reduction reduction_;
};

/// r = a x + y, for floats.
const TestKernel& saxpy();
/// r = 2 x, for floats.
const TestKernel& twice();
/// The sum of floats, with identity 0.
const TestReduction& sumOfFloats();

/// Distinct bit patterns: 0, 1, 2 ... spread over all 32 bits.
std::vector<std::uint32_t> bitPatterns(std::size_t count);

/// Elements of any type, each word of them with a bit pattern of its own.
template <class T>
std::vector<T> patterned(std::size_t count) {
  const std::vector<std::uint32_t> words = bitPatterns((count * sizeof(T) + 3) / 4);
  std::vector<T> elements(count);
  if (count > 0) std::memcpy(static_cast<void*>(elements.data()), words.data(), count * sizeof(T));
  return elements;
}

template <class T>
bool haveSameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace sk::test
