// SPDX-License-Identifier: MIT
#include "awake.hpp"

#include <chrono>
#include <cstddef>
#include <vector>

#include "programs/stencils.sk.hpp"

namespace race {

/// A stencil that takes a large GPU some ten microseconds.
struct Awake::Load {
  explicit Load(sk::Device& on)
      : device(on), from(on.stream<float>({2048, 2048})), to(on.stream<float>({2048, 2048})) {
    from.write(std::vector<float>(static_cast<std::size_t>(from.size()), 1.0f));
  }

  sk::Device& device;
  sk::Stream<float> from, to;
};

Awake::Awake(sk::Device* device) {
  if (device != nullptr && !device->isSoftware()) load_ = std::make_unique<Load>(*device);
}
Awake::~Awake() = default;

void Awake::work(double seconds) const {
  if (!load_) return;
  constexpr int callsAtOnce = 100;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
    for (int call = 0; call < callsAtOnce; ++call) kernels::heat(0.1f, load_->from, load_->to);
    load_->device.finish();
  }
}

}  // namespace race
