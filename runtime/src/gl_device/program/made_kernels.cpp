// SPDX-License-Identifier: MIT
#include "gl_device/program/made_kernels.hpp"

#include <utility>

#include "gl_device/gl_programs.hpp"

namespace sk {

const program::Element& MadeKernel::own(const program::Element& element) {
  std::vector<program::Field>& fields = fields_.emplace_back(element.fields.begin(), element.fields.end());
  for (program::Field& field : fields) field.path = own(field.path);
  return elements_.emplace_back(program::Element{own(element.name), own(element.glsl), element.size, fields});
}

std::shared_ptr<const MadeKernel> MadeKernels::keep(std::shared_ptr<const MadeKernel> made) {
  auto found = kernels_.find(made->body);
  if (found == kernels_.end()) {
    makeRoom();
    const std::string_view body = made->body;
    found = kernels_.emplace(body, Kept{std::move(made)}).first;
  }
  found->second.used = ++clock_;
  return found->second.kernel;
}

// A loop may hold more kernels than are kept otherwise.
void MadeKernels::makeRoom() {
  while (kernels_.size() >= most_) {
    auto oldest = kernels_.end();
    for (auto kept = kernels_.begin(); kept != kernels_.end(); ++kept) {
      if (kept->second.kernel.use_count() > 1) continue;
      if (oldest == kernels_.end() || kept->second.used < oldest->second.used) oldest = kept;
    }
    if (oldest == kernels_.end()) return;
    owner_.forget(oldest->second.kernel->kernel);
    kernels_.erase(oldest);
  }
}

}  // namespace sk
