// SPDX-License-Identifier: MIT
#include "peers/opencl/device.hpp"

#include <array>
#include <stdexcept>

namespace race {
namespace {

void check(cl_int status, const char* call) {
  if (status != CL_SUCCESS) {
    throw std::runtime_error(std::string("OpenCL: ") + call + " fails with " + std::to_string(status));
  }
}

}  // namespace

const ClDevice& ClDevice::instance() {
  static const auto* device = new ClDevice;
  return *device;
}

ClDevice::ClDevice() {
  cl_platform_id platform = nullptr;
  cl_uint count = 0;
  check(clGetPlatformIDs(1, &platform, &count), "clGetPlatformIDs");
  check(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &id_, &count), "clGetDeviceIDs");
  std::array<char, 256> text{};
  check(clGetPlatformInfo(platform, CL_PLATFORM_NAME, text.size() - 1, text.data(), nullptr),
        "clGetPlatformInfo");
  name_ = std::string(text.data()) == "Portable Computing Language" ? "PoCL" : "OpenCL";
  cl_uint units = 0;
  check(clGetDeviceInfo(id_, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof units, &units, nullptr), "clGetDeviceInfo");
  units_ = units;
  cl_int status = CL_SUCCESS;
  context_ = clCreateContext(nullptr, 1, &id_, nullptr, nullptr, &status);
  check(status, "clCreateContext");
  queue_ = clCreateCommandQueue(context_, id_, 0, &status);
  check(status, "clCreateCommandQueue");
}

ClBuffer::ClBuffer(std::size_t bytes, const void* content) {
  cl_int status = CL_SUCCESS;
  memory_ = clCreateBuffer(ClDevice::instance().context(), CL_MEM_READ_WRITE, bytes, nullptr, &status);
  check(status, "clCreateBuffer");
  if (content == nullptr) return;
  check(clEnqueueWriteBuffer(ClDevice::instance().queue(), memory_, CL_TRUE, 0, bytes, content, 0, nullptr,
                             nullptr),
        "clEnqueueWriteBuffer");
}

ClBuffer::~ClBuffer() { clReleaseMemObject(memory_); }

std::vector<float> ClBuffer::readFloats(std::size_t count) const {
  std::vector<float> values(count);
  check(clEnqueueReadBuffer(ClDevice::instance().queue(), memory_, CL_TRUE, 0, count * sizeof(float),
                            values.data(), 0, nullptr, nullptr),
        "clEnqueueReadBuffer");
  return values;
}

cl_program ClDevice::programOf(const std::string& text) const {
  if (const auto found = programs_.find(text); found != programs_.end()) return found->second;
  const char* source = text.c_str();
  cl_int status = CL_SUCCESS;
  const cl_program program = clCreateProgramWithSource(context_, 1, &source, nullptr, &status);
  check(status, "clCreateProgramWithSource");
  if (clBuildProgram(program, 1, &id_, "-cl-std=CL1.2 -w", nullptr, nullptr) != CL_SUCCESS) {
    std::array<char, 4096> log{};
    clGetProgramBuildInfo(program, id_, CL_PROGRAM_BUILD_LOG, log.size() - 1, log.data(), nullptr);
    throw std::runtime_error(std::string("OpenCL: a kernel does not compile: ") + log.data());
  }
  return programs_[text] = program;
}

ClKernel::ClKernel(const std::string& text, const char* name) {
  cl_int status = CL_SUCCESS;
  kernel_ = clCreateKernel(ClDevice::instance().programOf(text), name, &status);
  check(status, "clCreateKernel");
}

ClKernel::~ClKernel() { clReleaseKernel(kernel_); }

ClKernel& ClKernel::over(std::vector<std::size_t> global, std::vector<std::size_t> local) {
  global_ = std::move(global);
  local_ = std::move(local);
  return *this;
}

void ClKernel::enqueue() const {
  check(clEnqueueNDRangeKernel(ClDevice::instance().queue(), kernel_, static_cast<cl_uint>(global_.size()),
                               nullptr, global_.data(), local_.empty() ? nullptr : local_.data(), 0, nullptr,
                               nullptr),
        "clEnqueueNDRangeKernel");
}

void ClKernel::set(cl_uint index, const ClBuffer& buffer) {
  const cl_mem memory = buffer.get();
  check(clSetKernelArg(kernel_, index, sizeof(cl_mem), static_cast<const void*>(&memory)), "clSetKernelArg");
}

void ClKernel::set(cl_uint index, float value) {
  check(clSetKernelArg(kernel_, index, sizeof value, &value), "clSetKernelArg");
}

void ClKernel::set(cl_uint index, std::int32_t value) {
  check(clSetKernelArg(kernel_, index, sizeof value, &value), "clSetKernelArg");
}

void ClKernel::set(cl_uint index, const cl_float4& value) {
  check(clSetKernelArg(kernel_, index, sizeof value, &value), "clSetKernelArg");
}

void ClTask::run(int times) {
  for (int i = 0; i < times; ++i) once();
  check(clFinish(ClDevice::instance().queue()), "clFinish");
}

}  // namespace race
