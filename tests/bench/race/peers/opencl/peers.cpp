// SPDX-License-Identifier: MIT
//
// The list of the peers written in OpenCL.
#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

RACE_ADD_PEERS(contenders) {
  using namespace race;
  const std::string& name = ClDevice::instance().name();
  contenders.push_back({"saxpy", name, saxpyOpenCl});
  contenders.push_back({"sum", name, sumOpenCl});
  contenders.push_back({"compensated sum", name, compensatedSumOpenCl});
  contenders.push_back({"dot", name, dotOpenCl});
  contenders.push_back({"5-point stencil", name, heatOpenCl});
  contenders.push_back({"9-point stencil", name, binomialOpenCl});
  contenders.push_back({"mandelbrot", name, mandelbrotOpenCl});
}
