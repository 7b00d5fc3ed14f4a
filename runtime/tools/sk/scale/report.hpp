// SPDX-License-Identifier: MIT
//
// Presents predictions as a table, as JSON and as a chart. It computes nothing but how far devices pay.
#pragma once

#include <string>
#include <vector>

#include "accuracy/experiment.hpp"
#include "scale/model.hpp"
#include "scale/rates.hpp"

namespace sk_tool {

struct ScaleReport {
  std::string file, device;  ///< device: empty if every rate was given
  ScaledStep step;
  Cluster cluster;
  std::vector<Rate> rates;  ///< one for each call
  std::vector<BestOf> rows;  ///< by number of devices
  double bar = 0;  ///< the efficiency below which devices do not pay
};

/// The rows with the largest number of devices that pays and the first that does not after it; -1 if there is none.
struct PayingRows {
  int last = -1, first = -1;
};
PayingRows payingRows(const ScaleReport& report);

std::string textOf(const ScaleReport& report);
/// docs/domains.md lists the members.
Json jsonOf(const ScaleReport& report);
/// Efficiency over devices, one line for each number of dimensions that are split. Throws std::runtime_error.
void drawScaleChart(const std::string& file, const ScaleReport& report);

}  // namespace sk_tool
