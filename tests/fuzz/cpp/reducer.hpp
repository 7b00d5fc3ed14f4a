// SPDX-License-Identifier: MIT
//
// Makes a failing program small: removes declarations and statements, and replaces expressions by their parts and by
// literals, as long as it still fails in the same way.
#pragma once

#include <functional>

#include "cpp/tree.hpp"

namespace fuzz::cpp {

/// `fails(root)` tells whether a program still fails as the original does; it is asked at most `budget` times.
NodePtr reduced(NodePtr root, const std::function<bool(const Node&)>& fails, int budget);

}  // namespace fuzz::cpp
