// SPDX-License-Identifier: MIT
#pragma once
#include <string_view>
namespace sk::shadow {
inline std::string_view reportPage() { return "<script>const report = /*REPORT*/null;</script>"; }
}
