// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

namespace adit::bt::script {

enum class TokenKind : std::uint8_t { end, integer, real, text, boolean, name, symbol, bad };

struct Token {
  TokenKind kind{TokenKind::end};
  std::string_view text{};  ///< Without the quotes of a string.
  std::size_t position{0};  ///< Position of its first character, from 0.
};

/// Splits a script into tokens; the last one is `end`. Characters that cannot be read become `bad`. The
/// tokens refer to `source`.
std::vector<Token> tokenize(std::string_view source);

}  // namespace adit::bt::script
