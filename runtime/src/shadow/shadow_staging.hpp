// SPDX-License-Identifier: MIT
//
// Halos of a shadowed device on their way between ranks: the reference's elements go with the device's.
#pragma once

#include <cstddef>
#include <vector>

#include "device/device_state.hpp"

namespace sk {

class ShadowDevice;

class ShadowStaging final : public Staging {
 public:
  ShadowStaging(ShadowDevice& device, Way way) : device_(device), way_(way) {}

  std::size_t bytesOf(const StreamRegion& box) const override;
  std::byte* room(std::size_t bytes) override;
  void copy(const StreamRegion& box, std::size_t offset) override;
  void flush() override;
  void wait() override {}

 private:
  struct Copy {
    StreamRegion box;
    std::size_t offset;
  };
  void take(const Copy& copy);
  void bring(const Copy& copy);

  ShadowDevice& device_;
  const Way way_;
  std::vector<std::byte> memory_;
  std::vector<Copy> copies_;
};

}  // namespace sk
