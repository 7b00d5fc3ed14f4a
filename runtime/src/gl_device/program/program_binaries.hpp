// SPDX-License-Identifier: MIT
//
// Builds programs: from the binary that an earlier process has stored for this driver and these sources, else
// with the driver's compiler, which may compile several programs at a time.
//
// A program that the runtime wrote for a step of its own, such as one of an append output or of a sort.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gl/capabilities.hpp"
#include "gl/program.hpp"

namespace sk {

class CacheFolder;
class GlDevice;

/// The binaries of one driver in the cache folder (support/cache_folder.hpp). Binaries that are corrupted, or
/// that the driver rejects, count as missing.
class ProgramBinaries {
 public:
  /// `driver` identifies everything that binaries depend on besides the sources. The folder must outlive this
  /// object.
  ProgramBinaries(const CacheFolder& cache, const gl::Capabilities& capabilities, std::string driver);

  /// Whether the driver supports binaries and there is a cache folder.
  bool areKept() const;
  /// Empty if there is no usable binary.
  gl::Program load(gl::BoundState& bound, std::string_view sources) const;
  void store(std::string_view sources, const gl::Program& program) const;

 private:
  const CacheFolder& cache_;
  std::string driver_;
  std::vector<GLenum> formats_;  ///< formats that the driver supports
};

/// A program that is being built.
class ProgramBuild {
 public:
  /// Loads the binary or starts the compiler, without waiting for it.
  ProgramBuild(GlDevice& device, gl::ProgramSources sources);

  /// Waits. If the driver rejects the program, the result is empty and `log` has its messages.
  gl::Program finish(GlDevice& device, std::string& log);
  const gl::ProgramSources& sources() const { return sources_; }

 private:
  std::string key() const { return '\n' + sources_.vertex + '\n' + sources_.main; }

  gl::ProgramSources sources_;
  bool isKept_;
  gl::Program loaded_;
  gl::PendingProgram pending_;
};

/// A program with integer uniforms, which are set by name. It must be bound to set them.
class IntegerProgram {
 public:
  explicit IntegerProgram(gl::Program&& program) : program_(std::move(program)) {}

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
  gl::IntUniform& find(std::string_view name, bool isVector) {
    const auto found =
        std::ranges::find_if(uniforms_, [&](const auto& known) { return known.first == name; });
    if (found != uniforms_.end()) return found->second;
    const std::string owned(name);
    return uniforms_.emplace_back(owned, gl::IntUniform(program_.location(owned), isVector)).second;
  }

  gl::Program program_;
  std::deque<std::pair<std::string, gl::IntUniform>> uniforms_;  ///< a loop's commands refer to them
};

}  // namespace sk
