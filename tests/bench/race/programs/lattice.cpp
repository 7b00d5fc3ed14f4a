// SPDX-License-Identifier: MIT
//
// One step of the coupled map lattices of examples/applications/lattice, from a state to the next one. Sides wrap, and the bottom and
// the top are walls. boiling: floats are the temperature; convection: the velocities vx and vy, pressure and temperature, as are
// the results, one field after the other; reaction: u and v.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "constants.hpp"
#include "flow.sk.hpp"
#include "heat.sk.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"
#include "reaction.sk.hpp"

namespace race {
namespace {

constexpr auto wrap = static_cast<std::uint32_t>(0), wall = static_cast<std::uint32_t>(2);  // lattice::Edge

/// Walls that are held at these values.
lattice::Sides wallsBetween(float bottom, float top) {
  return {.left = wrap, .right = wrap, .bottom = wall, .top = wall, .walls = sk::float4{0, 0, bottom, top}};
}

/// Fields of a problem, and as many that a step writes.
class LatticeTask : public OurTask {
 public:
  LatticeTask(sk::Device& device, const Problem& p) : OurTask(device) {
    for (const std::vector<float>& values : p.floats) {
      now_.push_back(filled<float>({p.rows, p.columns}, values));
      next_.push_back(device.stream<float>({p.rows, p.columns}));
    }
  }

  std::vector<float> result() override {
    std::vector<float> all;
    for (const sk::Stream<float>& field : next_) {
      const std::vector<float> values = field.read();
      all.insert(all.end(), values.begin(), values.end());
    }
    return all;
  }

 protected:
  std::vector<sk::Stream<float>> now_, next_;
};

class Boiling final : public LatticeTask {
 public:
  Boiling(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : LatticeTask(device, p),
        diffuse_(lattice::diffuse.with(options)),
        rise_(lattice::rise.with(options)),
        exchange_(lattice::exchange.with(options)),
        warmed_(device.stream<float>({p.rows, p.columns})) {}

 private:
  void once() override {
    const lattice::Boiling boiling{boilingPoint, boilingAlpha, boilingSigma, boilingLatent};
    diffuse_(wallsBetween(boilingBottom, boilingTop), boilingSpread, now_[0], next_[0]);
    rise_(true, 0, boiling, next_[0], warmed_);
    exchange_({.x = false, .y = true}, boiling, now_[0], warmed_, next_[0]);
  }

  lattice::DiffuseKernel diffuse_;
  lattice::RiseKernel rise_;
  lattice::ExchangeKernel exchange_;
  sk::Stream<float> warmed_;
};

class Convection final : public LatticeTask {
 public:
  Convection(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : LatticeTask(device, p),
        push_(lattice::push.with(options)),
        convect_(lattice::convect.with(options)),
        slope_(-1.0f / static_cast<float>(p.rows)) {}

 private:
  void once() override {
    const lattice::Fluid fluid{flowCarry, flowViscosity, flowDamping, flowLift, flowRest, slope_};
    push_(false, true, false, fluid, now_[0], now_[1], now_[2], now_[3], next_[0], next_[1]);
    convect_(wallsBetween(1, 0),
             {.spread = flowSpread,
              .carry = flowCarry,
              .stiffness = flowStiffness,
              .t = now_[3],
              .vx = next_[0],
              .vy = next_[1]},
             now_[2], next_[3], next_[2]);
  }

  lattice::PushKernel push_;
  lattice::ConvectKernel convect_;
  float slope_;
};

class Reaction final : public LatticeTask {
 public:
  Reaction(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : LatticeTask(device, p), react_(lattice::react.with(options)) {}

 private:
  void once() override {
    const lattice::Medium medium{reactionFeed, reactionKill, reactionSpreadU, reactionSpreadV, 1};
    react_(false, false, medium, now_[0], now_[1], next_[0], next_[1]);
  }

  lattice::ReactKernel react_;
};

/// A field of the problem in double precision, on a torus.
class Field {
 public:
  Field(const Problem& p, std::size_t number)
      : rows_(p.rows), columns_(p.columns), values_(p.floats[number]) {}

  double operator()(std::int64_t y, std::int64_t x) const {
    return values_[static_cast<std::size_t>((y + rows_) % rows_ * columns_ + (x + columns_) % columns_)];
  }

 private:
  std::int64_t rows_, columns_;
  const std::vector<float>& values_;
};

/// What a function of (y, x) gives between a bottom and a top that are held at these values.
template <class Value>
double between(const Value& value, const Problem& p, double bottom, double top, std::int64_t y,
               std::int64_t x) {
  if (y < 0) return 2 * bottom - value(0, x);
  return y >= p.rows ? 2 * top - value(p.rows - 1, x) : value(y, x);
}

/// The sum of the four neighbours, less four times the cell.
template <class Value>
double laplacian(const Value& a, std::int64_t y, std::int64_t x) {
  return a(y, x - 1) + a(y, x + 1) + a(y - 1, x) + a(y + 1, x) - 4 * a(y, x);
}

/// Some places of each of several fields, which are functions of (y, x).
template <class... Values>
Check checkOf(const Problem& p, double tolerance, const Values&... values) {
  Check made{{}, {}, tolerance};
  std::int64_t first = 0;
  const auto add = [&](const auto& value) {
    for (const std::int64_t i : somePlaces(p.size(), 4096)) {
      made.places.push_back(first + i);
      made.values.push_back(value(i / p.columns, i % p.columns));
    }
    first += p.size();
  };
  (add(values), ...);
  return made;
}

}  // namespace

Problem boilingProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1, boilingTop, boilingBottom)};
  return p;
}

Check boilingCheck(const Problem& p) {
  const Field before(p, 0);
  const auto held = [&](const auto& t) {
    return [&](std::int64_t y, std::int64_t x) { return between(t, p, boilingBottom, boilingTop, y, x); };
  };
  const auto start = held(before);
  const auto diffused = [&](std::int64_t y, std::int64_t x) {
    return start(y, x) + boilingSpread * laplacian(start, y, x);
  };
  const auto density = [&](std::int64_t y, std::int64_t x) {
    return std::tanh(boilingAlpha * (diffused(std::clamp<std::int64_t>(y, 0, p.rows - 1), x) - boilingPoint));
  };
  const auto after = [&](std::int64_t y, std::int64_t x) {
    return diffused(y, x) * (1 - 0.5 * boilingSigma * (density(y + 1, x) - density(y - 1, x)));
  };
  const auto turned = [&](std::int64_t y, std::int64_t x) {
    if (y < 0 || y >= p.rows) return 0.0;
    return (after(y, x) > boilingPoint ? 1.0 : 0.0) - (before(y, x) > boilingPoint ? 1.0 : 0.0);
  };
  const auto next = [&](std::int64_t y, std::int64_t x) {
    return after(y, x) -
           boilingLatent * (turned(y, x - 1) + turned(y, x + 1) + turned(y - 1, x) + turned(y + 1, x));
  };
  Check check = checkOf(p, 1e-6, next);
  check.exempt = 1e-3;  // where a rounding decides whether a cell boils, it decides for its four neighbours
  return check;
}

Problem convectionProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1, -1, 1), numbers(p.size(), 2, -1, 1), numbers(p.size(), 3),
              numbers(p.size(), 4)};
  // Nothing goes through the bottom, nor, as it wraps round, through the top.
  std::fill_n(p.floats[1].begin(), p.columns, 0.0f);
  return p;
}

Check convectionCheck(const Problem& p) {
  const Field u(p, 0), v(p, 1), pressure(p, 2), temperature(p, 3);
  const auto square = [](double a) { return a * a; };
  const auto divergence = [&](std::int64_t y, std::int64_t x) {
    return u(y, x + 1) - u(y, x) + v(y + 1, x) - v(y, x);
  };
  const auto beside = [&](std::int64_t y, std::int64_t x) { return between(u, p, 0, 0, y, x); };
  const auto t = [&](std::int64_t y, std::int64_t x) { return between(temperature, p, 1, 0, y, x); };
  const auto nextU = [&](std::int64_t y, std::int64_t x) {
    const double uu = square(u(y, x) + u(y, x + 1)) - square(u(y, x - 1) + u(y, x));
    const double uv = (u(y, x) + u(y + 1, x)) * (v(y + 1, x) + v(y + 1, x - 1)) -
                      (u(y - 1, x) + u(y, x)) * (v(y, x) + v(y, x - 1));
    return u(y, x) - flowCarry * (0.25 * (uu + uv) + pressure(y, x) - pressure(y, x - 1)) +
           flowViscosity * laplacian(beside, y, x) + flowDamping * (divergence(y, x) - divergence(y, x - 1));
  };
  const auto nextV = [&](std::int64_t y, std::int64_t x) {
    if (y == 0 || y == p.rows) return 0.0;
    const double vv = square(v(y, x) + v(y + 1, x)) - square(v(y - 1, x) + v(y, x));
    const double vu = (v(y, x) + v(y, x + 1)) * (u(y, x + 1) + u(y - 1, x + 1)) -
                      (v(y, x - 1) + v(y, x)) * (u(y, x) + u(y - 1, x));
    const double rest = flowRest - static_cast<double>(y) / static_cast<double>(p.rows);
    const double warmth = 0.5 * (t(y, x) + t(y - 1, x)) - rest;
    return v(y, x) - flowCarry * (0.25 * (vv + vu) + pressure(y, x) - pressure(y - 1, x)) +
           flowViscosity * laplacian(v, y, x) + flowDamping * (divergence(y, x) - divergence(y - 1, x)) +
           flowLift * warmth;
  };
  const auto nextP = [&](std::int64_t y, std::int64_t x) {
    return pressure(y, x) - flowStiffness * (nextU(y, x + 1) - nextU(y, x) + nextV(y + 1, x) - nextV(y, x));
  };
  const auto nextT = [&](std::int64_t y, std::int64_t x) {
    const double here = t(y, x), below = t(y - 1, x), above = t(y + 1, x);
    const double carried = nextU(y, x + 1) * (here + t(y, x + 1)) - nextU(y, x) * (t(y, x - 1) + here) +
                           nextV(y + 1, x) * (here + above) - nextV(y, x) * (below + here);
    return here + flowSpread * laplacian(t, y, x) - 0.5 * flowCarry * carried;
  };
  return checkOf(p, 1e-6, nextU, nextV, nextP, nextT);
}

Problem reactionStepProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1), numbers(p.size(), 2)};
  return p;
}

Check reactionStepCheck(const Problem& p) {
  const Field u(p, 0), v(p, 1);
  const auto made = [&](std::int64_t y, std::int64_t x) { return u(y, x) * v(y, x) * v(y, x); };
  const auto nextU = [&](std::int64_t y, std::int64_t x) {
    return u(y, x) + reactionSpreadU * laplacian(u, y, x) - made(y, x) + reactionFeed * (1 - u(y, x));
  };
  const auto nextV = [&](std::int64_t y, std::int64_t x) {
    return v(y, x) + reactionSpreadV * laplacian(v, y, x) + made(y, x) -
           (double{reactionFeed} + reactionKill) * v(y, x);
  };
  return checkOf(p, 1e-6, nextU, nextV);
}

std::unique_ptr<Task> boilingOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Boiling>(device, options, p);
}
std::unique_ptr<Task> convectionOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Convection>(device, options, p);
}
std::unique_ptr<Task> reactionStepOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Reaction>(device, options, p);
}

}  // namespace race
