// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "core/bt/script/script.hpp"

namespace adit::bt::script {

// The nodes of a script's expression tree. They evaluate like BehaviorTree.CPP's: both sides of && and ||
// are always evaluated, comparisons give 1.0 or 0.0 and can be chained, and numbers compare with texts that
// parse as numbers.

ExpressionPtr literal(BlackboardValue value);
ExpressionPtr variable(std::string name);
/// `op` is one of: - ~ !
ExpressionPtr unary(std::string op, ExpressionPtr operand);
/// `op` is one of: + - * / .. & | ^ && ||
ExpressionPtr binary(std::string op, ExpressionPtr left, ExpressionPtr right);
/// Chained comparison such as a < b <= c: operands.size() == ops.size() + 1.
ExpressionPtr comparison(std::vector<std::string> ops, std::vector<ExpressionPtr> operands);
ExpressionPtr conditional(ExpressionPtr condition, ExpressionPtr then, ExpressionPtr otherwise);
/// `op` is one of: := = += -= *= /=
ExpressionPtr assignment(std::string op, std::string name, ExpressionPtr value);

}  // namespace adit::bt::script
