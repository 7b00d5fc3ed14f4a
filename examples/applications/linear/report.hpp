// SPDX-License-Identifier: MIT
//
// What a solve has come to, for people and for programs, and charts of its residuals over iterations with a logarithmic scale.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "layout.hpp"
#include "preconditioner.hpp"
#include "solve.hpp"
#include "system.hpp"

namespace linear {

using namespace sk::linear;

struct Account {
  std::string system;
  std::int64_t unknowns = 0;
  std::int64_t entries = 0;
  std::string device;
  std::string layout = "none";
  std::int64_t stored = 0;  ///< entries that the layout holds; 0 if it holds none
  std::string offsetBits;  ///< Matrix::offsetBits
  std::vector<LayoutCost> costs;  ///< of the automatic choice
  std::vector<LevelRate> rates;  ///< of multigrid on its grids, where they were measured
  std::optional<HierarchyAccount> hierarchy;  ///< of the preconditioner
  std::optional<System::Bandwidths> bandwidths;  ///< if the unknowns were reordered
  std::string factors;  ///< of a direct solution, "L D L^T" or "L U"; "" if there was none
  std::int64_t factorEntries = 0;  ///< theirs
  std::optional<double> distance;  ///< ||x - y|| / ||y|| from the direct solution y

  /// Stored entries for each entry of the matrix; 0 if none is stored.
  double fill() const {
    return entries > 0 ? static_cast<double>(stored) / static_cast<double>(entries) : 0.0;
  }
};

std::string textOf(const Account& account, const Solution& solution);
/// An object with outcome, iterations, restarts, residual_true, residual_error (a bound of the error of residual_true, in its unit), residual_recurred, backward_error, removed_mean, seconds, layout, fill, device and rates: the mean
/// reduction of the residual `per_iteration`, and for each of multigrid's grids its extents, the fastest first, and the rate of a cycle. Numbers that are not
/// finite are null. For a preconditioner that has built levels, also hierarchy: levels (unknowns, entries and layout of each), operator_complexity and
/// setup_seconds; for reordered unknowns, bandwidth before and after; for a layout with offsets, offset_bits; for a direct solution, factors and factor_entries, and distance_to_direct of the iterative one.
std::string jsonOf(const Account& account, const Solution& solution);

/// A chart for the terminal. Lines of text, each ended; "" if there are fewer than two points.
std::string textChart(std::span<const HistoryPoint> history, double tolerance);
/// A whole SVG document.
std::string svgChart(std::span<const HistoryPoint> history, double tolerance, const std::string& title);

}  // namespace linear
