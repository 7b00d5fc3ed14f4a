// SPDX-License-Identifier: MIT
//
// A step of a cloth as plain loops: an array for each coordinate, and for each of the links along a row one loop without a
// condition, so that it vectorises.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {
namespace {

using Reals = std::vector<float>;
using Three = std::array<Reals, 3>;

class ClothOpenMp final : public Task {
 public:
  explicit ClothOpenMp(const Problem& p) : rows_(p.rows), columns_(p.columns) {
    const auto n = static_cast<std::size_t>(p.size());
    for (Three* list : {&from_, &moved_, &at_, &by_, &next_}) list->fill(Reals(n));
    weight_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        from_[k][i] = p.floats[0][4 * i + k];
        moved_[k][i] = p.floats[1][3 * i + k];
      }
      weight_[i] = p.floats[0][4 * i + 3];
    }
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i) {
      integrate();
      for (int round = 0; round < clothRounds; ++round) relax();
      collide();
    }
  }

  std::vector<float> result() override {
    Reals all;
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      all.insert(all.end(), {at_[0][i], at_[1][i], at_[2][i], weight_[i]});
    }
    for (std::size_t i = 0; i < weight_.size(); ++i) all.insert(all.end(), {by_[0][i], by_[1][i], by_[2][i]});
    return all;
  }

 private:
  void integrate() {
    const float fall[3] = {0, clothFall, 0};
#pragma omp parallel for
    for (std::int64_t y = 0; y < rows_; ++y) {
      const float* w = &weight_[static_cast<std::size_t>(y * columns_)];
      for (std::size_t k = 0; k < 3; ++k) {
        const float *from = row(from_, k, y), *moved = row(moved_, k, y);
        float *at = row(at_, k, y), *by = row(by_, k, y);
#pragma omp simd
        for (std::int64_t x = 0; x < columns_; ++x) {
          by[x] = w[x] > 0 ? clothKeep * moved[x] + fall[k] : 0.0f;
          at[x] = from[x] + by[x];
        }
      }
    }
  }

  void relax() {
#pragma omp parallel
    {
      const auto columns = static_cast<std::size_t>(columns_);
      Reals pulls[3] = {Reals(columns), Reals(columns), Reals(columns)};
#pragma omp for
      for (std::int64_t y = 0; y < rows_; ++y) {
        for (Reals& pull : pulls) std::fill(pull.begin(), pull.end(), 0.0f);
        for (const ClothLink& link : clothLinks) {
          if (y + link.y >= 0 && y + link.y < rows_)
            pullAlong(y, link, pulls[0].data(), pulls[1].data(), pulls[2].data());
        }
        for (std::size_t k = 0; k < 3; ++k) {
          const float *at = row(at_, k, y), *pull = pulls[k].data();
          float *next = row(next_, k, y), *by = row(by_, k, y);
#pragma omp simd
          for (std::int64_t x = 0; x < columns_; ++x) {
            next[x] = at[x] + pull[x];
            by[x] += pull[x];
          }
        }
      }
    }
    std::swap(at_, next_);
  }

  /// One link of every point of a row that has it.
  void pullAlong(std::int64_t y, const ClothLink& link, float* pullX, float* pullY, float* pullZ) const {
    const float *x0 = row(at_, 0, y), *y0 = row(at_, 1, y), *z0 = row(at_, 2, y);
    const std::int64_t other = y + link.y, to = link.x;
    const float *x1 = row(at_, 0, other) + to, *y1 = row(at_, 1, other) + to, *z1 = row(at_, 2, other) + to;
    const float* w0 = &weight_[static_cast<std::size_t>(y * columns_)];
    const float* w1 = &weight_[static_cast<std::size_t>(other * columns_)] + to;
    const std::int64_t begin = std::max<std::int64_t>(0, -to), end = std::min(columns_, columns_ - to);
#pragma omp simd
    for (std::int64_t x = begin; x < end; ++x) {
      const float dx = x1[x] - x0[x], dy = y1[x] - y0[x], dz = z1[x] - z0[x];
      const float share = w0[x] / std::max(w0[x] + w1[x], 1e-37f);
      const float pull = link.factor * share * (1 - link.rest / std::sqrt(dx * dx + dy * dy + dz * dz));
      pullX[x] += pull * dx;
      pullY[x] += pull * dy;
      pullZ[x] += pull * dz;
    }
  }

  void collide() {
#pragma omp parallel for
    for (std::int64_t y = 0; y < rows_; ++y) {
      const float* w = &weight_[static_cast<std::size_t>(y * columns_)];
      float *atX = row(at_, 0, y), *atY = row(at_, 1, y), *atZ = row(at_, 2, y);
      float *byX = row(by_, 0, y), *byY = row(by_, 1, y), *byZ = row(by_, 2, y);
#pragma omp simd
      for (std::int64_t x = 0; x < columns_; ++x) {
        const float dx = atX[x] - clothBall[0], dy = atY[x] - clothBall[1], dz = atZ[x] - clothBall[2];
        const float l = std::sqrt(dx * dx + dy * dy + dz * dz);
        const float depth = w[x] > 0 ? std::max(clothBall[3] + clothThickness - l, 0.0f) : 0.0f;
        const float inward = depth > 0 ? std::min((byX[x] * dx + byY[x] * dy + byZ[x] * dz) / l, 0.0f) : 0.0f;
        const float out = depth / l, back = inward / l;
        atX[x] += out * dx;
        atY[x] += out * dy;
        atZ[x] += out * dz;
        byX[x] -= back * dx;
        byY[x] -= back * dy;
        byZ[x] -= back * dz;
        const bool isBelow = w[x] > 0 && atY[x] < clothThickness;
        atY[x] = isBelow ? clothThickness : atY[x];
        byY[x] = isBelow ? std::max(byY[x], 0.0f) : byY[x];
      }
    }
  }

  const float* row(const Three& list, std::size_t k, std::int64_t y) const {
    return list[k].data() + y * columns_;
  }
  float* row(Three& list, std::size_t k, std::int64_t y) const { return list[k].data() + y * columns_; }

  std::int64_t rows_, columns_;
  Three from_, moved_, at_, by_, next_;
  Reals weight_;
};

}  // namespace

std::unique_ptr<Task> clothOpenMp(const Problem& p) { return std::make_unique<ClothOpenMp>(p); }

}  // namespace race
