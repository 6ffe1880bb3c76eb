// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/bytes.hpp"
#include "core/result/result.hpp"

namespace adit::record {

/// A type of an IDL text, limited to what our IDL uses: primitives, strings, sequences, arrays, enums,
/// structs.
struct IdlType {
  enum class Kind : std::uint8_t { number, boolean, text, enumeration, sequence, array, structure };
  struct Member {
    std::string name{};
    std::shared_ptr<const IdlType> type{};
  };
  Kind kind{};
  std::uint8_t size{};       ///< Number: size in bytes.
  bool is_signed{}, real{};  ///< Number: signedness, and whether it is floating point.
  std::uint32_t count{};     ///< Array: number of elements.
  std::shared_ptr<const IdlType> element{};
  std::vector<std::string> names{};  ///< Enumeration: names, from 0.
  std::vector<Member> members{};
};

/// All types of a schema, by scoped name.
using IdlTypes = std::map<std::string, std::shared_ptr<const IdlType>, std::less<>>;

/// Parses an IDL text. Error syntax names the word that was not understood.
Result<IdlTypes> parse_idl(std::string_view text);

/// Converts a CDR sample with its encapsulation header to JSON in one line; of long sequences only the first
/// elements. Error malformed: it does not fit the type.
Result<std::string> cdr_to_json(const IdlType& type, ByteSpan cdr);

}  // namespace adit::record
