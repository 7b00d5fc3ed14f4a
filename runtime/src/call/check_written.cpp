// SPDX-License-Identifier: MIT
#include "call/check_written.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "device/region.hpp"
#include "device/stream_state.hpp"
#include "device/unwritten_elements.hpp"
#include "sk/error.hpp"

namespace sk {

namespace {

[[noreturn]] void failUnwritten(const StreamRegion& region, std::string_view context) {
  throw Error(
      fmt::format("{}: nothing has written this stream of shape {}; write() or fill() it first, or let a "
                  "kernel write it (SK_CHECK=written)",
                  context, toString(region.stream->shape)),
      Error::Kind::Misuse);
}

}  // namespace

void trackWritten(StreamState& stream) {
  if (stream.shape.size() > 0) stream.unwritten = std::make_unique<UnwrittenElements>(stream.shape.size());
}

std::vector<std::int64_t> unwrittenIn(const StreamRegion& region) {
  if (region.stream->unwritten == nullptr || region.shape.size() == 0) return {};
  return region.stream->unwritten->in(affine(region));
}

Index indexOf(const Shape& shape, std::int64_t number) {
  Index index = Index::origin(shape.rank());
  for (int d = shape.rank() - 1; d >= 0; --d) {
    index[d] = number % shape[d];
    number /= shape[d];
  }
  return index;
}

void checkWritten(const StreamRegion& region, std::string_view context) {
  const std::vector<std::int64_t> unwritten = unwrittenIn(region);
  if (unwritten.empty()) return;
  if (region.stream->unwritten->isAll()) failUnwritten(region, context);
  throw Error(
      fmt::format(
          "{}: nothing has written the element at {} of shape {}; write() or fill() it first, let a kernel "
          "write it, or ask for a view without it (SK_CHECK=written)",
          context, toString(indexOf(region.shape, unwritten.front())), toString(region.shape)),
      Error::Kind::Misuse);
}

void checkSomeWritten(const StreamRegion& region, std::string_view context) {
  if (region.stream->unwritten == nullptr || region.shape.size() == 0) return;
  const std::size_t count = unwrittenIn(region).size();
  if (count < static_cast<std::size_t>(region.shape.size())) return;
  checkWritten(region, context);
}

namespace {

void dropIfWritten(StreamState& stream) {
  if (stream.unwritten->isEmpty()) stream.unwritten.reset();
}

}  // namespace

void noteWritten(const StreamRegion& region) {
  StreamState& stream = *region.stream;
  if (stream.unwritten == nullptr || region.shape.size() == 0) return;
  if (isWhole(region)) return stream.unwritten.reset();
  stream.unwritten->remove(affine(region));
  dropIfWritten(stream);
}

void noteWritten(const StreamRegion& region, std::span<const std::int64_t> numbers) {
  StreamState& stream = *region.stream;
  if (stream.unwritten == nullptr || numbers.empty()) return;
  stream.unwritten->remove(affine(region), numbers);
  dropIfWritten(stream);
}

void noteAllWritten(StreamState& stream) { stream.unwritten.reset(); }

void noteCopied(const StreamRegion& to, std::span<const std::int64_t> unwritten) {
  StreamState& stream = *to.stream;
  noteWritten(to);
  if (unwritten.empty()) return;
  if (stream.unwritten == nullptr) {
    stream.unwritten = std::make_unique<UnwrittenElements>(stream.shape.size());
    stream.unwritten->remove(affine({&stream, Index::origin(stream.shape.rank()), stream.shape}));
  }
  stream.unwritten->add(affine(to), unwritten);
}

namespace {

enum class Check : std::uint8_t { None, Folds, Halos, Written, Asserts, Collectives, Ranges };

constexpr std::array<std::pair<std::string_view, Check>, 6> checks = {{{"folds", Check::Folds},
                                                                       {"halos", Check::Halos},
                                                                       {"written", Check::Written},
                                                                       {"asserts", Check::Asserts},
                                                                       {"collectives", Check::Collectives},
                                                                       {"ranges", Check::Ranges}}};

Check checkNamed(std::string_view name) {
  if (name.empty()) return Check::None;
  std::string known;
  for (const auto& [word, check] : checks) {
    if (word == name) return check;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", word);
  }
  throw Error(fmt::format("there is no check '{}'; choose one of {}, or unset SK_CHECK", name, known));
}

Check chosenCheck() {
  static const Check chosen = [] {
    const char* const value = std::getenv("SK_CHECK");
    return checkNamed(value == nullptr ? "" : value);
  }();
  return chosen;
}

}  // namespace

void requireKnownCheck() { static_cast<void>(chosenCheck()); }
bool checksFolds() { return chosenCheck() == Check::Folds; }
bool checksHalos() { return chosenCheck() == Check::Halos; }
bool checksWritten() { return chosenCheck() == Check::Written; }
bool checksAsserts() { return chosenCheck() == Check::Asserts; }
bool checksRanges() { return chosenCheck() == Check::Ranges; }
bool checksCollectives() { return chosenCheck() == Check::Collectives; }

}  // namespace sk
