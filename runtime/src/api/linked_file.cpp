// SPDX-License-Identifier: MIT
//
// Lists the linked .sk files. This is the program's only global state, because it records what was linked.
#include "sk/linked_file.hpp"

#include <atomic>
#include <mutex>

#include <dlfcn.h>

namespace sk::program {

namespace {

// Constant initialization makes these ready before the first stub. Libraries may be loaded on any thread.
constinit std::mutex mutex;
constinit LinkedFile* first = nullptr;
constinit std::uint64_t loads = 0;
constinit std::atomic<std::uint64_t> unloadCount = 0;

/// Where the object is loaded that has this address; null if it is in none. Takes the loader's lock, which a thread that runs
/// constructors of a library holds already: `mutex` must be free.
const void* baseOf(const void* address) noexcept {
  Dl_info info{};
  return ::dladdr(address, &info) != 0 ? info.dli_fbase : nullptr;
}

}  // namespace

LinkedFile::LinkedFile(Code code, std::span<const std::string_view> kernels,
                       std::span<const std::string_view> tables) noexcept
    : code_(code), kernels_(kernels), tables_(tables), base_(baseOf(this)) {
  const std::lock_guard lock(mutex);
  number_ = ++loads;
  next_ = first;
  first = this;
}

LinkedFile::~LinkedFile() {
  const std::lock_guard lock(mutex);
  LinkedFile** link = &first;
  while (*link != this) link = &(*link)->next_;
  *link = next_;
  unloadCount.fetch_add(1, std::memory_order_release);
}

LinkedFile::Code LinkedFile::ofAll() noexcept {
  const std::lock_guard lock(mutex);
  Code all{.glsl = true, .native = first != nullptr};
  for (const LinkedFile* file = first; file != nullptr; file = file->next_) {
    all.glsl = all.glsl && file->code_.glsl;
    all.native = all.native && file->code_.native;
  }
  return all;
}

LinkedFile::Names LinkedFile::namesOfAll() {
  const std::lock_guard lock(mutex);
  Names all;
  for (const LinkedFile* file = first; file != nullptr; file = file->next_) {
    all.kernels.insert(all.kernels.end(), file->kernels_.begin(), file->kernels_.end());
    all.tables.insert(all.tables.end(), file->tables_.begin(), file->tables_.end());
  }
  return all;
}

// The number of an object is that of its oldest file: its files are loaded, and unloaded, together.
std::uint64_t LinkedFile::objectOf(const void* descriptor) noexcept {
  const void* const base = baseOf(descriptor);
  if (base == nullptr) return 0;
  const std::lock_guard lock(mutex);
  std::uint64_t oldest = 0;
  for (const LinkedFile* file = first; file != nullptr; file = file->next_) {
    if (file->base_ == base && (oldest == 0 || file->number_ < oldest)) oldest = file->number_;
  }
  return oldest;
}

bool LinkedFile::isLoaded(std::uint64_t object) noexcept {
  const std::lock_guard lock(mutex);
  const LinkedFile* file = first;
  while (file != nullptr && file->number_ != object) file = file->next_;
  return object == 0 || file != nullptr;
}

std::uint64_t LinkedFile::unloads() noexcept { return unloadCount.load(std::memory_order_acquire); }

}  // namespace sk::program
