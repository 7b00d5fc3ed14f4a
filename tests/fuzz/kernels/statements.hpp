// SPDX-License-Identifier: MIT
//
// Random statements: declarations, assignments, branches, loops that terminate, switches, early returns.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernels/append_outputs.hpp"
#include "kernels/expressions.hpp"
#include "kernels/model.hpp"

namespace fuzz {

/// Gives every variable of a program its own name and slots.
struct Names {
  int next = 0;
  std::string fresh(const char* kind) { return kind + std::to_string(next++); }
  int slots = 0;
  int take(int count) { return (slots += count) - count; }
};

class Statements {
 public:
  /// Declarations enter the scope and leave it at the end of their block. `canReturn`: a plain `return;` may stand
  /// anywhere. Some statements write to the append outputs, if there are any.
  Statements(Scope& scope, Names& names, Random& random, bool canReturn,
             std::vector<AppendOutput> appendOutputs = {})
      : scope_(scope),
        names_(names),
        random_(random),
        expressions_(scope, random),
        canReturn_(canReturn),
        appendOutputs_(std::move(appendOutputs)) {}

  /// `count` statements, each on its own lines.
  Statement block(int count, int depth, const std::string& indent);
  /// Assigns a value of the place's type.
  Statement assignTo(const Place& place, const Expr& value, const std::string& indent);

 private:
  Statement statement(int depth, const std::string& indent);
  Statement declaration(const std::string& indent);
  Statement arrayDeclaration(const std::string& indent);
  Statement assignment(const std::string& indent);
  Statement compound(const Place& place, const std::string& indent);
  Statement branch(int depth, const std::string& indent);
  Statement forLoop(int depth, const std::string& indent);
  Statement whileLoop(int depth, const std::string& indent);
  Statement choice(int depth, const std::string& indent);
  Statement jump(const std::string& indent);

  Scope& scope_;
  Names& names_;
  Random& random_;
  Expressions expressions_;
  const bool canReturn_;
  const std::vector<AppendOutput> appendOutputs_;
  int loops_ = 0;  ///< number of loops around the current statement
  int breakables_ = 0;  ///< number of loops and switches around it
};

}  // namespace fuzz
