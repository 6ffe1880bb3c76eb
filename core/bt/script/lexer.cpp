// SPDX-License-Identifier: Apache-2.0
#include "core/bt/script/lexer.hpp"

#include <array>

namespace adit::bt::script {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hex(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }
// Bytes of UTF-8 sequences count as letters, as in the Unicode identifiers of BehaviorTree.CPP.
bool starts_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '@' ||
         static_cast<unsigned char>(c) >= 0x80;
}
bool continues_name(char c) { return starts_name(c) || is_digit(c); }

constexpr std::array<std::string_view, 29> kSymbols{
    "..", "&&", "||", "==", "!=", "<=", ">=", ":=", "+=", "-=", "*=", "/=", "+", "-", "*",
    "/",  "&",  "|",  "^",  "~",  "!",  "<",  ">",  "=",  "?",  ":",  "(",  ")", ";"};

class Lexer {
 public:
  explicit Lexer(std::string_view source) : source_(source) {}

  std::vector<Token> run() {
    std::vector<Token> tokens;
    for (;;) {
      while (at_ < source_.size() && std::string_view(" \t\r\n").find(source_[at_]) != std::string_view::npos)
        ++at_;
      tokens.push_back(next());
      if (tokens.back().kind == TokenKind::end) return tokens;
    }
  }

 private:
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < source_.size() ? source_[at_ + ahead] : '\0';
  }
  Token make(TokenKind kind, std::size_t start) const {
    return {kind, source_.substr(start, at_ - start), start};
  }

  Token next() {
    const std::size_t start = at_;
    if (at_ >= source_.size()) return {TokenKind::end, {}, start};
    const char c = peek();
    if (c == '\'' || c == '"') return text(c);
    if (is_digit(c)) return number();
    if (starts_name(c)) {
      while (continues_name(peek())) ++at_;
      const Token token = make(TokenKind::name, start);
      const bool boolean = token.text == "true" || token.text == "false";
      return {boolean ? TokenKind::boolean : TokenKind::name, token.text, start};
    }
    for (const auto symbol : kSymbols) {
      if (source_.substr(at_).starts_with(symbol)) {
        at_ += symbol.size();
        return make(TokenKind::symbol, start);
      }
    }
    ++at_;
    return make(TokenKind::bad, start);
  }

  Token text(char quote) {
    const std::size_t start = at_++;
    const auto end = source_.find(quote, at_);
    if (end == std::string_view::npos) {
      at_ = source_.size();
      return make(TokenKind::bad, start);
    }
    const Token token{TokenKind::text, source_.substr(at_, end - at_), start};
    at_ = end + 1;
    return token;
  }

  Token number() {
    const std::size_t start = at_;
    TokenKind kind = TokenKind::integer;
    if (peek() == '0' && (peek(1) == 'x' || peek(1) == 'X')) {
      at_ += 2;
      if (!is_hex(peek())) kind = TokenKind::bad;
      while (is_hex(peek())) ++at_;
    } else {
      while (is_digit(peek())) ++at_;
      if (peek() == '.' && peek(1) != '.') {
        kind = is_digit(peek(1)) ? TokenKind::real : TokenKind::bad;
        ++at_;
        while (is_digit(peek())) ++at_;
      }
      if (peek() == 'e' || peek() == 'E') {
        ++at_;
        if (peek() == '+' || peek() == '-') ++at_;
        kind = kind != TokenKind::bad && is_digit(peek()) ? TokenKind::real : TokenKind::bad;
        while (is_digit(peek())) ++at_;
      }
    }
    while (continues_name(peek())) {
      kind = TokenKind::bad;
      ++at_;
    }
    return make(kind, start);
  }

  std::string_view source_;
  std::size_t at_{0};
};

}  // namespace

std::vector<Token> tokenize(std::string_view source) { return Lexer(source).run(); }

}  // namespace adit::bt::script
