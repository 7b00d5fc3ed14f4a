// SPDX-License-Identifier: MIT
//
// Lists the linked .sk files. This is the program's only global state, because it records what was linked.
#include "sk/linked_file.hpp"

#include <mutex>

namespace sk::program {

namespace {

// Constant initialization makes these ready before the first stub. Libraries may be loaded on any thread.
constinit std::mutex mutex;
constinit LinkedFile* first = nullptr;

}  // namespace

LinkedFile::LinkedFile(Code code, std::span<const std::string_view> kernels,
                       std::span<const std::string_view> tables) noexcept
    : code_(code), kernels_(kernels), tables_(tables) {
  const std::lock_guard lock(mutex);
  next_ = first;
  first = this;
}

LinkedFile::~LinkedFile() {
  const std::lock_guard lock(mutex);
  LinkedFile** link = &first;
  while (*link != this) link = &(*link)->next_;
  *link = next_;
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

}  // namespace sk::program
