// SPDX-License-Identifier: MIT
#include "gl_device/append/append_programs.hpp"

#include <fmt/format.h>

#include "assemble/append/scatter_programs.hpp"
#include "assemble/assemble.hpp"
#include "gl_device/gl_programs.hpp"

namespace sk {

using assemble::PointStep;

IntegerProgram& AppendPrograms::pyramid(const assemble::PyramidTextures& textures) {
  std::unique_ptr<IntegerProgram>& cached = pyramids_[textures];
  if (!cached) {
    auto appendProgram = owner_.build(
        {assemble::vertexProgram(owner_.profile()), assemble::pyramidProgram(owner_.profile(), textures)},
        "the program of sums of counts");
    appendProgram->program().setSampler("sk_below", 0);
    cached = std::move(appendProgram);
  }
  return *cached;
}

void AppendPrograms::forgetUnloaded() {
  if (!unloads_.hasChanged()) return;
  const auto isUnloaded = [](const auto& entry) {
    return !program::LinkedFile::isLoaded(entry.second.object);
  };
  std::erase_if(points_, isUnloaded);
  std::erase_if(records_, isUnloaded);
}

IntegerProgram& AppendPrograms::points(const program::Parameter& appendOutput, PointStep step,
                                       const assemble::PointTextures& textures) {
  forgetUnloaded();
  Kept& cached = points_[{&appendOutput, step, textures}];
  if (!cached.program) {
    const std::string vertexSource = assemble::hasPoints(step)
                                         ? assemble::pointVertexProgram(owner_.profile(), textures)
                                         : assemble::vertexProgram(owner_.profile());
    auto appendProgram =
        owner_.build({vertexSource, assemble::pointProgram(owner_.profile(), appendOutput, step, textures)},
                     fmt::format("the program of {}", appendOutput.name));
    const gl::Program& program = appendProgram->program();
    int unit = 0;
    program.setSampler("sk_targets", unit++);
    for (std::size_t plane = 0; plane < appendOutput.element->fields.size(); ++plane) {
      program.setSampler(assemble::samplerName(appendOutput, plane), unit++);
    }
    for (const char* name : {"sk_limbs0", "sk_limbs1", "sk_limbs2", "sk_limbs3"}) {
      program.setSampler(name, unit++);
    }
    unit -= 4;
    for (const char* name : {"sk_upper", "sk_lower"}) {
      program.setSampler(name, unit++);
    }
    cached = {std::move(appendProgram), program::LinkedFile::objectOf(&appendOutput)};
  }
  return *cached.program;
}

IntegerProgram& AppendPrograms::records(const program::Parameter& scatter, bool isCounted) {
  forgetUnloaded();
  Kept& cached = records_[{&scatter, isCounted}];
  if (!cached.program) {
    auto program = owner_.build({{}, assemble::recordProgram(owner_.computeProfile(), scatter, isCounted)},
                                fmt::format("the program of {}", scatter.name));
    int unit = 0;
    for (const char* name : {"sk_keys", "sk_count", "sk_values", "sk_elements"})
      program->program().setSampler(name, unit++);
    cached = {std::move(program), program::LinkedFile::objectOf(&scatter)};
  }
  return *cached.program;
}

}  // namespace sk
