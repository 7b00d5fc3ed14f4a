// SPDX-License-Identifier: MIT
//
// The entry point of libFuzzer (https://llvm.org/docs/LibFuzzer.html), which every parse_NAME.cpp defines and replay.cpp calls, too.
#pragma once

#include <cstddef>
#include <cstdint>

/// Parses the bytes. Returns if the parser gives a result or throws a documented error; any other exception leaves this
/// function and is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
