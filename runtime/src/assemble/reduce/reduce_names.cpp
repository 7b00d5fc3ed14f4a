// SPDX-License-Identifier: MIT
#include "assemble/reduce/reduce_names.hpp"

namespace sk::assemble {

std::string_view nameOf(Walk walk) {
  switch (walk) {
    case Walk::Line: return "elements of a line";
    case Walk::Plane: return "elements of a plane";
    case Walk::Box: return "elements of a box";
    case Walk::Index: return "elements by index";
    case Walk::Rows: return "elements of rows";
    case Walk::Partials: return "partial results";
    case Walk::PartialRows: return "partial results in rows";
    case Walk::GroupedPartials: return "partial results of groups";
    case Walk::Nothing: return "no elements";
  }
  return {};
}

std::string_view nameOf(Runs runs) {
  switch (runs) {
    case Runs::OneBlock: return "one block";
    case Runs::WholeBlocks: return "a run for each block";
    case Runs::Split: return "several runs for each block";
  }
  return {};
}

}  // namespace sk::assemble
