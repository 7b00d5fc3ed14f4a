// SPDX-License-Identifier: MIT
//
// The little of OpenCL that peers need, on the first device that there is: PoCL's, on a machine without a GPU.
// Everything throws std::runtime_error with the call that failed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include "contender.hpp"

namespace race {

class ClDevice {
 public:
  /// The one of this process. It stays until the end: PoCL's threads do not like to be gone before static objects are.
  static const ClDevice& instance();

  /// "PoCL", or "OpenCL" on another platform.
  const std::string& name() const { return name_; }
  /// Work items that run at once.
  std::size_t units() const { return units_; }
  cl_context context() const { return context_; }
  cl_command_queue queue() const { return queue_; }
  /// The compiled program of a text, which is kept. Throws std::runtime_error with what the compiler said.
  cl_program programOf(const std::string& text) const;

 private:
  ClDevice();

  std::string name_;
  std::size_t units_ = 0;
  cl_device_id id_ = nullptr;
  cl_context context_ = nullptr;
  cl_command_queue queue_ = nullptr;
  mutable std::map<std::string, cl_program> programs_;
};

class ClBuffer {
 public:
  explicit ClBuffer(std::size_t bytes, const void* content = nullptr);
  template <class T>
  explicit ClBuffer(const std::vector<T>& content) : ClBuffer(content.size() * sizeof(T), content.data()) {}
  ~ClBuffer();
  ClBuffer(const ClBuffer&) = delete;
  ClBuffer& operator=(const ClBuffer&) = delete;

  cl_mem get() const { return memory_; }
  std::vector<float> readFloats(std::size_t count) const;

 private:
  cl_mem memory_ = nullptr;
};

/// A kernel with its arguments and its domain.
class ClKernel {
 public:
  /// The kernel `name` of a text, which is compiled once.
  ClKernel(const std::string& text, const char* name);
  ~ClKernel();
  ClKernel(const ClKernel&) = delete;
  ClKernel& operator=(const ClKernel&) = delete;

  template <class... Arguments>
  ClKernel& with(const Arguments&... arguments) {
    cl_uint index = 0;
    (set(index++, arguments), ...);
    return *this;
  }
  /// Extents, x first; `local` none: the implementation chooses.
  ClKernel& over(std::vector<std::size_t> global, std::vector<std::size_t> local = {});

  void enqueue() const;

 private:
  void set(cl_uint index, const ClBuffer& buffer);
  void set(cl_uint index, float value);
  void set(cl_uint index, std::int32_t value);
  void set(cl_uint index, const cl_float4& value);

  cl_kernel kernel_ = nullptr;
  std::vector<std::size_t> global_, local_;
};

/// A task that enqueues what `once()` says, and waits.
class ClTask : public Task {
 public:
  void run(int times) final;

 protected:
  virtual void once() = 0;
};

/// A task of kernels, one after the other, that is put together like a list.
class ClSteps final : public ClTask {
 public:
  template <class Content>
  const ClBuffer& buffer(const Content& content) {
    return buffers_.emplace_back(content);
  }
  ClKernel& step(const char* text, const char* name) { return steps_.emplace_back(text, name); }
  /// What result() reads.
  void gives(const ClBuffer& result, std::size_t size) {
    result_ = &result;
    size_ = size;
  }

  std::vector<float> result() override { return result_->readFloats(size_); }

 private:
  void once() override {
    for (const ClKernel& step : steps_) step.enqueue();
  }

  std::deque<ClBuffer> buffers_;
  std::deque<ClKernel> steps_;
  const ClBuffer* result_ = nullptr;
  std::size_t size_ = 0;
};

inline std::size_t sizeOf(const Problem& problem) { return static_cast<std::size_t>(problem.size()); }
inline std::size_t bytesOf(const Problem& problem) { return sizeOf(problem) * sizeof(float); }

}  // namespace race
