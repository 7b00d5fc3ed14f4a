// SPDX-License-Identifier: MIT
#include "native/entries.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <string_view>
#include <tuple>

#include "call/check_call.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

using native::Code;
using native::Entry;
using native::EntryKind;
using native::Level;
using native::levelOfHardware;

std::span<const Entry> entriesOf(const Code& code) { return {code.entries, code.entryCount}; }

bool serves(const Entry& entry, EntryKind kind, RealType real) {
  return entry.kind == kind && static_cast<std::uint8_t>(entry.real) == static_cast<std::uint8_t>(real);
}

std::string_view nameOf(Level level) {
  switch (level) {
    case Level::Base: return "x86-64";
    case Level::V3: return "x86-64-v3";
    case Level::V4: break;
  }
  return "x86-64-v4";
}

std::string_view nameOf(EntryKind kind) {
  switch (kind) {
    case EntryKind::Run: return "computes it";
    case EntryKind::RunRows: return "computes several rows";
    case EntryKind::Fold: return "folds elements";
    case EntryKind::Combine: return "combines partial results";
    case EntryKind::Identity: return "gives its identities";
    case EntryKind::Scan: return "scans elements";
    case EntryKind::FoldRows:
    case EntryKind::FoldFloatRows: return "folds rows of different lengths";
    case EntryKind::Apply: return "stores what it scatters";
    case EntryKind::Borders: break;
  }
  return "gives the borders of its gathers";
}

std::string_view nameOf(RealType real) {
  return real == RealType::Float ? "float" : real == RealType::Double ? "double" : "__float128";
}

[[noreturn]] void failWithoutEntry(const program::Kernel& kernel, EntryKind kind, RealType real) {
  const Entry* lowest = nullptr;
  for (const Entry& entry : entriesOf(*kernel.code)) {
    if (serves(entry, kind, real) && (lowest == nullptr || entry.level < lowest->level)) lowest = &entry;
  }
  if (lowest == nullptr) {
    fail(Error::Kind::Compile, kernel, "its native code has no function that {} in {}", nameOf(kind),
         nameOf(real));
  }
  fail(Error::Kind::Compile, kernel,
       "its native code was compiled for {} and later CPUs alone, which this one is not (or SK_CPU says so); "
       "compile its .sk file with skc --levels=x86-64,...",
       nameOf(lowest->level));
}

}  // namespace

Level levelNamed(std::string_view name) {
  for (const Level level : {Level::Base, Level::V3, Level::V4}) {
    if (name == nameOf(level)) return level;
  }
  throw Error(
      fmt::format("there is no level '{}' of the CPU; choose x86-64, x86-64-v3 or x86-64-v4 (SK_CPU)", name),
      Error::Kind::Device);
}

Level levelOfCpu() {
  static const Level level = [] {
    const char* const most = std::getenv("SK_CPU");
    return most == nullptr ? levelOfHardware() : std::min(levelNamed(most), levelOfHardware());
  }();
  return level;
}

const Entry* findEntry(const Code& code, EntryKind kind, const CodeChoice& choice, Level level) {
  const auto rank = [](const Entry& entry) { return std::tuple(entry.isContracted, entry.level); };
  const Entry* best = nullptr;
  for (const Entry& entry : entriesOf(code)) {
    if (!serves(entry, kind, choice.real) || entry.level > level) continue;
    if (entry.isContracted != 0 && !choice.mayContract) continue;
    if (best == nullptr || rank(*best) < rank(entry)) best = &entry;
  }
  return best;
}

bool hasCodeFor(const Code& code, RealType real) {
  return std::ranges::any_of(entriesOf(code), [&](const Entry& entry) {
    return serves(entry, EntryKind::Run, real) || serves(entry, EntryKind::Fold, real);
  });
}

const Entry& entryOf(const program::Kernel& kernel, EntryKind kind, const CodeChoice& choice, Level level) {
  if (kernel.code->version != Code::currentVersion) {
    fail(Error::Kind::Compile, kernel,
         "its native code is of version {}, but this runtime runs version {}; compile its .sk file with the "
         "skc that belongs to the runtime",
         kernel.code->version, Code::currentVersion);
  }
  const Entry* entry = findEntry(*kernel.code, kind, choice, level);
  if (entry == nullptr) failWithoutEntry(kernel, kind, choice.real);
  return *entry;
}

}  // namespace sk
