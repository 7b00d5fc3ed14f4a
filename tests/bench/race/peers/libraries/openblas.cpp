// SPDX-License-Identifier: MIT
//
// Products of matrices by OpenBLAS.
#include <cblas.h>

#include "peers/cpu_task.hpp"

namespace race {
namespace {

void gemv(const Problem& p, float* y) {
  cblas_sgemv(CblasRowMajor, CblasNoTrans, static_cast<int>(p.rows), static_cast<int>(p.columns), 1,
              p.floats[0].data(), static_cast<int>(p.columns), p.floats[1].data(), 1, 0, y, 1);
}

void gemm(const Problem& p, float* c) {
  const auto rows = static_cast<int>(p.rows), columns = static_cast<int>(p.columns);
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, rows, columns, columns, 1, p.floats[0].data(),
              columns, p.floats[1].data(), columns, 0, c, columns);
}

void dot(const Problem& p, float* total) {
  *total = cblas_sdot(static_cast<int>(p.size()), p.floats[0].data(), 1, p.floats[1].data(), 1);
}

}  // namespace
}  // namespace race

RACE_ADD_PEERS(std::vector<race::Contender>& contenders) {
  using namespace race;
  contenders.push_back(onCpu("dot", "OpenBLAS", one, dot));
  contenders.push_back(onCpu("sgemv", "OpenBLAS", [](const Problem& p) { return p.rows; }, gemv));
  contenders.push_back(onCpu("sgemm", "OpenBLAS", asMany, gemm));
}
