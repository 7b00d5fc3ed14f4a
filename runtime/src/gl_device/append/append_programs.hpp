// SPDX-License-Identifier: MIT
//
// The programs of a device that belong to no kernel's body: sums of counts, and points of scatter outputs.
// They are made when first needed and kept until the device ends.
#pragma once

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

/// A program whose uniforms are integers, named as they are set. It must be bound then.
class StepProgram {
 public:
  explicit StepProgram(gl::Program&& program) : program_(std::move(program)) {}

  void set(std::string_view uniform, std::int32_t value) { find(uniform, false).set(value); }
  void set(std::string_view uniform, const gl::Int4& value) { find(uniform, true).set(value); }
  /// `sk_domain_row`, of those that draw to layers.
  gl::IntUniform& row() { return find("sk_domain_row", false); }
  const gl::Program& program() const { return program_; }

 private:
  gl::IntUniform& find(std::string_view name, bool isVector);

  gl::Program program_;
  std::vector<std::pair<std::string, gl::IntUniform>> uniforms_;
};

class AppendPrograms {
 public:
  explicit AppendPrograms(GlDevice& device) : device_(device) {}

  /// Reads from texture unit 0.
  StepProgram& tree(const assemble::PyramidTextures& textures);
  /// Units: 0 the texels of the list, then the values, or elements, plane by plane, then what earlier
  /// steps have drawn.
  StepProgram& points(const program::Parameter& appendOutput, assemble::PointStep step,
                      const assemble::PointTextures& textures);

 private:
  using PointKey = std::tuple<const program::Parameter*, assemble::PointStep, assemble::PointTextures>;

  std::unique_ptr<StepProgram> build(const std::string& vertexSource, const std::string& fragmentSource,
                                     std::string_view what);

  GlDevice& device_;
  std::map<assemble::PyramidTextures, std::unique_ptr<StepProgram>> trees_;
  std::map<PointKey, std::unique_ptr<StepProgram>> points_;
};

}  // namespace sk
