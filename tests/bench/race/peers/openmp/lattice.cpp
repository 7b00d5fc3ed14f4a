// SPDX-License-Identifier: MIT
//
// Steps of coupled map lattices as plain loops: each row's inside without a condition, so that it vectorises, and its two ends by
// themselves.
#include <algorithm>
#include <cmath>
#include <vector>

#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {
namespace {

/// cell(left, x, right) for each column of a row that wraps.
template <class Cell>
inline void alongRow(std::int64_t columns, const Cell& cell) {
  cell(columns - 1, std::int64_t{0}, std::int64_t{1});
#pragma omp simd
  for (std::int64_t x = 1; x < columns - 1; ++x) cell(x - 1, x, x + 1);
  cell(columns - 2, columns - 1, std::int64_t{0});
}

using Reals = std::vector<float>;

const float* rowOf(const Reals& field, std::int64_t columns, std::int64_t y) {
  return field.data() + y * columns;
}
float* rowOf(Reals& field, std::int64_t columns, std::int64_t y) { return field.data() + y * columns; }

/// The row behind a wall at `held`: 2 held - the row beside it.
void mirror(const float* beside, float held, std::int64_t columns, float* row) {
  for (std::int64_t x = 0; x < columns; ++x) row[x] = 2 * held - beside[x];
}

class BoilingOpenMp final : public Task {
 public:
  explicit BoilingOpenMp(const Problem& p)
      : rows_(p.rows),
        columns_(p.columns),
        before_(p.floats[0]),
        warm_(p.floats[0]),
        dense_(p.floats[0]),
        after_(p.floats[0]),
        next_(p.floats[0]),
        below_(columns(p)),
        above_(columns(p)) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) step();
  }
  std::vector<float> result() override { return next_; }

 private:
  static std::size_t columns(const Problem& p) { return static_cast<std::size_t>(p.columns); }

  void step() {
    diffuse();
    rise();
    exchange();
  }

  /// Rows below and above y, those behind the walls included, which must be up to date.
  const float* under(const Reals& field, std::int64_t y) const {
    return y == 0 ? below_.data() : rowOf(field, columns_, y - 1);
  }
  const float* over(const Reals& field, std::int64_t y) const {
    return y == rows_ - 1 ? above_.data() : rowOf(field, columns_, y + 1);
  }

  void diffuse() {
    mirror(rowOf(before_, columns_, 0), boilingBottom, columns_, below_.data());
    mirror(rowOf(before_, columns_, rows_ - 1), boilingTop, columns_, above_.data());
#pragma omp parallel for
    for (std::int64_t y = 0; y < rows_; ++y) {
      const float *t = rowOf(before_, columns_, y), *low = under(before_, y), *high = over(before_, y);
      float *r = rowOf(warm_, columns_, y), *d = rowOf(dense_, columns_, y);
      alongRow(columns_, [&](std::int64_t left, std::int64_t x, std::int64_t right) {
        r[x] = t[x] + boilingSpread * (t[left] + t[right] + low[x] + high[x] - 4 * t[x]);
      });
      for (std::int64_t x = 0; x < columns_; ++x) d[x] = std::tanh(boilingAlpha * (r[x] - boilingPoint));
    }
  }

  /// Densities are found once a cell; behind the walls they are those of the cells there.
  void rise() {
#pragma omp parallel for
    for (std::int64_t y = 0; y < rows_; ++y) {
      const float* t = rowOf(warm_, columns_, y);
      const float* low = rowOf(dense_, columns_, std::max<std::int64_t>(y - 1, 0));
      const float* high = rowOf(dense_, columns_, std::min(y + 1, rows_ - 1));
      float* r = rowOf(after_, columns_, y);
#pragma omp simd
      for (std::int64_t x = 0; x < columns_; ++x)
        r[x] = t[x] - 0.5f * boilingSigma * t[x] * (high[x] - low[x]);
    }
  }

  void exchange() {
    const auto turned = [](float before, float after) {
      return (after > boilingPoint ? 1.0f : 0.0f) - (before > boilingPoint ? 1.0f : 0.0f);
    };
#pragma omp parallel for
    for (std::int64_t y = 0; y < rows_; ++y) {
      const float *b = rowOf(before_, columns_, y), *a = rowOf(after_, columns_, y);
      float* r = rowOf(next_, columns_, y);
      alongRow(columns_, [&](std::int64_t left, std::int64_t x, std::int64_t right) {
        r[x] = a[x] - boilingLatent * (turned(b[left], a[left]) + turned(b[right], a[right]));
      });
      for (const std::int64_t other : {y - 1, y + 1}) {
        if (other < 0 || other >= rows_) continue;
        const float *otherB = rowOf(before_, columns_, other), *otherA = rowOf(after_, columns_, other);
#pragma omp simd
        for (std::int64_t x = 0; x < columns_; ++x) r[x] -= boilingLatent * turned(otherB[x], otherA[x]);
      }
    }
  }

  std::int64_t rows_, columns_;
  Reals before_, warm_, dense_, after_, next_, below_, above_;
};

class ConvectionOpenMp final : public Task {
 public:
  explicit ConvectionOpenMp(const Problem& p)
      : rows_(p.rows),
        columns_(p.columns),
        u_(p.floats[0]),
        v_(p.floats[1]),
        p_(p.floats[2]),
        t_(p.floats[3]),
        nextU_(u_),
        nextV_(v_),
        nextP_(p_),
        nextT_(t_),
        still_(static_cast<std::size_t>(p.columns)) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) {
      push();
      convect();
    }
  }
  std::vector<float> result() override {
    Reals all;
    for (const Reals* field : {&nextU_, &nextV_, &nextP_, &nextT_})
      all.insert(all.end(), field->begin(), field->end());
    return all;
  }

 private:
  const float* wrapped(const Reals& field, std::int64_t y) const {
    return rowOf(field, columns_, (y + rows_) % rows_);
  }

  void push() {
    const float slope = -1.0f / static_cast<float>(rows_);
#pragma omp parallel
    {
      Reals below(static_cast<std::size_t>(columns_)), above(below);
#pragma omp for
      for (std::int64_t y = 0; y < rows_; ++y) {
        const float *u = wrapped(u_, y), *uSouth = wrapped(u_, y - 1), *uNorth = wrapped(u_, y + 1);
        const float *v = wrapped(v_, y), *vSouth = wrapped(v_, y - 1), *vNorth = wrapped(v_, y + 1);
        const float *p = wrapped(p_, y), *pSouth = wrapped(p_, y - 1), *t = wrapped(t_, y),
                    *tSouth = wrapped(t_, y - 1);
        if (y == 0) mirror(u, 0, columns_, below.data());
        if (y == rows_ - 1) mirror(u, 0, columns_, above.data());
        const float *under = y == 0 ? below.data() : uSouth, *over = y == rows_ - 1 ? above.data() : uNorth;
        float *nextU = rowOf(nextU_, columns_, y), *nextV = rowOf(nextV_, columns_, y);
        const float rest = flowRest + slope * static_cast<float>(y);
        alongRow(columns_, [&](std::int64_t west, std::int64_t x, std::int64_t east) {
          const float uu = (u[x] + u[east]) * (u[x] + u[east]) - (u[west] + u[x]) * (u[west] + u[x]);
          const float uv =
              (u[x] + uNorth[x]) * (vNorth[x] + vNorth[west]) - (uSouth[x] + u[x]) * (v[x] + v[west]);
          nextU[x] =
              u[x] - flowCarry * (0.25f * (uu + uv) + p[x] - p[west]) +
              flowViscosity * (u[west] + u[east] + under[x] + over[x] - 4 * u[x]) +
              flowDamping * (u[east] - 2 * u[x] + u[west] + (vNorth[x] - v[x]) - (vNorth[west] - v[west]));
        });
        if (y == 0) {
          std::fill_n(nextV, columns_, 0.0f);
          continue;
        }
        alongRow(columns_, [&](std::int64_t west, std::int64_t x, std::int64_t east) {
          const float vv = (v[x] + vNorth[x]) * (v[x] + vNorth[x]) - (vSouth[x] + v[x]) * (vSouth[x] + v[x]);
          const float vu =
              (v[x] + v[east]) * (u[east] + uSouth[east]) - (v[west] + v[x]) * (u[x] + uSouth[x]);
          const float warmth = 0.5f * (t[x] + tSouth[x]) - rest;
          nextV[x] = v[x] - flowCarry * (0.25f * (vv + vu) + p[x] - pSouth[x]) +
                     flowViscosity * (v[west] + v[east] + vSouth[x] + vNorth[x] - 4 * v[x]) +
                     flowDamping *
                         (vNorth[x] - 2 * v[x] + vSouth[x] + (u[east] - u[x]) - (uSouth[east] - uSouth[x])) +
                     flowLift * warmth;
        });
      }
    }
  }

  void convect() {
#pragma omp parallel
    {
      Reals below(static_cast<std::size_t>(columns_)), above(below);
#pragma omp for
      for (std::int64_t y = 0; y < rows_; ++y) {
        const float *t = rowOf(t_, columns_, y), *p = rowOf(p_, columns_, y);
        if (y == 0) mirror(t, 1, columns_, below.data());
        if (y == rows_ - 1) mirror(t, 0, columns_, above.data());
        const float* low = y == 0 ? below.data() : rowOf(t_, columns_, y - 1);
        const float* high = y == rows_ - 1 ? above.data() : rowOf(t_, columns_, y + 1);
        const float *u = rowOf(nextU_, columns_, y), *v = rowOf(nextV_, columns_, y);
        const float* vNorth = y == rows_ - 1 ? still_.data() : rowOf(nextV_, columns_, y + 1);
        float *nextT = rowOf(nextT_, columns_, y), *nextP = rowOf(nextP_, columns_, y);
        alongRow(columns_, [&](std::int64_t west, std::int64_t x, std::int64_t east) {
          const float lap = t[west] + t[east] + low[x] + high[x] - 4 * t[x];
          const float carried = u[east] * (t[x] + t[east]) - u[x] * (t[west] + t[x]) +
                                vNorth[x] * (t[x] + high[x]) - v[x] * (low[x] + t[x]);
          nextT[x] = t[x] + flowSpread * lap - 0.5f * flowCarry * carried;
          nextP[x] = p[x] - flowStiffness * ((u[east] - u[x]) + (vNorth[x] - v[x]));
        });
      }
    }
  }

  std::int64_t rows_, columns_;
  Reals u_, v_, p_, t_, nextU_, nextV_, nextP_, nextT_, still_;
};

class ReactionStepOpenMp final : public Task {
 public:
  explicit ReactionStepOpenMp(const Problem& p)
      : rows_(p.rows), columns_(p.columns), u_(p.floats[0]), v_(p.floats[1]), nextU_(u_), nextV_(v_) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) step();
  }
  std::vector<float> result() override {
    Reals all = nextU_;
    all.insert(all.end(), nextV_.begin(), nextV_.end());
    return all;
  }

 private:
  void step() {
#pragma omp parallel for
    for (std::int64_t y = 0; y < rows_; ++y) {
      const std::int64_t below = y == 0 ? rows_ - 1 : y - 1, above = y + 1 == rows_ ? 0 : y + 1;
      const float *u = rowOf(u_, columns_, y), *uLow = rowOf(u_, columns_, below),
                  *uHigh = rowOf(u_, columns_, above);
      const float *v = rowOf(v_, columns_, y), *vLow = rowOf(v_, columns_, below),
                  *vHigh = rowOf(v_, columns_, above);
      float *nextU = rowOf(nextU_, columns_, y), *nextV = rowOf(nextV_, columns_, y);
      alongRow(columns_, [&](std::int64_t left, std::int64_t x, std::int64_t right) {
        const float made = u[x] * v[x] * v[x];
        const float lapU = u[left] + u[right] + uLow[x] + uHigh[x] - 4 * u[x];
        const float lapV = v[left] + v[right] + vLow[x] + vHigh[x] - 4 * v[x];
        nextU[x] = u[x] + reactionSpreadU * lapU - made + reactionFeed * (1 - u[x]);
        nextV[x] = v[x] + reactionSpreadV * lapV + made - (reactionFeed + reactionKill) * v[x];
      });
    }
  }

  std::int64_t rows_, columns_;
  Reals u_, v_, nextU_, nextV_;
};

}  // namespace

std::unique_ptr<Task> boilingOpenMp(const Problem& p) { return std::make_unique<BoilingOpenMp>(p); }
std::unique_ptr<Task> convectionOpenMp(const Problem& p) { return std::make_unique<ConvectionOpenMp>(p); }
std::unique_ptr<Task> reactionStepOpenMp(const Problem& p) { return std::make_unique<ReactionStepOpenMp>(p); }

}  // namespace race
