// SPDX-License-Identifier: MIT
//
// What the report says about a call beside its errors.
#pragma once

#include <string>

#include "shadow/recorder.hpp"
#include "shadow/shadow_call.hpp"

namespace sk {

/// Seconds that one call took.
struct CallTimes {
  double device, reference, comparison;
};

void recordTimes(shadow::Recorder& recorder, int kernel, const CallTimes& times);

/// The options of a call that are not the default, as a configuration file names them: "precision half, intrinsics fast".
std::string choicesText(const DeviceState& device, const ShadowedCall& call);

}  // namespace sk
