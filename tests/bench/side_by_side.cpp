// SPDX-License-Identifier: MIT
#include "side_by_side.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "bench.sk.hpp"

namespace bench {
namespace {

constexpr float factor = 2.5f;
constexpr double bar = 1.05;
constexpr int deals = 3;

/// A hand-written pass with its textures. It is made, used and let go with its context current.
class HandWritten {
 public:
  HandWritten(const PlainContext& context, const char* text, int size,
              const std::vector<std::vector<float>>& inputs)
      : context_(context) {
    const PlainContext::Current current(context_);
    pass_.emplace(text, size, size, inputs);
    pass_->setFloat("a", factor);
  }
  ~HandWritten() {
    const PlainContext::Current current(context_);
    pass_.reset();
  }
  HandWritten(const HandWritten&) = delete;
  HandWritten& operator=(const HandWritten&) = delete;

  void operator()(int times) const {
    const PlainContext::Current current(context_);
    for (int i = 0; i < times; ++i) pass_->draw();
    glFinish();
  }
  std::vector<float> result() const {
    const PlainContext::Current current(context_);
    return pass_->result();
  }

 private:
  const PlainContext& context_;
  std::optional<PlainPass> pass_;
};

/// A kernel with its streams.
class Generated {
 public:
  using Call = std::function<void(const sk::Stream<float>&, const sk::Stream<float>&, sk::Stream<float>&)>;

  Generated(sk::Device& device, Call call, int size, const std::vector<std::vector<float>>& inputs)
      : device_(device),
        call_(std::move(call)),
        x_(filled(size, inputs.front())),
        y_(filled(size, inputs.back())),
        r_(filled(size, inputs.front())) {}

  void operator()(int times) {
    for (int i = 0; i < times; ++i) call_(x_, y_, r_);
    device_.finish();
  }
  std::vector<float> result() const { return r_.read(); }

 private:
  sk::Stream<float> filled(int size, const std::vector<float>& values) {
    auto stream = device_.stream<float>({size, size});
    stream.write(values);
    return stream;
  }

  sk::Device& device_;
  Call call_;
  sk::Stream<float> x_;
  sk::Stream<float> y_;
  sk::Stream<float> r_;
};

}  // namespace

std::vector<float> ramp(std::int64_t size, float step) {
  std::vector<float> values;
  for (std::int64_t i = 0; i < size; ++i) values.push_back(std::fmod(static_cast<float>(i) * step, 1.0f));
  return values;
}

void SideBySide::saxpy(int size) {
  const std::int64_t count = std::int64_t{size} * size;
  const Inputs inputs = {ramp(count, 0.37f), ramp(count, 0.11f)};
  const auto call = [](const auto& x, const auto& y, auto& r) { bench::saxpy(factor, x, y, r); };
  const std::string name = fmt::format("saxpy {0} x {0}", size);
  against(name + " over hand-written", bar, call, saxpyText, size, inputs);
  against(name + " over one by samplers", {}, call, saxpySampledText, size, inputs);
}

void SideBySide::binomial(int size) {
  const Inputs inputs = {ramp(std::int64_t{size} * size, 0.37f)};
  const auto call = [](const auto& x, const auto&, auto& r) { bench::binomial(x, r); };
  const std::string name = fmt::format("3 x 3 stencil {0} x {0}", size);
  against(name + " over hand-written", bar, call, binomialText, size, inputs);
  against(name + " over one by samplers", {}, call, binomialSampledText, size, inputs);
}

void SideBySide::control(int size) {
  const Inputs inputs = {ramp(std::int64_t{size} * size, 0.37f), ramp(std::int64_t{size} * size, 0.11f)};
  Comparison rounds;
  for (int deal = 0; deal < deals; ++deal) {
    const HandWritten a(context_, saxpyText, size, inputs);
    const HandWritten b(context_, saxpyText, size, inputs);
    compare(std::cref(a), std::cref(b), rounds);
  }
  report_.add(
      {fmt::format("saxpy {0} x {0} by hand over itself", size), "x", quartilesOf(rounds.ratios), {}, {}});
}

void SideBySide::against(const std::string& name, std::optional<double> limit, const Call& call,
                         const char* text, int size, const Inputs& inputs) {
  Comparison rounds;
  bool equal = true;
  for (int deal = 0; deal < deals; ++deal) {
    Generated ours(device_, call, size, inputs);
    const HandWritten theirs(context_, text, size, inputs);
    compare(std::ref(ours), std::cref(theirs), rounds);
    equal = equal && ours.result() == theirs.result();
  }
  report_.add(
      {name, "x", quartilesOf(rounds.ratios), limit,
       fmt::format("{:.3g} ms against {:.3g} ms; {}", quartilesOf(rounds.ours).median,
                   quartilesOf(rounds.theirs).median, equal ? "equal in every bit" : "the results DIFFER")});
}

void SideBySide::compare(const Contender& ours, const Contender& theirs, Comparison& rounds) const {
  bench::compare(ours, theirs, (patience_.rounds + deals - 1) / deals, patience_.sampleMilliseconds, rounds);
}

}  // namespace bench
