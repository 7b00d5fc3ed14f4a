// SPDX-License-Identifier: MIT
//
// Streams, scalars, views, loops, rows and futures without a device: each use throws an error of kind Lost, but for the few
// that docs/runtime.md and the headers name.
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "sk/algorithm.hpp"
#include "sk/placed.hpp"
#include "sk/rows.hpp"
#include "sk/sk.hpp"

using namespace sk;

namespace {

/// The kind of the sk::Error that `call` throws; none if it throws none.
std::optional<Error::Kind> kindOf(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.kind();
  }
  return std::nullopt;
}

/// Checks that every use of a stream throws an error of kind Lost that contains `why`.
void checkThatNothingWorks(Stream<float>& stream, const std::string& why) {
  Device device;
  auto other = device.stream<float>({2, 2});
  const std::vector<std::function<void()>> uses = {
      [&] { stream.write(std::vector<float>(4)); },
      [&] { stream.writeAsync(std::vector<float>(4)); },
      [&] { (void)stream.read(); },
      [&] { (void)stream.readAsync(); },
      [&] { (void)stream.readReals(); },
      [&] { stream.writeReals(std::vector<double>(4)); },
      [&] { stream.fill(1); },
      [&] { stream.copyTo(other); },
      [&] { other.copyTo(stream); },
      [&] { stream.copyTo(other.domain({0, 0}, {2, 2})); },
      [&] { (void)stream.domain({0, 0}, {1, 1}); },
      [&] { (void)std::as_const(stream).domain({0, 0}, {1, 1}); },
      [&] { (void)stream.reshape({4}); },
      [&] { (void)sk::stride(stream, {1, 1}); },
      [&] { (void)sk::placed(stream, {{0, 0}, {2, 2}}); },
      [&] { (void)stream.texture(); },
      [&] { stream.fillBuffer(0); },
      [&] { sk::sort(stream); },
      [&] { (void)sk::order(stream); },
      [&] { (void)sk::unique(stream); },
  };
  for (std::size_t i = 0; i < uses.size(); ++i) {
    INFO("use " << i);
    CHECK(kindOf(uses[i]) == Error::Kind::Lost);
    CHECK(errorOf(uses[i]).find(why) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("streams without a device, and what still works then") {
  Stream<float> none;
  CHECK(!none);
  CHECK(none.region().stream == nullptr);
  CHECK(none.size() == 0);
  CHECK(none.shape() == Shape());
  checkThatNothingWorks(none, "default-constructed or moved from");
  auto gone = std::make_unique<Device>();
  auto orphan = gone->stream<float>({2, 2});
  orphan.fill(3);
  auto view = orphan.domain({0, 0}, {1, 2});
  auto starts = gone->stream<int>({3});
  starts.write(std::vector<int>{0, 2, 5});
  const Rows rows(starts);
  auto number = gone->scalar<float>(1);
  auto pending = number + 1;
  auto early = orphan.readAsync();
  Loop loop = gone->record([&] { orphan.fill(1); });
  gone.reset();
  checkThatNothingWorks(orphan, "the device of this stream of shape {2, 2} has been destroyed");
  CHECK(orphan);
  CHECK(view.shape() == Shape(1, 2));
  CHECK(view.size() == 2);
  const auto isLost = [](auto&& use) {
    CHECK(kindOf(use) == Error::Kind::Lost);
    CHECK(errorOf(use).find("device") != std::string::npos);
  };
  isLost([&] { (void)orphan.shape(); });
  isLost([&] { (void)orphan.size(); });
  isLost([&] { (void)view.read(); });
  isLost([&] { view.fill(1); });
  isLost([&] { (void)view.domain({0, 0}, {1, 1}); });
  isLost([&] { (void)view.reshape({2}); });
  CHECK(early.get() == std::vector<float>(4, 3.0f));
  CHECK(rows.count() == 2);
  CHECK(rows.end() == 5);
  isLost([&] { loop.repeat(1); });
  isLost([&] { (void)number.read(); });
  isLost([&] { (void)(number + 1); });
  isLost([&] { (void)pending.read(); });
  isLost([&] { number = 2.0f; });
  Device device;
  auto alive = device.scalar<float>(5);
  isLost([&] { number.assign(alive); });
  isLost([&] { alive.assign(number); });
  isLost([&] { alive += number; });
  CHECK(alive.read() == 5);
  number = alive + 1;  // moved to
  CHECK(number.read() == 6);
  orphan = device.stream<float>({1});
  orphan.fill(2);
  CHECK(orphan.read() == std::vector<float>{2});
}
