// SPDX-License-Identifier: MIT
#include "native/template_folds_test.hpp"

#include "sk/native/native.hpp"

namespace sk::test {

namespace {

using native::Call;
using native::Input;
using native::Output;
using native::ReduceCall;

template <class Real, bool isOfFloats = false>
struct Sum {
  Input<Real, isOfFloats> x;
  Output<Real> total;
  native::Index sk_index{}, sk_extent{};
  int sk_i = 0;

  explicit Sum(const Call& call) : x(call, 0), total(call, 1) {}

  static constexpr bool sk_isCommutative = true;
  static constexpr bool sk_isUneven = false;
  static constexpr bool sk_sumsFloats = std::is_same_v<Real, double>;
  static constexpr bool sk_readsFloats = isOfFloats;
  using sk_OfFloats = Sum<Real, true>;
  auto sk_term() { return std::tie(x); }
  auto sk_streams() { return std::tie(x); }

  using sk_State = std::tuple<Real>;
  static constexpr bool sk_isSeeded = false;
  sk_State sk_identity() const { return sk_State(Real(0)); }
  void sk_fold(sk_State& state) { std::get<0>(state) += x.at(sk_i); }
  void sk_combine(sk_State& state, const sk_State& later) { std::get<0>(state) += std::get<0>(later); }
  void sk_store(const native::Index& at, const sk_State& state) const { total.store(at, std::get<0>(state)); }
};

template <class Real, bool isOfFloats = false>
struct Dot {
  Input<Real, isOfFloats> x, y;
  Output<Real> total;
  native::Index sk_index{}, sk_extent{};
  int sk_i = 0;

  explicit Dot(const Call& call) : x(call, 0), y(call, 1), total(call, 2) {}

  static constexpr bool sk_isCommutative = true;
  static constexpr bool sk_isUneven = false;
  static constexpr bool sk_sumsFloats = true;
  static constexpr bool sk_readsFloats = isOfFloats;
  using sk_OfFloats = Dot<Real, true>;
  auto sk_term() { return std::tie(x, y); }
  auto sk_streams() { return std::tie(x, y); }

  using sk_State = std::tuple<Real>;
  static constexpr bool sk_isSeeded = false;
  sk_State sk_identity() const { return sk_State(Real(0)); }
  void sk_fold(sk_State& state) { std::get<0>(state) += x.at(sk_i) * y.at(sk_i); }
  void sk_combine(sk_State& state, const sk_State& later) { std::get<0>(state) += std::get<0>(later); }
  void sk_store(const native::Index& at, const sk_State& state) const { total.store(at, std::get<0>(state)); }
};

struct InOrder {
  Input<float> x;
  Output<float> last;
  native::Index sk_index{}, sk_extent{};
  int sk_i = 0;

  explicit InOrder(const Call& call) : x(call, 0), last(call, 1) {}

  static constexpr bool sk_isCommutative = false;
  static constexpr bool sk_isUneven = false;
  auto sk_streams() { return std::tie(x); }

  using sk_State = std::tuple<float>;
  static constexpr bool sk_isSeeded = true;
  sk_State sk_seed() const { return sk_State(x.at(sk_i)); }
  static void add(float& state, float later) { state = state * 0.75F + later; }
  void sk_fold(sk_State& state) { add(std::get<0>(state), x.at(sk_i)); }
  void sk_combine(sk_State& state, const sk_State& later) { add(std::get<0>(state), std::get<0>(later)); }
  void sk_store(const native::Index& at, const sk_State& state) const { last.store(at, std::get<0>(state)); }
};

struct Pair {
  Input<float> x;
  Output<float> total, last;
  native::Index sk_index{}, sk_extent{};
  int sk_i = 0;

  explicit Pair(const Call& call) : x(call, 0), total(call, 1), last(call, 2) {}

  static constexpr bool sk_isCommutative = true;
  static constexpr bool sk_isUneven = false;
  auto sk_streams() { return std::tie(x); }

  using sk_State = std::tuple<float, float>;
  static constexpr bool sk_isSeeded = false;
  sk_State sk_identity() const { return sk_State(0.0F, 1.0F); }
  static void add(sk_State& state, float a, float b) {
    std::get<0>(state) += a;
    std::get<1>(state) = b + 0.5F * std::get<1>(state);
  }
  void sk_fold(sk_State& state) { add(state, x.at(sk_i), x.at(sk_i)); }
  void sk_combine(sk_State& state, const sk_State& later) {
    add(state, std::get<0>(later), std::get<1>(later));
  }
  void sk_store(const native::Index& at, const sk_State& state) const {
    total.store(at, std::get<0>(state));
    last.store(at, std::get<1>(state));
  }
};

template <class Fold>
void run(const ReduceCall& call) {
  native::runReduction<Fold, Fold, &native::foldPieces<Fold, Fold>>(call);
}

}  // namespace

void templateSum(const ReduceCall& call) { run<Sum<float>>(call); }
void templateSumInDoubles(const ReduceCall& call) { run<Sum<double>>(call); }
void templateDotInDoubles(const ReduceCall& call) { run<Dot<double>>(call); }
void templateInOrder(const ReduceCall& call) { run<InOrder>(call); }
void templatePair(const ReduceCall& call) { run<Pair>(call); }

}  // namespace sk::test
