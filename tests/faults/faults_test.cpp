// SPDX-License-Identifier: MIT
//
// Injects every fault. After each, the call has thrown the right kind of sk::Error or none; each stream has its elements
// from before or after the call, or is marked as lost; the device still works; and no GL object is left over.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>

#include <catch2/catch.hpp>

#include "faults.hpp"
#include "scene.hpp"
#include "sk/sk.hpp"

using namespace faults;
using ErrorKind = sk::Error::Kind;

namespace {

const bool areInstalled = [] {
  install();
  return true;
}();

/// The error that a call throws, if any.
std::optional<sk::Error> errorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const sk::Error& error) {
    return error;
  }
  return std::nullopt;
}

bool mayThrow(Kind fault, ErrorKind thrown) {
  switch (fault) {
    case Kind::Program: return thrown == ErrorKind::Compile || thrown == ErrorKind::Memory;
    case Kind::Framebuffer: return thrown == ErrorKind::Device;
    case Kind::Context: return thrown == ErrorKind::Lost;
    case Kind::Allocation:
    case Kind::Mapping:
    case Kind::Fence:
    case Kind::Command:
    case Kind::Host:
    case Kind::HostOfAnyThread: break;
    case Kind::File:
    case Kind::Thread: return false;  // the runtime goes on without a cache, and with fewer threads
  }
  return thrown == ErrorKind::Memory;
}

/// The device under test, and one where nothing fails, which gives the expected elements.
struct Pair {
  sk::Device& device;
  sk::Device& reference;
};

/// Tries all faults of a kind in one call.
class FaultTest {
 public:
  FaultTest(const Pair& pair, const Scenario& scenario, Kind kind, bool isLasting, std::int64_t& size)
      : pair_(pair), scenario_(scenario), kind_(kind), isLasting_(isLasting), size_(size) {}

  void run() {
    while (tryNext()) REQUIRE(faults < 2000);
  }

  long faults = 0, thrown = 0, lost = 0;

 private:
  /// Whether each try needs streams of a new size, so that their textures and framebuffers have to be made.
  bool needsNewSizes() const { return kind_ == Kind::Allocation || kind_ == Kind::Framebuffer; }
  /// Whether the call must not succeed between faults: making its programs can fail only until they exist.
  bool staysCold() const { return kind_ == Kind::Program || (kind_ == Kind::Host && !isLasting_); }

  void setUp() {
    if (scene_ && !needsNewSizes()) {
      scene_->reset();
    } else {
      scene_.emplace(pair_.device, size_);
      Scene other(pair_.reference, size_++);
      before_ = other.elements();
      scenario_.call(other);
      after_ = other.elements();
    }
    pair_.device.finish();  // so that no error of the driver comes from the writes above
  }

  /// Names the streams with wrong elements. After an error, a stream must have its elements from before the call, or be
  /// lost if the call writes it; after success, it must have the elements that the call gives. If the error came late,
  /// after the call, so may streams that it had finished before.
  std::string inconsistentStreams(const Scene::Elements& found, bool hasThrown, bool isLate) const {
    std::string inconsistent;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const bool mayBeLost = hasThrown && (scenario_.moves || before_[i] != after_[i]);
      const auto& expected = hasThrown ? before_[i] : after_[i];
      const bool isFinished = isLate && found[i] == after_[i];
      if (found[i] ? found[i] != expected && !isFinished : !mayBeLost)
        inconsistent += " stream " + std::to_string(i);
    }
    return inconsistent;
  }

  /// Whether an error of exhausted memory begins with the operation, unless there is no memory for its text either.
  bool namesOperation(const sk::Error& error) const {
    if (error.kind() != ErrorKind::Memory) return true;
    const std::string text = error.what();
    const bool isOfHost = kind_ == Kind::Host || kind_ == Kind::HostOfAnyThread;
    if (isOfHost && isLasting_ && text == "there is not enough host memory") return true;
    return std::ranges::any_of(scenario_.operations,
                               [&](const std::string& name) { return text.starts_with(name + ": "); });
  }

  /// Tries the next fault. False if there is none.
  bool tryNext() {
    INFO(scenario_.name << ": " << nameOf(kind_) << " " << number_ << (isLasting_ ? " and all after" : ""));
    setUp();
    std::optional<sk::Error> error;
    bool isLate = false;
    {
      const Fault fault(kind_, number_, isLasting_);
      error = errorOf([&] { scenario_.call(*scene_); });
      isLate = !error;
      if (!error)
        error =
            errorOf([&] { pair_.device.finish(); });  // reports errors of the driver that are still pending
      if (!fault.hasFired()) {
        CHECK_FALSE(error);
        return false;
      }
      number_ += 1 - fault.passed();
    }
    ++faults;
    thrown += error ? 1 : 0;
    INFO((error ? error->what() : "no error"));
    CHECK((!error || mayThrow(kind_, error->kind())));
    CHECK((!error || isLate || namesOperation(*error)));
    const Scene::Elements found = scene_->elements();
    CHECK(inconsistentStreams(found, error.has_value(), isLate) == "");
    for (const auto& stream : found) lost += stream ? 0 : 1;
    if (scenario_.overwrites && !staysCold()) {
      scenario_.call(*scene_);  // also where the results are lost
      CHECK(scene_->elements() == after_);
    }
    if (!staysCold()) checkThatItGoesOn();
    return true;
  }

  void checkThatItGoesOn() {
    scene_->reset();
    CHECK(scene_->elements() == before_);
    scenario_.call(*scene_);
    CHECK(scene_->elements() == after_);
  }

  const Pair& pair_;
  const Scenario& scenario_;
  Kind kind_;
  bool isLasting_;
  std::int64_t& size_;  ///< the size of the next streams
  long number_ = 1;
  std::optional<Scene> scene_;
  Scene::Elements before_, after_;
};

void tryAll(const Pair& pair, Kind kind, bool isLasting, bool isGl) {
  std::int64_t size = 8;
  long faults = 0;
  for (const Scenario& scenario : scenarios()) {
    if (scenario.needsGl && !isGl) continue;
    FaultTest test(pair, scenario, kind, isLasting, size);
    test.run();
    if (std::getenv("SK_FAULTS_TELL") != nullptr) {
      std::printf("%-12s %-36s %4ld faults, %4ld errors, %4ld lost\n", nameOf(kind).c_str(),
                  scenario.name.c_str(), test.faults, test.thrown, test.lost);
    }
    faults += test.faults;
  }
  CHECK(faults > 0);
}

sk::DeviceOptions optionsOf(const std::string& profile) {
  return {.profile = profile, .limits = "guaranteed", .doubles = "native"};
}

void tryOnGl(const std::string& profile, Kind kind, bool isLasting) {
  INFO(profile);
  const LiveObjects before = liveObjects();
  const long blocksBefore = hostBlocks();
  {
    sk::Device device(optionsOf(profile));
    sk::Device reference(optionsOf(profile));
    tryAll({device, reference}, kind, isLasting, true);
  }
  CHECK(liveObjects() == before);
  CHECK(hostBlocks() == blocksBefore);
}

void tryToOpen(const sk::DeviceOptions& options, Kind kind, bool isLasting) {
  const sk::Device first(options);  // makes what lives as long as the process
  const LiveObjects before = liveObjects();
  for (long number = 1; number < 2000; ++number) {
    INFO(nameOf(kind) << " " << number);
    const long blocksBefore = hostBlocks();
    std::optional<sk::Error> error;
    bool hasFired = false;
    {
      const Fault fault(kind, number, isLasting);
      error = errorOf([&] { const sk::Device device(options); });
      hasFired = fault.hasFired();
    }
    INFO((error ? error->what() : "no error"));
    CHECK((!error || error->kind() == ErrorKind::Device || mayThrow(kind, error->kind())));
    CHECK(liveObjects() == before);
    const bool hasThrown = error.has_value();
    error.reset();
    CHECK(hostBlocks() == blocksBefore);
    if (hasFired) continue;
    CHECK_FALSE(hasThrown);
    CHECK(number > 1);
    return;
  }
  FAIL("there is no end of faults");
}

}  // namespace

TEST_CASE("where a device cannot be opened, nothing is left of it", "[open]") {
  for (const Kind kind : {Kind::Allocation, Kind::Framebuffer, Kind::Host}) {
    tryToOpen({.device = "gl", .profile = "glsl330"}, kind, false);
    tryToOpen({.device = "gl", .profile = "glsl330"}, kind, true);
  }
  tryToOpen({.device = "native"}, Kind::Host, false);
}

TEST_CASE("a device with GL survives every fault of its driver", "[gl]") {
  for (const Kind kind :
       {Kind::Program, Kind::Framebuffer, Kind::Allocation, Kind::Mapping, Kind::Fence, Kind::Command}) {
    tryOnGl("glsl330", kind, false);
  }
  for (const Kind kind : {Kind::Program, Kind::Allocation}) tryOnGl("glsl330", kind, true);
}

TEST_CASE("a device with compute programs survives every fault of its driver", "[gl]") {
  for (const Kind kind : {Kind::Program, Kind::Command}) tryOnGl("glsl430", kind, false);
  tryOnGl("glsl430", Kind::Allocation, true);
}

TEST_CASE("a device with GL survives every lack of host memory", "[gl][host]") {
  for (const bool isLasting : {false, true}) tryOnGl("glsl330", Kind::Host, isLasting);
  tryOnGl("glsl430", Kind::Host, false);
}

TEST_CASE("a native device survives every lack of host memory", "[native][host]") {
  for (const bool isLasting : {false, true}) {
    const long blocksBefore = hostBlocks();
    {
      sk::Device device = sk::Device::native();
      sk::Device reference = sk::Device::native();
      tryAll({device, reference}, Kind::HostOfAnyThread, isLasting, false);
    }
    CHECK(hostBlocks() == blocksBefore);
  }
}

namespace {

/// Every use of the device.
std::vector<std::function<void()>> usesOf(Scene& scene, const bool& isLost) {
  std::vector<std::function<void()>> uses;
  for (const Scenario& scenario : scenarios()) {
    uses.emplace_back([&] {
      if (!isLost) scene.reset();
      scenario.call(scene);
    });
  }
  uses.emplace_back([&] { scene.device.finish(); });
  return uses;
}

/// Loses the context at GL call `number`. False if there are fewer calls.
bool loseContext(const std::string& profile, long number) {
  INFO("call " << number);
  const LiveObjects before = liveObjects();
  {
    sk::Device device(optionsOf(profile));
    Scene scene(device, 8);
    sk::Future<float> early = scene.x.readAsync();
    bool isLost = false;
    const std::vector<std::function<void()>> uses = usesOf(scene, isLost);
    const Fault fault(Kind::Context, number);
    std::optional<sk::Error> error;
    for (std::size_t i = 0; i < uses.size() && !error; ++i) error = errorOf(uses[i]);
    if (!fault.hasFired()) return false;
    REQUIRE(error);
    CHECK(error->kind() == ErrorKind::Lost);
    isLost = true;
    for (const auto& use : uses) {
      const std::optional<sk::Error> again = errorOf(use);
      REQUIRE(again);
      CHECK(again->kind() == ErrorKind::Lost);
    }
    const std::optional<sk::Error> atEnd = errorOf([&] { early.get(); });
    CHECK((!atEnd || atEnd->kind() == ErrorKind::Lost));
  }
  CHECK(liveObjects() == before);
  return true;
}

}  // namespace

TEST_CASE("a device whose context is lost says so at each use, and ends", "[gl][lost]") {
  long number = 1;
  while (loseContext("glsl330", number)) number += number / 3 + 1;
  CHECK(number > 1000);
  for (const long few : {10, 300, 900}) CHECK(loseContext("glsl430", few));
}
