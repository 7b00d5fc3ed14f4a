// SPDX-License-Identifier: MIT
#include "kernels/scans.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <string_view>

#include <fmt/format.h>

namespace fuzz {

namespace {

std::int32_t asInt(std::uint32_t word) { return static_cast<std::int32_t>(word); }

/// An operator that accumulators are folded by. `{0}` is the accumulator, `{1}` what is folded into it.
struct Operator {
  std::string_view text;
  std::string_view identity, unsignedIdentity;
  std::uint32_t identityBits, unsignedBits;
  std::uint32_t (*apply)(std::uint32_t, std::uint32_t, bool isSigned);
};

constexpr std::uint32_t top = 0x80000000u;
constexpr Operator operators[] = {
    {"{0} += {1}", "0", "0u", 0, 0, [](std::uint32_t a, std::uint32_t b, bool) { return a + b; }},
    {"{0} *= {1}", "1", "1u", 1, 1, [](std::uint32_t a, std::uint32_t b, bool) { return a * b; }},
    {"{0} = max({0}, {1})", "-2147483647 - 1", "0u", top, 0,
     [](std::uint32_t a, std::uint32_t b, bool isSigned) {
       return isSigned ? (asInt(a) < asInt(b) ? b : a) : std::max(a, b);
     }},
    {"{0} = min({0}, {1})", "2147483647", "4294967295u", ~top, ~0u,
     [](std::uint32_t a, std::uint32_t b, bool isSigned) {
       return isSigned ? (asInt(b) < asInt(a) ? b : a) : std::min(a, b);
     }},
    {"{0} ^= {1}", "0", "0u", 0, 0, [](std::uint32_t a, std::uint32_t b, bool) { return a ^ b; }},
    {"{0} |= {1}", "0", "0u", 0, 0, [](std::uint32_t a, std::uint32_t b, bool) { return a | b; }},
    {"{0} &= {1}", "-1", "4294967295u", ~0u, ~0u,
     [](std::uint32_t a, std::uint32_t b, bool) { return a & b; }},
};

/// What is folded, in terms of inputs 0 and 1, the factor c and the index in the fastest dimension.
struct Term {
  std::string_view text;
  std::uint32_t (*value)(std::uint32_t x, std::uint32_t y, std::uint32_t c, std::uint32_t index);
};
constexpr Term terms[] = {
    {"{0}(x0)", [](std::uint32_t x, std::uint32_t, std::uint32_t, std::uint32_t) { return x; }},
    {"{0}(x1)", [](std::uint32_t, std::uint32_t y, std::uint32_t, std::uint32_t) { return y; }},
    {"{0}(x0) * {0}(x1)",
     [](std::uint32_t x, std::uint32_t y, std::uint32_t, std::uint32_t) { return x * y; }},
    {"({0}(x0) ^ {0}(c))",
     [](std::uint32_t x, std::uint32_t, std::uint32_t c, std::uint32_t) { return x ^ c; }},
    {"({0}(x1) + {0}(indexof(x0).x))",
     [](std::uint32_t, std::uint32_t y, std::uint32_t, std::uint32_t index) { return y + index; }},
};

std::string_view typeOf(bool isSigned) { return isSigned ? "int" : "uint"; }

sk::Shape shapeOf(Random& random) {
  if (random.chance(1, 4)) return {random.between(1, 40000)};
  const int rank = random.between(1, 4);
  std::array<std::int64_t, 4> extents{1, 1, 1, 1};
  constexpr int most[] = {3000, 80, 20, 9};
  for (int d = 0; d < rank; ++d) extents[static_cast<std::size_t>(d)] = random.between(1, most[rank - 1]);
  if (rank == 1) return {extents[0]};
  if (rank == 2) return {extents[0], extents[1]};
  if (rank == 3) return {extents[0], extents[1], extents[2]};
  return {extents[0], extents[1], extents[2], extents[3]};
}

}  // namespace

RandomScan::RandomScan(std::uint64_t seed, std::uint64_t number) {
  Random random(seed, number);
  random.chance(1, 4) ? makeMaps() : makeOperators(random);
  shape_ = shapeOf(random);
  along_ = random.between(-1, shape_.rank() - 1);
  isExclusive_ = random.chance(1, 3);
  elements_.resize(inputsAreSigned_.size());
  for (Words& words : elements_) {
    for (std::int64_t i = 0; i < shape_.size(); ++i)
      words.push_back(static_cast<std::uint32_t>(random.next()));
  }
  text_ += fmt::format("// over {} elements of rank {}, along {}{}\n", shape_.size(), shape_.rank(), along_,
                       isExclusive_ ? ", without the element" : "");
}

void RandomScan::makeOperators(Random& random) {
  inputsAreSigned_ = {random.chance(1, 2), random.chance(1, 2)};
  factor_ = static_cast<std::uint32_t>(random.next());
  hasFactor_ = true;
  std::string parameters, body;
  std::vector<std::pair<const Operator*, const Term*>> steps;
  for (int a = random.between(1, 3); a > 0; --a) {
    const Operator& by = random.pick(operators);
    const Term& term = random.pick(terms);
    const bool isSigned = random.chance(1, 2);
    const std::string name = fmt::format("s{}", accumulators_.size());
    parameters += fmt::format(", scan {} {}<> = {}", typeOf(isSigned), name,
                              isSigned ? by.identity : by.unsignedIdentity);
    const std::string value = fmt::format(fmt::runtime(term.text), typeOf(isSigned));
    body += fmt::format("  {};\n", fmt::format(fmt::runtime(by.text), name, value));
    accumulators_.push_back({isSigned, isSigned ? by.identityBits : by.unsignedBits});
    steps.emplace_back(&by, &term);
  }
  text_ = fmt::format("scan void random(uint c, {} x0<>, {} x1<>{}) {{\n{}}}\n", typeOf(inputsAreSigned_[0]),
                      typeOf(inputsAreSigned_[1]), parameters, body);
  fold_ = [this, steps](Words& accumulators, const Words& element, std::uint32_t index) {
    for (std::size_t a = 0; a < steps.size(); ++a) {
      const std::uint32_t value = steps[a].second->value(element[0], element[1], factor_, index);
      accumulators[a] = steps[a].first->apply(accumulators[a], value, accumulators_[a].isSigned);
    }
  };
}

/// Maps r -> a * r + b, whose composition does not commute.
void RandomScan::makeMaps() {
  inputsAreSigned_ = {false, false};
  accumulators_ = {{false, 1}, {false, 0}};
  text_ =
      "scan void random(uint x0<>, uint x1<>, scan uint s0<> = 1u, scan uint s1<> = 0u) {\n"
      "  s0 *= x0;\n"
      "  s1 = s1 * x0 + x1;\n"
      "}\n";
  fold_ = [](Words& accumulators, const Words& element, std::uint32_t) {
    accumulators[0] *= element[0];
    accumulators[1] = accumulators[1] * element[0] + element[1];
  };
}

std::vector<RandomScan::Words> RandomScan::results() const {
  const auto count = static_cast<std::size_t>(shape_.size());
  std::size_t step = 1, length = count;
  if (along_ >= 0) {
    length = static_cast<std::size_t>(shape_[along_]);
    for (int d = along_ + 1; d < shape_.rank(); ++d) step *= static_cast<std::size_t>(shape_[d]);
  }
  const auto row = static_cast<std::size_t>(shape_[shape_.rank() - 1]);
  std::vector<Words> states(count), results(accumulators_.size(), Words(count));
  for (std::size_t i = 0; i < count; ++i) {
    Words state;
    for (const Accumulator& accumulator : accumulators_) state.push_back(accumulator.identity);
    if (i / step % length != 0) state = states[i - step];
    for (std::size_t a = 0; isExclusive_ && a < state.size(); ++a) results[a][i] = state[a];
    fold_(state, {elements_[0][i], elements_[1][i]}, static_cast<std::uint32_t>(i % row));
    for (std::size_t a = 0; !isExclusive_ && a < state.size(); ++a) results[a][i] = state[a];
    states[i] = std::move(state);
  }
  return results;
}

std::string RandomScan::difference(sk::Device& device, const sk::program::Reduction& compiled) const {
  std::deque<sk::Stream<std::int32_t>> ints;
  std::deque<sk::Stream<std::uint32_t>> uints;
  std::vector<sk::Argument> arguments;
  if (hasFactor_) arguments.push_back({.value = &factor_});
  const auto add = [&](bool isSigned) {
    const sk::StreamRegion region = isSigned
                                        ? ints.emplace_back(device.stream<std::int32_t>(shape_)).region()
                                        : uints.emplace_back(device.stream<std::uint32_t>(shape_)).region();
    arguments.push_back({.region = region});
    return region;
  };
  for (std::size_t i = 0; i < elements_.size(); ++i)
    sk::detail::write(add(inputsAreSigned_[i]), elements_[i].data(), elements_[i].size());
  std::vector<sk::StreamRegion> outputs;
  for (const Accumulator& accumulator : accumulators_) outputs.push_back(add(accumulator.isSigned));
  sk::CallOptions options{.scan = isExclusive_ ? sk::Scan::Exclusive : sk::Scan::Inclusive};
  if (along_ >= 0) options.along = along_;
  sk::scan(compiled, arguments, options);
  const std::vector<Words> expected = results();
  for (std::size_t a = 0; a < outputs.size(); ++a) {
    Words got(expected[a].size());
    sk::detail::read(outputs[a], got.data(), got.size());
    const auto [wrong, right] = std::ranges::mismatch(got, expected[a]);
    if (wrong == got.end()) continue;
    return fmt::format("accumulator {} at element {}: {:#x}, not {:#x}\n", a, wrong - got.begin(), *wrong,
                       *right);
  }
  return {};
}

}  // namespace fuzz
