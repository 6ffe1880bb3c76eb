// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/bt/blackboard.hpp"
#include "core/result/result.hpp"

namespace adit::bt {

/// Names of numbers in scripts and Switch nodes.
using Enums = std::map<std::string, std::int64_t, std::less<>>;

namespace script {
/// State that an expression can access while it is evaluated.
struct Environment {
  Blackboard& board;
  const Enums& enums;
};
class Expression {
 public:
  virtual ~Expression() = default;
  /// Throws NodeError.
  virtual BlackboardValue evaluate(Environment& env) const = 0;
};
using ExpressionPtr = std::unique_ptr<const Expression>;
}  // namespace script

/// A script in the language of BehaviorTree.CPP's Script node and of pre- and postconditions: "n := 1; n +=
/// 2; ok = (n > 2) ? true : false". Statements are separated by ';'.
class Script {
 public:
  /// Parses a script. Error syntax, with the position.
  static Result<std::shared_ptr<const Script>> parse(std::string_view text);
  /// Runs every statement and returns the value of the last one. Throws NodeError.
  BlackboardValue run(Blackboard& board, const Enums& enums) const;

 private:
  std::vector<script::ExpressionPtr> statements_{};
};

}  // namespace adit::bt
