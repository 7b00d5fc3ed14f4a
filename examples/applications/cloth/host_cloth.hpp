// SPDX-License-Identifier: MIT
//
// The same steps as plain loops over arrays, in float or double: what the device is verified against. It shares the
// constants with the kernels, and no code.
#pragma once

#include <cstdint>
#include <vector>

#include "model.hpp"
#include "support/vec.hpp"

namespace examples {

template <class Real>
class HostCloth {
 public:
  HostCloth(const Scene& scene, const Constants& constants);
  HostCloth(const Scene& scene, const Constants& constants, const FirstState& first);

  void advance(std::int64_t steps);

  std::int64_t step() const { return step_; }
  const std::vector<Vec<Real>>& positions() const { return at_; }
  /// Whether a link of a point, by its bit, still holds.
  const std::vector<std::int32_t>& alive() const { return alive_; }

 private:
  Vec<Real> pull(std::size_t i, const LinkConstants& k, const LinkKinds& kinds, bool springs) const;
  Vec<Real> wind(std::size_t i, const Vec<Real>& last, Real phase) const;
  bool neighbour(std::size_t i, int link, std::size_t& other) const;
  void integrate(const Moment& moment);
  void relax();
  void collide(const Moment& moment);
  void touch(const Body& body, const Placed& placed, Vec<Real>& at, Vec<Real>& by) const;
  void tear();

  Scene scene_;
  Features features_;
  Constants constants_;
  std::int64_t step_ = 0;
  std::vector<Vec<Real>> at_, next_;
  std::vector<Vec<Real>> last_;  ///< displacements, or the positions before
  std::vector<Real> weight_;
  std::vector<std::int32_t> alive_, left_, pin_;
};

}  // namespace examples
