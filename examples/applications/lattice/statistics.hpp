// SPDX-License-Identifier: MIT
//
// What two runs of a chaotic system have in common where their numbers do not: the lengths in a pattern and its kind. On
// the host, of plane fields that wrap round, in double.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace examples {

struct PlaneField {
  std::int64_t width = 0, height = 0;
  std::span<const double> values;  ///< row by row
};

/// |DFT|^2 of the field without its mean, summed over rings of wave numbers: entry k has those with a length, in waves
/// per width, that rounds to k, up to half the shorter side. Direct sums, O(n^3), any size.
std::vector<double> radialSpectrum(const PlaneField& field);

/// width / (mean of k by power), in cells; 0 where nothing varies.
double wavelengthOf(const PlaneField& field);

/// Kinds of patterns, from coarse to fine in what tells them apart.
enum class Kind : std::uint8_t {
  Homogeneous,  ///< varies by less than 0.02
  Spots,  ///< islands above the middle of the range, round
  Worms,  ///< islands, long
  Network,  ///< one island has more than half of all that is above the middle, and more than a quarter of the plane
  Holes,  ///< islands below the middle of the range, round, in a sea above
};
std::string_view nameOf(Kind kind);

/// Islands are cells that share an edge; one is round where its outline squared is below 1.7 times that of a disc of
/// its area (whose outline along cells' edges is 4 / pi as long as it is).
Kind kindOf(const PlaneField& field);

}  // namespace examples
