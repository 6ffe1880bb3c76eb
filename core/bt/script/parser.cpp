// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <initializer_list>

#include "core/bt/script/expression.hpp"
#include "core/bt/script/lexer.hpp"

namespace adit::bt {

namespace script {
namespace {

constexpr int kMaxDepth = 64;

/// Recursive-descent parser with one function per precedence level, from assignment (lowest) to atoms.
class Parser {
 public:
  explicit Parser(std::string_view source) : tokens_(tokenize(source)) {}

  std::vector<ExpressionPtr> run() {
    std::vector<ExpressionPtr> statements;
    while (peek().kind != TokenKind::end) {
      statements.push_back(assign());
      if (!accept({";"}) && peek().kind != TokenKind::end) fail("expected an operator or ';'");
    }
    if (statements.empty()) fail("the script is empty");
    return statements;
  }

 private:
  struct Depth {
    explicit Depth(Parser& p) : parser(p) {
      if (++parser.depth_ > kMaxDepth) parser.fail("nested too deeply");
    }
    ~Depth() { --parser.depth_; }
    Depth(const Depth&) = delete;
    Depth& operator=(const Depth&) = delete;
    Parser& parser;
  };

  const Token& peek() const { return tokens_[at_]; }
  const Token& take() { return tokens_[at_].kind == TokenKind::end ? tokens_[at_] : tokens_[at_++]; }

  /// Consumes the next token if it is one of these symbols; returns it, else null.
  const Token* accept(std::initializer_list<std::string_view> symbols) {
    if (peek().kind != TokenKind::symbol) return nullptr;
    if (std::find(symbols.begin(), symbols.end(), peek().text) == symbols.end()) return nullptr;
    return &take();
  }

  [[noreturn]] void fail(const std::string& what) const {
    const Token& token = peek();
    std::string found = token.kind == TokenKind::end ? "the end" : "'" + std::string(token.text) + "'";
    throw NodeError(what + " at character " + std::to_string(token.position + 1) + ", found " + found);
  }

  ExpressionPtr assign() {
    const Depth guard(*this);
    if (peek().kind == TokenKind::name && tokens_[at_ + 1].kind == TokenKind::symbol) {
      const std::string name(peek().text);
      const std::string_view op = tokens_[at_ + 1].text;
      if (op == ":=" || op == "=" || op == "+=" || op == "-=" || op == "*=" || op == "/=") {
        at_ += 2;
        return assignment(std::string(op), name, choose());
      }
    }
    return choose();
  }

  ExpressionPtr choose() {
    auto condition = logic();
    if (!accept({"?"})) return condition;
    auto then = assign();
    if (!accept({":"})) fail("expected ':'");
    return conditional(std::move(condition), std::move(then), assign());
  }

  // || and && have equal precedence, as in BehaviorTree.CPP's grammar.
  ExpressionPtr logic() { return chain({"||", "&&"}, &Parser::compare); }

  ExpressionPtr compare() {
    std::vector<std::string> ops;
    std::vector<ExpressionPtr> operands;
    operands.push_back(concatenate());
    while (const Token* op = accept({"==", "!=", "<", ">", "<=", ">="})) {
      ops.emplace_back(op->text);
      operands.push_back(concatenate());
    }
    if (ops.empty()) return std::move(operands.front());
    return comparison(std::move(ops), std::move(operands));
  }

  ExpressionPtr concatenate() { return chain({".."}, &Parser::bit_or); }
  ExpressionPtr bit_or() { return chain({"|", "^"}, &Parser::bit_and); }
  ExpressionPtr bit_and() { return chain({"&"}, &Parser::sum); }
  ExpressionPtr sum() { return chain({"+", "-"}, &Parser::product); }
  ExpressionPtr product() { return chain({"*", "/"}, &Parser::prefix); }

  ExpressionPtr chain(std::initializer_list<std::string_view> ops, ExpressionPtr (Parser::*operand)()) {
    auto left = (this->*operand)();
    int length = 0;
    while (const Token* op = accept(ops)) {
      if (++length > 4 * kMaxDepth) fail("expression too long");
      const std::string text(op->text);
      left = binary(text, std::move(left), (this->*operand)());
    }
    return left;
  }

  ExpressionPtr prefix() {
    const Depth guard(*this);
    if (const Token* op = accept({"-", "~", "!", "+"})) {
      const std::string text(op->text);
      if (text == "+") return prefix();
      if (text == "-" && (peek().kind == TokenKind::integer || peek().kind == TokenKind::real)) {
        return number(take(), true);
      }
      return unary(text, prefix());
    }
    return atom();
  }

  ExpressionPtr atom() {
    const Token token = peek();
    switch (token.kind) {
      case TokenKind::integer:
      case TokenKind::real:
        return number(take(), false);
      case TokenKind::text:
        take();
        return literal(BlackboardValue(std::string(token.text)));
      case TokenKind::boolean:
        take();
        return literal(BlackboardValue(static_cast<std::int64_t>(token.text == "true")));
      case TokenKind::name:
        take();
        return variable(std::string(token.text));
      case TokenKind::symbol:
        if (accept({"("})) {
          auto inner = assign();
          if (!accept({")"})) fail("expected ')'");
          return inner;
        }
        break;
      case TokenKind::end:
      case TokenKind::bad:
        break;
    }
    fail("expected a value");
  }

  ExpressionPtr number(const Token& token, bool negative) {
    if (token.kind == TokenKind::real) {
      double real = 0;
      std::from_chars(token.text.data(), token.text.data() + token.text.size(), real);
      return literal(BlackboardValue(negative ? -real : real));
    }
    std::string_view digits = token.text;
    const bool hex = digits.starts_with("0x") || digits.starts_with("0X");
    if (hex) digits.remove_prefix(2);
    std::int64_t integer = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), integer, hex ? 16 : 10);
    if (read.ec != std::errc()) throw NodeError("number '" + std::string(token.text) + "' is too large");
    return literal(BlackboardValue(negative ? -integer : integer));
  }

  std::vector<Token> tokens_;
  std::size_t at_{0};
  int depth_{0};
};

}  // namespace
}  // namespace script

Result<std::shared_ptr<const Script>> Script::parse(std::string_view text) {
  try {
    auto parsed = std::make_shared<Script>();
    parsed->statements_ = script::Parser(text).run();
    return std::shared_ptr<const Script>(std::move(parsed));
  } catch (const NodeError& error) {
    return Error{Reason::syntax, std::string("script: ") + error.what()};
  }
}

BlackboardValue Script::run(Blackboard& board, const Enums& enums) const {
  script::Environment env{board, enums};
  BlackboardValue last{};
  for (const auto& statement : statements_) last = statement->evaluate(env);
  return last;
}

}  // namespace adit::bt
