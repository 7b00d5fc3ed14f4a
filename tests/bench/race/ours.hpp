// SPDX-License-Identifier: MIT
//
// Our contenders: the devices of this machine, and the choices of a call that are worth a race of their own. A new
// target is a row in ours.cpp.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include <sk/sk.hpp>

namespace race {

struct Ours {
  std::string name;
  sk::Device* device;
  sk::CallOptions options;
  bool isNative;
};

class OurDevices {
 public:
  /// `gl`: the device of the GL contenders, as SK_DEVICE names it.
  explicit OurDevices(const std::string& gl);

  const std::vector<Ours>& contenders() const { return contenders_; }
  /// The device of the GL contenders; null where there is none.
  sk::Device* gl() const { return gl_; }
  /// The renderer of the GL contenders; empty where there is none.
  const std::string& renderer() const { return renderer_; }
  /// Who cannot take part, and why.
  const std::vector<std::string>& absent() const { return absent_; }

 private:
  std::deque<sk::Device> devices_;  // which stay where they are
  std::vector<Ours> contenders_;
  sk::Device* gl_ = nullptr;
  std::string renderer_;
  std::vector<std::string> absent_;
};

}  // namespace race
