// SPDX-License-Identifier: MIT
//
// Gray-Scott on the host: the named parameter sets, the first state, the limit of the time step, and the
// steps as plain loops in float or double. It shares no code with the kernels.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <sk/types.hpp>

namespace examples {

/// A class of patterns and a point (F, k) that shows it.
struct Pattern {
  std::string_view name;
  double feed;
  double kill;
  std::string_view looks;
};
std::span<const Pattern> patterns();
/// Throws std::runtime_error, listing the names, for an unknown one.
const Pattern& findPattern(std::string_view name);

/// What a run depends on, already rounded to what the device computes with.
struct Parameters {
  float feed;
  float kill;
  float spreadU;  ///< Du / dx^2
  float spreadV;  ///< Dv / dx^2
  float dt;
};

/// The largest stable time step of explicit Euler about u = 1, v = 0: the five-point Laplacian's
/// eigenvalues reach down to -8 / dx^2, so that 1 - dt (8 Du / dx^2 + F) must stay above -1.
double largestTimeStep(const Parameters& p);

/// u = 1, v = 0 with squares of (1/2, 1/4), both disturbed by 1 %: Pearson's first state, with `seeds` of
/// his squares of 20 x 20 points instead of one in the middle (1 gives his).
std::vector<sk::float2> firstState(int size, int seeds, std::uint32_t randomSeed);

/// u and v on a torus of size x size points in precision Real.
template <class Real>
class HostField {
 public:
  HostField(int size, std::span<const sk::float2> state);
  void advance(const Parameters& p);
  const std::vector<Real>& u() const { return u_; }
  const std::vector<Real>& v() const { return v_; }

 private:
  std::int64_t size_;
  std::vector<Real> u_, v_, nextU_, nextV_;
};

}  // namespace examples
