// SPDX-License-Identifier: MIT
//
// A file holds the number of the format, a hash of the binary, and the binary: some drivers believe what they are given.
#include "program_build.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "cache_folder.hpp"
#include "gl_device.hpp"

namespace sk {

namespace {

constexpr std::string_view name = "program";
constexpr std::uintmax_t mostBytes = std::uintmax_t{64} << 20;
/// So many programs are stored before the folder is looked through.
constexpr int storedBetween = 64;

struct Head {
  std::uint32_t format;
  std::uint32_t bytes;
  std::uint64_t hash;
};

std::span<const std::byte> bytesOf(std::string_view text) { return std::as_bytes(std::span(text)); }

}  // namespace

ProgramBinaries::ProgramBinaries(const gl::Capabilities& capabilities, std::string driver)
    : driver_(std::move(driver)), formats_(capabilities.binaryFormats) {}

bool ProgramBinaries::areKept() const { return !formats_.empty() && !cacheFolder().empty(); }

gl::Program ProgramBinaries::load(std::string_view sources) const {
  const std::optional<std::string> text = readCached(name, driver_ + std::string(sources));
  Head head{};
  if (!text || text->size() < sizeof head) return {};
  std::memcpy(&head, text->data(), sizeof head);
  const std::string_view binary = std::string_view(*text).substr(sizeof head);
  const bool isKnown = std::ranges::find(formats_, head.format) != formats_.end();
  if (!isKnown || binary.size() != head.bytes || hashOf(binary) != head.hash) return {};
  return gl::Program::load(head.format, bytesOf(binary));
}

void ProgramBinaries::store(std::string_view sources, const gl::Program& program) {
  const gl::ProgramBinary binary = program.binary();
  if (binary.bytes.empty()) return;
  const std::string_view bytes(reinterpret_cast<const char*>(binary.bytes.data()), binary.bytes.size());
  const Head head{binary.format, static_cast<std::uint32_t>(bytes.size()), hashOf(bytes)};
  std::string text(sizeof head, '\0');
  std::memcpy(text.data(), &head, sizeof head);
  writeCached(name, driver_ + std::string(sources), text.append(bytes));
  if (stored_++ % storedBetween == 0) boundCached(name, mostBytes);
}

ProgramBuild::ProgramBuild(GlDevice& device, gl::ProgramSources sources)
    : sources_(std::move(sources)), isKept_(device.binaries.areKept()) {
  if (isKept_) loaded_ = device.binaries.load(key());
  if (!loaded_) pending_ = gl::PendingProgram(sources_, isKept_);
}

gl::Program ProgramBuild::finish(GlDevice& device, std::string& log) {
  const TraceScope traced(device.trace.get(), "program", "compile");
  traced.add("cache", loaded_ ? "hit" : isKept_ ? "miss" : "off");
  if (loaded_) return std::move(loaded_);
  gl::Program program = pending_.finish(log);
  if (program && isKept_) device.binaries.store(key(), program);
  return program;
}

void ProgramBuild::forget() noexcept {
  loaded_.forget();
  pending_.forget();
}

}  // namespace sk
