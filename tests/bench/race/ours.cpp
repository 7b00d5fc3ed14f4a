// SPDX-License-Identifier: MIT
#include "ours.hpp"

#include <fmt/format.h>

namespace race {
namespace {

enum class Kind { Native, Gl };

struct Row {
  const char* name;
  Kind kind;
  sk::CallOptions options;
};

const Row rows[] = {
    {"native", Kind::Native, {}},
    {"fragment", Kind::Gl, {.target = sk::Target::Fragment}},
    {"compute", Kind::Gl, {.target = sk::Target::Compute}},
};

}  // namespace

OurDevices::OurDevices(const std::string& gl) {
  sk::Device* native = &devices_.emplace_back("native");
  std::string why;
  try {
    gl_ = &devices_.emplace_back(gl);
    renderer_ = gl_->name();
  } catch (const sk::Error& error) {
    why = error.what();
  }
  for (const Row& row : rows) {
    sk::Device* device = row.kind == Kind::Native ? native : gl_;
    if (device != nullptr) {
      contenders_.push_back({row.name, device, row.options, row.kind == Kind::Native});
    } else {
      absent_.push_back(fmt::format("{}: {}", row.name, why));
    }
  }
}

}  // namespace race
