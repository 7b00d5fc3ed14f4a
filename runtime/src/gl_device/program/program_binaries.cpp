// SPDX-License-Identifier: MIT
//
// A file holds the number of the binary's format, then the binary. Some drivers do not verify binaries, so
// the cache folder must detect corrupted files.
#include "gl_device/program/program_binaries.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "gl_device/gl_device.hpp"
#include "support/cache_folder.hpp"

namespace sk {

namespace {

constexpr std::string_view name = "program";

std::span<const std::byte> binaryIn(std::string_view text) { return std::as_bytes(std::span(text)); }

}  // namespace

ProgramBinaries::ProgramBinaries(const CacheFolder& cache, const gl::Capabilities& capabilities,
                                 std::string driver)
    : cache_(cache), driver_(std::move(driver)), formats_(capabilities.binaryFormats) {}

bool ProgramBinaries::areKept() const { return !formats_.empty() && !cache_.path().empty(); }

gl::Program ProgramBinaries::load(gl::BoundState& bound, std::string_view sources) const {
  const std::optional<std::string> text = cache_.read(name, driver_ + std::string(sources));
  std::uint32_t format = 0;
  if (!text || text->size() <= sizeof format) return {};
  std::memcpy(&format, text->data(), sizeof format);
  if (std::ranges::find(formats_, format) == formats_.end()) return {};
  return gl::Program::load(bound, format, binaryIn(std::string_view(*text).substr(sizeof format)));
}

void ProgramBinaries::store(std::string_view sources, const gl::Program& program) const {
  const gl::ProgramBinary binary = program.binary();
  if (binary.bytes.empty()) return;
  const std::uint32_t format = binary.format;
  std::string text(sizeof format, '\0');
  std::memcpy(text.data(), &format, sizeof format);
  text.append(reinterpret_cast<const char*>(binary.bytes.data()), binary.bytes.size());
  cache_.write(name, driver_ + std::string(sources), text);
}

ProgramBuild::ProgramBuild(GlDevice& device, gl::ProgramSources sources)
    : sources_(std::move(sources)), isKept_(device.programs().binaries().areKept()) {
  if (isKept_) loaded_ = device.programs().binaries().load(device.bound(), key());
  if (!loaded_) pending_ = gl::PendingProgram(device.bound(), sources_, isKept_);
}

gl::Program ProgramBuild::finish(GlDevice& device, std::string& log) {
  const TraceScope traced(device.trace.get(), "program", "compile");
  traced.add("cache", loaded_ ? "hit" : isKept_ ? "miss" : "off");
  if (loaded_) return std::move(loaded_);
  gl::Program program = pending_.finish(log);
  if (program && isKept_) device.programs().binaries().store(key(), program);
  return program;
}

}  // namespace sk
