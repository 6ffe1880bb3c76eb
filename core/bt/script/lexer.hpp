#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace adit::bt::script {

enum class TokenKind : std::uint8_t { end, integer, real, text, boolean, name, symbol, bad };

struct Token {
  TokenKind kind{TokenKind::end};
  std::string_view text{};  ///< without the quotes of a text
  std::size_t position{0};  ///< of its first character, from 0
};

/// Cuts a script into tokens; the last one is `end`. What cannot be read becomes `bad`. The tokens point
/// into `source`.
std::vector<Token> tokenize(std::string_view source);

}  // namespace adit::bt::script
