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

/// A type of an IDL text. What our IDL uses: primitives, strings, sequences, arrays, enums, structs.
struct IdlType {
  enum class Kind : std::uint8_t { number, boolean, text, enumeration, sequence, array, structure };
  struct Member {
    std::string name{};
    std::shared_ptr<const IdlType> type{};
  };
  Kind kind{};
  std::uint8_t size{};       ///< number: bytes
  bool is_signed{}, real{};  ///< number
  std::uint32_t count{};     ///< array
  std::shared_ptr<const IdlType> element{};
  std::vector<std::string> names{};  ///< enumeration, from 0
  std::vector<Member> members{};
};

/// All types of a schema, by scoped name.
using IdlTypes = std::map<std::string, std::shared_ptr<const IdlType>, std::less<>>;

/// Error syntax: names the word that was not understood.
Result<IdlTypes> parse_idl(std::string_view text);

/// A CDR sample with its encapsulation header as JSON, in one line; of long sequences the first elements.
/// Error malformed: it does not fit the type.
Result<std::string> cdr_to_json(const IdlType& type, ByteSpan cdr);

}  // namespace adit::record
