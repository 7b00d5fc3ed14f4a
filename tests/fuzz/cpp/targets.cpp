// SPDX-License-Identifier: MIT
#include "cpp/targets.hpp"

#include <span>

#include "driver/native_library.hpp"
#include "native/native.hpp"
#include "sk/call.hpp"

namespace fuzz::cpp {
namespace {

Outputs runKernel(sk::Device& device, const sk::program::Kernel& kernel) {
  const sk::Shape shape(sampleCount);
  auto a = device.stream<int>(shape), r0 = device.stream<int>(shape);
  auto b = device.stream<unsigned>(shape), r1 = device.stream<unsigned>(shape);
  auto c = device.stream<float>(shape), r2 = device.stream<float>(shape);
  a.write(inputs().a);
  b.write(inputs().b);
  c.write(inputs().c);
  std::vector<sk::Argument> arguments;
  for (const sk::StreamRegion& region : {sk::regionOf(a), sk::regionOf(b), sk::regionOf(c), sk::regionOf(r0),
                                         sk::regionOf(r1), sk::regionOf(r2)})
    arguments.push_back({.region = region});
  sk::run(kernel, arguments);
  Outputs outputs{.kernel = std::string(kernel.name)};
  r0.read(std::span(outputs.r0));
  r1.read(std::span(outputs.r1));
  r2.read(std::span(outputs.r2));
  return outputs;
}

}  // namespace

const std::vector<std::string> deviceTargets = {"native", "glsl330", "glsl430", "essl300"};

NativeObject compileNative(const skc::ir::Module& module, const std::string& level) {
  std::vector<skc::native::KernelRequest> requests;
  NativeObject result;
  const skc::emit::Program program(module);
  for (const skc::emit::Unit& unit : program.units()) {
    const std::string symbol = "code_of_" + std::to_string(unit.id);
    requests.push_back({.kernel = unit.id, .symbol = symbol});
    result.symbols.push_back(symbol);
  }
  skc::native::Options options;
  if (!level.empty()) options.levels = {level};
  result.object = skc::native::compile(module, requests, skc::driver::compileLibrary, options,
                                       skc::native::Output::Object);
  return result;
}

sk::Device& Targets::device(const std::string& target) {
  const auto found = devices_.find(target);
  if (found != devices_.end()) return found->second;
  sk::DeviceOptions options;
  if (target == "native") {
    options.device = target;
  } else {
    options.profile = target;
  }
  return devices_.try_emplace(target, options).first->second;
}

std::string Targets::difference(const skc::ir::Module& module, const skc::emit::CodeOf& codeOf,
                                const std::vector<Outputs>& wanted) {
  const skc::emit::Program& program = programs_.emplace_back(module, skc::emit::Targets{}, codeOf);
  for (const std::string& target : deviceTargets) {
    if (names_.count(target) == 0) continue;
    for (const Outputs& outputs : wanted) {
      for (const skc::emit::Unit& unit : program.units()) {
        if (unit.kernel.name != outputs.kernel) continue;
        std::string wrong = cpp::difference(runKernel(device(target), unit.kernel), outputs);
        if (!wrong.empty()) return target + ": " + wrong;
      }
    }
  }
  return {};
}

void Targets::release() {
  for (auto& [name, device] : devices_) device.release();
}

}  // namespace fuzz::cpp
