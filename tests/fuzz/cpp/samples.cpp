// SPDX-License-Identifier: MIT
#include "cpp/samples.hpp"

#include <cstddef>
#include <sstream>

#include <fmt/format.h>

#include "random.hpp"

namespace fuzz::cpp {
namespace {

Inputs makeInputs() {
  Inputs made;
  Random random(20260, 42);
  const std::vector<std::int32_t> ints = {
      0, 1, -1, 2, 3, 7, -8, 100, 255, -256, 65535, 2147483647, -2147483647 - 1};
  for (int i = 0; i < sampleCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    made.a.push_back(index < ints.size() ? ints[index] : static_cast<std::int32_t>(random.next()));
    made.b.push_back(i % 4 == 0 ? static_cast<std::uint32_t>(i) : static_cast<std::uint32_t>(random.next()));
    made.c.push_back(static_cast<float>(random.between(-64, 64)) / 4);
  }
  return made;
}

}  // namespace

const Inputs& inputs() {
  static const Inputs made = makeInputs();
  return made;
}

KernelName nameOf(const Outputs& outputs) {
  const std::size_t at = outputs.kernel.rfind("_rank");
  if (at == std::string::npos) return {outputs.kernel};
  return {outputs.kernel.substr(0, at), outputs.kernel.back() - '0', true};
}

std::string difference(const Outputs& got, const Outputs& wanted) {
  for (std::size_t i = 0; i < sampleCount; ++i) {
    const Inputs& in = inputs();
    const std::string where =
        fmt::format("{} of a = {}, b = {}u, c = {}: ", wanted.kernel, in.a[i], in.b[i], in.c[i]);
    if (got.r0[i] != wanted.r0[i])
      return fmt::format("{}r0 is {}, in C++ {}", where, got.r0[i], wanted.r0[i]);
    if (got.r1[i] != wanted.r1[i])
      return fmt::format("{}r1 is {}, in C++ {}", where, got.r1[i], wanted.r1[i]);
    if (got.r2[i] != wanted.r2[i])
      return fmt::format("{}r2 is {}, in C++ {}", where, got.r2[i], wanted.r2[i]);
  }
  return {};
}

std::string written(const std::vector<Outputs>& outputs) {
  std::string text;
  for (const Outputs& output : outputs) {
    text += output.kernel + "\n";
    for (std::size_t i = 0; i < sampleCount; ++i)
      text += fmt::format("{} {} {}\n", output.r0[i], output.r1[i], output.r2[i] == 0 ? 0 : output.r2[i]);
  }
  return text;
}

std::vector<Outputs> parsed(const std::string& text) {
  std::vector<Outputs> all;
  std::istringstream in(text);
  for (std::string name; in >> name;) {
    Outputs& outputs = all.emplace_back(Outputs{.kernel = name});
    for (std::size_t i = 0; i < sampleCount; ++i) in >> outputs.r0[i] >> outputs.r1[i] >> outputs.r2[i];
  }
  return all;
}

}  // namespace fuzz::cpp
