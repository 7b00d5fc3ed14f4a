// SPDX-License-Identifier: MIT
//
// What every parse_NAME.cpp defines: the entry point of libFuzzer (https://llvm.org/docs/LibFuzzer.html), which replay.cpp calls, too.
#pragma once

#include <cstddef>
#include <cstdint>

/// Shows the bytes to a parser. Returns where the parser gives a result or an error of the kind that it documents; any other
/// exception that leaves this function is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
