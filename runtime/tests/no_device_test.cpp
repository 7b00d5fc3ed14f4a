// SPDX-License-Identifier: MIT
//
// Opens a device in the hostile environment that CTest sets, and checks the result:
//   no_device_test fails TEXT...     expects an sk::Error whose message contains every TEXT
//   no_device_test opens PROFILE     expects a device of that profile, on which a stream works
// Exit status: 0 if so; 1 after printing what happened if not; 77 (skipped) if a device opens that should not, but its
// driver is not Mesa, which Mesa's variables do not affect.
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include "sk/sk.hpp"

namespace {

constexpr int skipped = 77;

int checkOpened(sk::Device& device, std::string_view expected, std::string_view profile) {
  if (expected == "fails") {
    const bool isMesa = device.isSoftware() || device.name().find("Mesa") != std::string::npos;
    std::printf("%sa device was opened: %s, %s\n", isMesa ? "" : "skipped: ", device.name().c_str(),
                device.profile().data());
    return isMesa ? 1 : skipped;
  }
  auto stream = device.stream<float>(3);
  stream.write(std::vector<float>{1, 2, 3});
  const bool works = stream.read() == std::vector<float>{1, 2, 3} && device.profile() == profile;
  std::printf("%s, %s\n", device.name().c_str(), device.profile().data());
  return works ? 0 : 1;
}

int checkFailed(const sk::Error& error, std::string_view expected, std::vector<std::string_view> texts) {
  std::printf("%s\n", error.what());
  for (const std::string_view text : texts) {
    if (std::string_view(error.what()).find(text) == std::string_view::npos) {
      std::printf("the message lacks '%s'\n", text.data());
      return 1;
    }
  }
  return expected == "fails" ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::printf("usage: no_device_test fails TEXT... | opens PROFILE\n");
    return 1;
  }
  try {
    sk::Device device;
    return checkOpened(device, words[1], words[2]);
  } catch (const sk::Error& error) {
    return checkFailed(error, words[1], {words + 2, words + count});
  }
}
