// SPDX-License-Identifier: Apache-2.0
#include "core/bt/script/expression.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace adit::bt::script {

namespace {

BlackboardValue truth(bool value) { return BlackboardValue(value ? 1.0 : 0.0); }

void require_written(const BlackboardValue& v, const char* side, const std::string& op) {
  if (is_empty(v)) {
    throw NodeError(std::string("the ") + side + " operand of '" + op + "' was never written");
  }
}

/// Converts a value to a number. Texts count as numbers when they parse as a number, as true or false, or as
/// an enum.
double number_of(const BlackboardValue& v, const Enums& enums) {
  if (!is_text(v)) return to_real(v);
  const std::string& text = std::get<std::string>(v);
  if (text == "true") return 1.0;
  if (text == "false") return 0.0;
  if (const auto it = enums.find(text); it != enums.end()) return static_cast<double>(it->second);
  return to_real(v);
}

struct Literal : Expression {
  explicit Literal(BlackboardValue v) : value(std::move(v)) {}
  BlackboardValue evaluate(Environment&) const override { return value; }
  BlackboardValue value;
};

struct Variable : Expression {
  explicit Variable(std::string n) : name(std::move(n)) {}
  BlackboardValue evaluate(Environment& env) const override {
    if (const auto it = env.enums.find(name); it != env.enums.end()) {
      return BlackboardValue(static_cast<double>(it->second));
    }
    if (const auto* entry = env.board.find(name)) return entry->value;
    throw NodeError("no variable '" + name + "' on the blackboard");
  }
  std::string name;
};

struct Unary : Expression {
  Unary(std::string o, ExpressionPtr e) : op(std::move(o)), operand(std::move(e)) {}
  BlackboardValue evaluate(Environment& env) const override {
    const BlackboardValue v = operand->evaluate(env);
    if (!is_number(v)) throw NodeError("operator '" + op + "' needs a number");
    const double number = to_real(v);
    if (op == "-") return BlackboardValue(-number);
    if (op == "!") return truth(number == 0.0);
    return BlackboardValue(static_cast<double>(~to_integer(BlackboardValue(std::trunc(number)))));
  }
  std::string op;
  ExpressionPtr operand;
};

struct Binary : Expression {
  Binary(std::string o, ExpressionPtr l, ExpressionPtr r)
      : op(std::move(o)), left(std::move(l)), right(std::move(r)) {}
  BlackboardValue evaluate(Environment& env) const override {
    const BlackboardValue a = left->evaluate(env);
    const BlackboardValue b = right->evaluate(env);
    require_written(a, "left", op);
    require_written(b, "right", op);
    if (is_number(a) && is_number(b) && op != "..") return numbers(a, b);
    const bool joins = is_text(a) && is_text(b) && op == "+";
    const bool concatenates = op == ".." && (is_text(a) || is_text(b)) && (is_text(a) || is_number(a)) &&
                              (is_text(b) || is_number(b));
    if (joins || concatenates) return BlackboardValue(to_text(a) + to_text(b));
    throw NodeError("operator '" + op + "' does not take these operands");
  }
  BlackboardValue numbers(const BlackboardValue& a, const BlackboardValue& b) const {
    if (op == "+") return BlackboardValue(to_real(a) + to_real(b));
    if (op == "-") return BlackboardValue(to_real(a) - to_real(b));
    if (op == "*") return BlackboardValue(to_real(a) * to_real(b));
    if (op == "/") return BlackboardValue(to_real(a) / to_real(b));
    if (op == "&") return BlackboardValue(static_cast<double>(to_integer(a) & to_integer(b)));
    if (op == "|") return BlackboardValue(static_cast<double>(to_integer(a) | to_integer(b)));
    if (op == "^") return BlackboardValue(static_cast<double>(to_integer(a) ^ to_integer(b)));
    const bool x = to_condition(a), y = to_condition(b);
    return truth(op == "&&" ? x && y : x || y);
  }
  std::string op;
  ExpressionPtr left, right;
};

template <class T>
bool holds(const std::string& op, const T& a, const T& b, bool same) {
  if (op == "==") return same;
  if (op == "!=") return !same;
  if (op == "<") return a < b;
  if (op == ">") return a > b;
  if (op == "<=") return a <= b;
  return a >= b;
}

struct Comparison : Expression {
  Comparison(std::vector<std::string> o, std::vector<ExpressionPtr> e)
      : ops(std::move(o)), operands(std::move(e)) {}
  BlackboardValue evaluate(Environment& env) const override {
    BlackboardValue a = operands[0]->evaluate(env);
    for (std::size_t i = 0; i < ops.size(); ++i) {
      BlackboardValue b = operands[i + 1]->evaluate(env);
      require_written(a, "left", ops[i]);
      require_written(b, "right", ops[i]);
      if (!compare(ops[i], a, b, env.enums)) return truth(false);
      a = std::move(b);
    }
    return truth(true);
  }
  static bool compare(const std::string& op, const BlackboardValue& a, const BlackboardValue& b,
                      const Enums& enums) {
    if (is_text(a) && is_text(b)) {
      const auto &x = std::get<std::string>(a), &y = std::get<std::string>(b);
      return holds(op, x, y, x == y);
    }
    const double x = number_of(a, enums), y = number_of(b, enums);
    return holds(op, x, y, std::abs(x - y) <= static_cast<double>(std::numeric_limits<float>::epsilon()));
  }
  std::vector<std::string> ops;
  std::vector<ExpressionPtr> operands;
};

struct Conditional : Expression {
  Conditional(ExpressionPtr c, ExpressionPtr t, ExpressionPtr o)
      : condition(std::move(c)), then(std::move(t)), otherwise(std::move(o)) {}
  BlackboardValue evaluate(Environment& env) const override {
    const BlackboardValue v = condition->evaluate(env);
    const bool yes = is_text(v) ? !std::get<std::string>(v).empty() : to_real(v) != 0.0;
    return yes ? then->evaluate(env) : otherwise->evaluate(env);
  }
  ExpressionPtr condition, then, otherwise;
};

struct Assignment : Expression {
  Assignment(std::string o, std::string n, ExpressionPtr e)
      : op(std::move(o)), name(std::move(n)), source(std::move(e)) {}
  BlackboardValue evaluate(Environment& env) const override {
    if (op == ":=") {
      env.board.declare(name);
    } else if (!env.board.find(name)) {
      throw NodeError("no blackboard entry '" + name + "' yet: '" + name + " := ...' makes one");
    }
    const BlackboardValue value = source->evaluate(env);
    require_written(value, "right", op);
    Blackboard::Entry& entry = env.board.declare(name);
    if (op == ":=" || op == "=") {
      if (is_text(value) &&
          (is_number(entry.value) || (is_empty(entry.value) && entry.type != PortType::any))) {
        assign_text(env, entry, value);
      } else {
        copy_into(value, entry.value);
      }
    } else {
      require_written(entry.value, "left", op);
      copy_into(combined(entry.value, value), entry.value);
    }
    return entry.value;
  }
  void assign_text(Environment& env, Blackboard::Entry& entry, const BlackboardValue& value) const {
    if (entry.type == PortType::any) {
      entry.value = number_of(value, env.enums);
    } else {
      env.board.set(name, value);
    }
  }
  BlackboardValue combined(const BlackboardValue& old, const BlackboardValue& value) const {
    if (is_text(value)) {
      if (op != "+=") throw NodeError("operator '" + op + "' needs numbers");
      return BlackboardValue(to_text(old) + to_text(value));
    }
    if (!is_number(old)) throw NodeError("operator '" + op + "' needs a number in '" + name + "'");
    const double a = to_real(old), b = to_real(value);
    if (op == "+=") return BlackboardValue(a + b);
    if (op == "-=") return BlackboardValue(a - b);
    if (op == "*=") return BlackboardValue(a * b);
    return BlackboardValue(a / b);
  }
  std::string op, name;
  ExpressionPtr source;
};

}  // namespace

ExpressionPtr literal(BlackboardValue value) { return std::make_unique<Literal>(std::move(value)); }
ExpressionPtr variable(std::string name) { return std::make_unique<Variable>(std::move(name)); }
ExpressionPtr unary(std::string op, ExpressionPtr operand) {
  return std::make_unique<Unary>(std::move(op), std::move(operand));
}
ExpressionPtr binary(std::string op, ExpressionPtr left, ExpressionPtr right) {
  return std::make_unique<Binary>(std::move(op), std::move(left), std::move(right));
}
ExpressionPtr comparison(std::vector<std::string> ops, std::vector<ExpressionPtr> operands) {
  return std::make_unique<Comparison>(std::move(ops), std::move(operands));
}
ExpressionPtr conditional(ExpressionPtr condition, ExpressionPtr then, ExpressionPtr otherwise) {
  return std::make_unique<Conditional>(std::move(condition), std::move(then), std::move(otherwise));
}
ExpressionPtr assignment(std::string op, std::string name, ExpressionPtr value) {
  return std::make_unique<Assignment>(std::move(op), std::move(name), std::move(value));
}

}  // namespace adit::bt::script
