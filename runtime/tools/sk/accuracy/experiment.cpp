// SPDX-License-Identifier: MIT
#include "accuracy/experiment.hpp"

#include <algorithm>
#include <cmath>

namespace sk_tool {

namespace {

bool dominates(const Row& a, const Row& b) {
  const bool isNoWorse = a.time.median <= b.time.median && a.grade.error() <= b.grade.error();
  return isNoWorse && (a.time.median < b.time.median || a.grade.error() < b.grade.error());
}

/// A number, or null if it is not finite, because JSON has no infinity.
Json numberOf(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json recordOf(const Experiment& experiment, const Row& row) {
  Json record = {{"program", experiment.program}, {"data", experiment.data}, {"mode", row.mode}};
  if (row.isRefused()) {
    record["refused"] = row.refused;
    return record;
  }
  record["baseline"] = experiment.rows.front().mode;
  record["time"] = {{"ratio", row.time.median},
                    {"lower_quartile", row.time.lower},
                    {"upper_quartile", row.time.upper},
                    {"milliseconds", row.time.milliseconds},
                    {"ratios", row.time.rounds}};
  for (const Metric& metric : row.grade.metrics) record["metrics"][metric.name] = numberOf(metric.value);
  for (const OutputErrors& output : row.grade.outputs) {
    Json& one = record["outputs"][output.name];
    for (const Metric& metric : output.metrics) one["metrics"][metric.name] = numberOf(metric.value);
    one["worst"] = output.worst;
  }
  if (row.grade.bound) {
    record["bound"] = numberOf(*row.grade.bound);
    record["bounded"] = experiment.bounded;
  }
  record["within_bound"] = row.grade.isWithinBound;
  record["pareto"] = row.isPareto;
  if (!row.grade.worst.is_null()) record["worst"] = row.grade.worst;
  if (const auto& extremes = row.grade.extremes) {
    record["extremes"] = {{"tried", extremes->tried},
                          {"other_class", extremes->otherClass},
                          {"other_value", extremes->otherValue}};
    if (!extremes->example.is_null()) record["extremes"]["example"] = extremes->example;
  }
  return record;
}

}  // namespace

void markPareto(std::vector<Row>& rows) {
  for (Row& row : rows) {
    row.isPareto = !row.isRefused() && std::isfinite(row.grade.error()) &&
                   std::none_of(rows.begin(), rows.end(), [&](const Row& other) {
                     return !other.isRefused() && dominates(other, row);
                   });
  }
}

const Row* cheapestWithin(const Experiment& experiment, double tolerance) {
  const Row* cheapest = nullptr;
  for (const Row& row : experiment.rows) {
    if (row.isRefused() || !(row.grade.error() <= tolerance)) continue;
    if (cheapest == nullptr || row.time.median < cheapest->time.median) cheapest = &row;
  }
  return cheapest;
}

void addRecords(Json& records, const Experiment& experiment) {
  for (const Row& row : experiment.rows) records.push_back(recordOf(experiment, row));
}

}  // namespace sk_tool
