// SPDX-License-Identifier: MIT
//
// The Fourier transform by FFTW, whose plan is measured beforehand.
#include <fftw3.h>

#include <algorithm>
#include <stdexcept>
#include <thread>

#include "contender.hpp"

namespace race {
namespace {

class Transform final : public Task {
 public:
  explicit Transform(const Problem& p)
      : size_(p.floats[0].size()), x_(fftwf_alloc_real(size_)), y_(fftwf_alloc_real(size_)) {
    fftwf_init_threads();
    fftwf_plan_with_nthreads(static_cast<int>(std::thread::hardware_concurrency()));
    plan_ = fftwf_plan_dft_1d(static_cast<int>(p.size()), reinterpret_cast<fftwf_complex*>(x_),
                              reinterpret_cast<fftwf_complex*>(y_), FFTW_FORWARD,
                              FFTW_MEASURE | FFTW_PRESERVE_INPUT);
    if (plan_ == nullptr) throw std::runtime_error("FFTW has no plan");
    std::copy(p.floats[0].begin(), p.floats[0].end(), x_);  // measuring overwrote it
  }
  ~Transform() override {
    fftwf_destroy_plan(plan_);
    fftwf_free(x_);
    fftwf_free(y_);
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i) fftwf_execute(plan_);
  }
  std::vector<float> result() override { return {y_, y_ + size_}; }

 private:
  std::size_t size_;
  float* x_;
  float* y_;
  fftwf_plan plan_ = nullptr;
};

}  // namespace
}  // namespace race

RACE_ADD_PEERS(std::vector<race::Contender>& contenders) {
  contenders.push_back(
      {"fft", "FFTW", [](const race::Problem& p) { return std::make_unique<race::Transform>(p); }});
}
