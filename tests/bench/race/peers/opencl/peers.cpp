// SPDX-License-Identifier: MIT
//
// The list of the peers written in OpenCL.
#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

RACE_ADD_PEERS(std::vector<race::Contender>& contenders) {
  using namespace race;
  const std::string& name = ClDevice::instance().name();
  contenders.push_back({"saxpy", name, saxpyOpenCl});
  contenders.push_back({"sum", name, sumOpenCl});
  contenders.push_back({"compensated sum", name, compensatedSumOpenCl});
  contenders.push_back({"dot", name, dotOpenCl});
  contenders.push_back({"5-point stencil", name, heatOpenCl});
  contenders.push_back({"9-point stencil", name, binomialOpenCl});
  contenders.push_back({"mandelbrot", name, mandelbrotOpenCl});
  contenders.push_back({"sgemv", name, gemvOpenCl});
  contenders.push_back({"sgemm", name, gemmOpenCl});
  contenders.push_back({"prefix scan", name, scanOpenCl});
  contenders.push_back({"sort", name, sortOpenCl});
  contenders.push_back({"n-body", name, bodiesOpenCl});
  contenders.push_back({"fft", name, fourierOpenCl});
  contenders.push_back({"gray-scott", name, reactionOpenCl});
  contenders.push_back({"sparse matrix", name, sparseOpenCl});
}
