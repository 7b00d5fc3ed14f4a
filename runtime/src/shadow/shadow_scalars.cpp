// SPDX-License-Identifier: MIT
//
// Arithmetic with scalars on a shadowed device: on the device and on the reference. A result that differs is measured when
// something reads it.
#include <algorithm>
#include <utility>
#include <vector>

#include "device/scalar_pass.hpp"
#include "shadow/shadow_call.hpp"

namespace sk {

namespace {

class ShadowedScalars final : public RecordedCall {
 public:
  ShadowedScalars(ShadowDevice& device, ScalarPass pass) : device_(device), pass_(std::move(pass)) {
    ScalarPass inner = pass_;
    for (StreamRegion& read : inner.reads) read.stream = &shadowStream(read).inner();
    for (ScalarPass::Output& output : inner.outputs)
      output.stream = &static_cast<ShadowStream*>(output.stream)->inner();
    onDevice_ = device.primary().prepareScalars(std::move(inner));
  }

  void run() override {
    bool isFollowed = device_.isFollowing();
    ScalarPass pass = pass_;
    StreamErrors errors;
    std::vector<int> origins;
    for (StreamRegion& read : pass.reads) {
      ShadowStream& stream = shadowStream(read);
      stream.noteRead(read);
      addNew(origins, stream.origins);
      if (stream.errors.relative >= errors.relative) errors = stream.errors;
      read.stream = stream.reference();
      isFollowed = isFollowed && read.stream != nullptr;
    }
    for (ScalarPass::Output& output : pass.outputs) {
      auto& stream = *static_cast<ShadowStream*>(output.stream);
      stream.endWrite();
      output.stream = stream.room();
      isFollowed = isFollowed && output.stream != nullptr;
    }
    onDevice_->run();
    if (isFollowed) device_.reference().prepareScalars(std::move(pass))->run();
    for (const ScalarPass::Output& output : pass_.outputs) {
      auto& stream = *static_cast<ShadowStream*>(output.stream);
      stream.mirrorMarks();
      stream.origins = origins;
      if (!isFollowed) {
        stream.goStale(false);
        continue;
      }
      stream.becomeFresh();
      stream.errors = errors;
    }
  }

 private:
  ShadowDevice& device_;
  const ScalarPass pass_;
  std::unique_ptr<RecordedCall> onDevice_;
};

}  // namespace

std::unique_ptr<RecordedCall> prepareShadowedScalars(ShadowDevice& device, ScalarPass pass) {
  return std::make_unique<ShadowedScalars>(device, std::move(pass));
}

}  // namespace sk
