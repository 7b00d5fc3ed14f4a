// SPDX-License-Identifier: MIT
//
// The gravity among n bodies, each upon each. floats: x, y, z and mass; the result is three numbers a body.
#include "programs/bodies.sk.hpp"

#include <cmath>

#include "constants.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

std::vector<sk::float4> bodiesOf(const Problem& p) {
  std::vector<sk::float4> bodies;
  for (std::size_t i = 0; i < p.floats[0].size(); ++i) {
    bodies.push_back({p.floats[0][i], p.floats[1][i], p.floats[2][i], p.floats[3][i]});
  }
  return bodies;
}

class Bodies final : public OurTask {
 public:
  Bodies(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        attract_(kernels::attract.with(options)),
        bodies_(filled<sk::float4>({p.size()}, bodiesOf(p))),
        accelerations_(device.stream<sk::float3>({p.size()})) {}

  std::vector<float> result() override { return flat(accelerations_.read()); }

 private:
  void once() override { attract_(softening, bodies_, bodies_, accelerations_); }

  kernels::AttractKernel attract_;
  sk::Stream<sk::float4> bodies_;
  sk::Stream<sk::float3> accelerations_;
};

}  // namespace

Problem bodiesProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1), numbers(p.size(), 2), numbers(p.size(), 3), numbers(p.size(), 4)};
  return p;
}

Check bodiesCheck(const Problem& p) {
  Check check{{}, {}, 1e-4};
  for (const std::int64_t place : somePlaces(p.size(), 256)) {
    const auto i = static_cast<std::size_t>(place);
    double sum[3] = {};
    for (std::size_t j = 0; j < p.floats[0].size(); ++j) {
      double way[3], squares = softening;
      for (std::size_t d = 0; d < 3; ++d) {
        way[d] = double{p.floats[d][j]} - p.floats[d][i];
        squares += way[d] * way[d];
      }
      for (std::size_t d = 0; d < 3; ++d) sum[d] += p.floats[3][j] * way[d] / (squares * std::sqrt(squares));
    }
    for (std::int64_t d = 0; d < 3; ++d) {
      check.places.push_back(3 * place + d);
      check.values.push_back(sum[d]);
    }
  }
  return check;
}

std::unique_ptr<Task> bodiesOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Bodies>(device, options, p);
}

}  // namespace race
