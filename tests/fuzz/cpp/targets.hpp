// SPDX-License-Identifier: MIT
//
// Runs what skc makes of a program: as native code, and in GL.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cpp/samples.hpp"
#include "ir/ir.hpp"
#include "program/descriptors.hpp"
#include "sk/sk.hpp"

namespace fuzz::cpp {

/// The names of the targets that run in this process: native, glsl330, glsl430, essl300, essl310.
extern const std::vector<std::string> deviceTargets;

/// An object file with the native code of a module's kernels, and the symbols of their codes, in the order of
/// emit::Program::units().
struct NativeObject {
  std::string object;
  std::vector<std::string> symbols;
};
NativeObject compileNative(const skc::ir::Module& module, const std::string& level);

/// The devices of a process, and the programs that they have run: devices identify programs by their addresses.
class Targets {
 public:
  explicit Targets(std::set<std::string> names) : names_(std::move(names)) {}
  bool has(const char* name) const { return names_.count(name) != 0; }

  /// The first difference to what is wanted, with the target's name, or "".
  std::string difference(const skc::ir::Module& module, const skc::emit::CodeOf& codeOf,
                         const std::vector<Outputs>& wanted);
  /// Lets another thread use the devices.
  void release();

 private:
  sk::Device& device(const std::string& target);

  std::set<std::string> names_;
  std::map<std::string, sk::Device> devices_;
  std::deque<skc::emit::Program> programs_;
};

}  // namespace fuzz::cpp
