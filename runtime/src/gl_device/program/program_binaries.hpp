// SPDX-License-Identifier: MIT
//
// From sources to a program: the binary that an earlier process has kept for this driver and these sources, else the
// driver's compiler, which may work at several programs at a time until their ends are asked for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gl/capabilities.hpp"
#include "gl/program.hpp"

namespace sk {

class CacheFolder;
class GlDevice;

/// The binaries of one driver in the cache folder (support/cache_folder.hpp). What is broken, or what the driver refuses, is as
/// good as not there.
class ProgramBinaries {
 public:
  /// `driver`: everything that binaries depend on beside the sources. The folder must outlive this.
  ProgramBinaries(const CacheFolder& cache, const gl::Capabilities& capabilities, std::string driver);

  /// Whether the driver gives binaries, and there is a folder for them.
  bool areKept() const;
  gl::Program load(gl::BoundState& bound, std::string_view sources) const;
  void store(std::string_view sources, const gl::Program& program) const;

 private:
  const CacheFolder& cache_;
  std::string driver_;
  std::vector<GLenum> formats_;  ///< that the driver takes
};

class ProgramBuild {
 public:
  /// Begins. Waits for no compiler.
  ProgramBuild(GlDevice& device, gl::ProgramSources sources);

  /// Waits. Where the driver refuses, the result is empty and `log` has its words.
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
