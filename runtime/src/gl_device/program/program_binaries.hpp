// SPDX-License-Identifier: MIT
//
// Builds programs: from the binary that an earlier process has stored for this driver and these sources, else
// with the driver's compiler, which may compile several programs at a time.
#pragma once

#include <string>
#include <string_view>
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

}  // namespace sk
