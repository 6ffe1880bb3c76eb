#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/bt/blackboard.hpp"
#include "core/result/result.hpp"

namespace adit::bt {

/// Names that scripts and Switch nodes may use for numbers.
using Enums = std::map<std::string, std::int64_t, std::less<>>;

namespace script {
/// What an expression sees while it runs.
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

/// The small language of BehaviorTree.CPP's Script node and of the pre- and postconditions:
/// "n := 1; n += 2; ok = (n > 2) ? true : false". Statements are separated by ';'.
class Script {
 public:
  /// Reason::syntax with the position when the text is not a script.
  static Result<std::shared_ptr<const Script>> parse(std::string_view text);
  /// Runs every statement and answers with the last one's value. Throws NodeError.
  BlackboardValue run(Blackboard& board, const Enums& enums) const;

 private:
  std::vector<script::ExpressionPtr> statements_{};
};

}  // namespace adit::bt
