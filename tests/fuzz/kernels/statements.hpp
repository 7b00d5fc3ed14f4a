// SPDX-License-Identifier: MIT
//
// Random statements: declarations, assignments, branches, loops that end, switches, early returns.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kernels/expressions.hpp"
#include "kernels/model.hpp"
#include "kernels/sinks.hpp"

namespace fuzz {

/// Names and slots that no two variables of a program share.
struct Names {
  int next = 0;
  std::string fresh(const char* kind) { return kind + std::to_string(next++); }
  int slots = 0;
  int take(int count) { return (slots += count) - count; }
};

class Statements {
 public:
  /// The scope gets what is declared, and loses it where its block ends. `canReturn`: a plain `return;` may stand
  /// anywhere. Some statements write to the sinks, if there are any.
  Statements(Scope& scope, Names& names, Random& random, bool canReturn, std::vector<Sink> sinks = {})
      : scope_(scope),
        names_(names),
        random_(random),
        expressions_(scope, random),
        canReturn_(canReturn),
        sinks_(std::move(sinks)) {}

  /// Up to `count` statements, each on lines of its own.
  Statement block(int count, int depth, const std::string& indent);
  /// A place becomes a value of its type.
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
  const std::vector<Sink> sinks_;
  int loops_ = 0;  ///< around the statement that is made
  int breakables_ = 0;  ///< loops and switches
};

}  // namespace fuzz
