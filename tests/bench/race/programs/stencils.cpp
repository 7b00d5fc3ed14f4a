// SPDX-License-Identifier: MIT
//
// Stencils of 5 and 9 points on a grid whose border elements continue outside. floats: u.
#include "programs/stencils.sk.hpp"

#include <algorithm>

#include "constants.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

class Stencil : public OurTask {
 public:
  Stencil(sk::Device& device, const Problem& p)
      : OurTask(device),
        u_(filled<float>({p.rows, p.columns}, p.floats[0])),
        v_(device.stream<float>({p.rows, p.columns})) {}

  std::vector<float> result() override { return v_.read(); }

 protected:
  sk::Stream<float> u_, v_;
};

class Heat final : public Stencil {
 public:
  Heat(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : Stencil(device, p), heat_(kernels::heat.with(options)) {}

 private:
  void once() override { heat_(heatFlow, u_, v_); }
  kernels::HeatKernel heat_;
};

class Binomial final : public Stencil {
 public:
  Binomial(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : Stencil(device, p), binomial_(kernels::binomial.with(options)) {}

 private:
  void once() override { binomial_(u_, v_); }
  kernels::BinomialKernel binomial_;
};

/// value(u) at some places, where u(dy, dx) is the element beside the place.
template <class Value>
Check check(const Problem& p, const Value& value) {
  Check made{somePlaces(p.size()), {}, 0x1p-21};
  for (const std::int64_t i : made.places) {
    made.values.push_back(value([&, y = i / p.columns, x = i % p.columns](int dy, int dx) -> double {
      const std::int64_t row = std::clamp<std::int64_t>(y + dy, 0, p.rows - 1);
      const std::int64_t column = std::clamp<std::int64_t>(x + dx, 0, p.columns - 1);
      return p.floats[0][static_cast<std::size_t>(row * p.columns + column)];
    }));
  }
  return made;
}

}  // namespace

Check heatCheck(const Problem& p) {
  return check(p, [](const auto& u) {
    return u(0, 0) + heatFlow * (u(0, -1) + u(0, 1) + u(-1, 0) + u(1, 0) - 4 * u(0, 0));
  });
}

Check binomialCheck(const Problem& p) {
  return check(p, [](const auto& u) {
    return (u(-1, -1) + u(-1, 1) + u(1, -1) + u(1, 1) + 2 * (u(-1, 0) + u(0, -1) + u(0, 1) + u(1, 0)) +
            4 * u(0, 0)) /
           16;
  });
}

std::unique_ptr<Task> heatOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Heat>(device, options, p);
}

std::unique_ptr<Task> binomialOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Binomial>(device, options, p);
}

}  // namespace race
