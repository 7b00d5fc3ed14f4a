// SPDX-License-Identifier: MIT
//
// The programs for append outputs that do not contain a kernel's body: those that draw pyramids and those
// that scatter points. They are compiled on first use and kept as long as the device, or as the library with the kernel is loaded.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "assemble/append/histo_pyramid.hpp"
#include "assemble/append/scatter_programs.hpp"
#include "device/unload_watch.hpp"
#include "gl_device/program/program_binaries.hpp"
#include "sk/program.hpp"

namespace sk {

class GlPrograms;

class AppendPrograms {
 public:
  explicit AppendPrograms(GlPrograms& owner) : owner_(owner) {}

  /// The program of a pyramid's level, which reads from texture unit 0. Throws sk::Error if the driver
  /// rejects it.
  IntegerProgram& pyramid(const assemble::PyramidTextures& textures);
  /// The program of a step. Its texture units: 0 has the target texels of the list; the next ones have the
  /// planes of the list's values, or of the stored elements; then come the results of earlier steps. Throws
  /// sk::Error if the driver rejects it.
  IntegerProgram& points(const program::Parameter& appendOutput, assemble::PointStep step,
                         const assemble::PointTextures& textures);
  /// The program that combines the records of a scatter output (assemble/append/scatter_programs.hpp). Its texture units: 0 sk_keys, 1
  /// sk_count, 2 sk_values. Throws sk::Error if the driver rejects it.
  IntegerProgram& records(const program::Parameter& scatter, bool isCounted);

 private:
  using PointKey = std::tuple<const program::Parameter*, assemble::PointStep, assemble::PointTextures>;

  /// A program, and which loaded object has its parameter (LinkedFile::objectOf()).
  struct Kept {
    std::unique_ptr<IntegerProgram> program;
    std::uint64_t object = 0;
  };

  void forgetUnloaded();

  GlPrograms& owner_;
  std::map<assemble::PyramidTextures, std::unique_ptr<IntegerProgram>> pyramids_;
  std::map<PointKey, Kept> points_;
  std::map<std::pair<const program::Parameter*, bool>, Kept> records_;
  UnloadWatch unloads_;
};

}  // namespace sk
