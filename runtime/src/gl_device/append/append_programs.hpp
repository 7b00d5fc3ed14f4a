// SPDX-License-Identifier: MIT
//
// The programs for append outputs that do not contain a kernel's body: those that draw pyramids and those
// that scatter points. They are compiled on first use and kept as long as the device.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "assemble/append/histo_pyramid.hpp"
#include "assemble/append/point_program.hpp"
#include "gl/program.hpp"
#include "gl/uniform.hpp"
#include "sk/program.hpp"

namespace sk {

class GlDevice;

/// A program with integer uniforms, which are set by name. It must be bound to set them.
class AppendProgram {
 public:
  explicit AppendProgram(gl::Program&& program) : program_(std::move(program)) {}

  void set(gl::BoundState& bound, std::string_view uniform, std::int32_t value) {
    find(uniform, false).set(bound, value);
  }
  void set(gl::BoundState& bound, std::string_view uniform, const gl::Int4& value) {
    find(uniform, true).set(bound, value);
  }
  /// The uniform `sk_domain_row` of programs that draw to layers.
  gl::IntUniform& row() { return find("sk_domain_row", false); }
  const gl::Program& program() const { return program_; }

 private:
  gl::IntUniform& find(std::string_view name, bool isVector);

  gl::Program program_;
  std::deque<std::pair<std::string, gl::IntUniform>> uniforms_;  ///< a loop's commands refer to them
};

class AppendPrograms {
 public:
  explicit AppendPrograms(GlDevice& device) : device_(device) {}

  /// The program of a pyramid's level, which reads from texture unit 0. Throws sk::Error if the driver
  /// rejects it.
  AppendProgram& pyramid(const assemble::PyramidTextures& textures);
  /// The program of a step. Its texture units: 0 has the target texels of the list; the next ones have the
  /// planes of the list's values, or of the stored elements; then come the results of earlier steps. Throws
  /// sk::Error if the driver rejects it.
  AppendProgram& points(const program::Parameter& appendOutput, assemble::PointStep step,
                        const assemble::PointTextures& textures);

 private:
  using PointKey = std::tuple<const program::Parameter*, assemble::PointStep, assemble::PointTextures>;

  std::unique_ptr<AppendProgram> build(const std::string& vertexSource, const std::string& fragmentSource,
                                       std::string_view what);

  GlDevice& device_;
  std::map<assemble::PyramidTextures, std::unique_ptr<AppendProgram>> pyramids_;
  std::map<PointKey, std::unique_ptr<AppendProgram>> points_;
};

}  // namespace sk
