// SPDX-License-Identifier: Apache-2.0
#include "core/record/idl_value.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace adit::record {
namespace {

using Kind = IdlType::Kind;

constexpr std::uint32_t kShownElements = 24;

/// Decoder of XCDR version 1: each value is aligned to its size, counted from the end of the encapsulation
/// header.
class Decoder {
 public:
  explicit Decoder(ByteSpan cdr) : body_(cdr.subspan(4)), little_((cdr[1] & 1) != 0) {}

  bool value(const IdlType& type, std::string& out) {
    switch (type.kind) {
      case Kind::number:
        return number(type, out);
      case Kind::boolean: {
        std::uint64_t got = 0;
        if (!take(1, got) || got > 1) return false;
        out += got != 0 ? "true" : "false";
        return true;
      }
      case Kind::text:
        return text(out);
      case Kind::enumeration: {
        std::uint64_t got = 0;
        if (!take(4, got)) return false;
        out += got < type.names.size() ? "\"" + type.names[got] + "\"" : std::to_string(got);
        return true;
      }
      case Kind::sequence: {
        std::uint64_t count = 0;
        return take(4, count) && count <= left() && elements(*type.element, count, out);
      }
      case Kind::array:
        return elements(*type.element, type.count, out);
      case Kind::structure:
        return structure(type, out);
    }
    return false;
  }
  std::size_t left() const { return body_.size() - at_; }

 private:
  bool structure(const IdlType& type, std::string& out) {
    out += "{";
    for (const IdlType::Member& member : type.members) {
      if (&member != &type.members.front()) out += ",";
      out += "\"" + member.name + "\":";
      if (!value(*member.type, out)) return false;
    }
    out += "}";
    return true;
  }

  bool elements(const IdlType& type, std::uint64_t count, std::string& out) {
    std::string hidden;
    out += "[";
    for (std::uint64_t i = 0; i < count; ++i) {
      const bool shown = i < kShownElements;
      hidden.clear();
      if (shown && i > 0) out += ",";
      if (!value(type, shown ? out : hidden)) return false;
    }
    if (count > kShownElements) out += ",\"and " + std::to_string(count - kShownElements) + " more\"";
    out += "]";
    return true;
  }

  bool number(const IdlType& type, std::string& out) {
    std::uint64_t got = 0;
    if (!take(type.size, got)) return false;
    char digits[40];
    if (type.real) {
      const double real = type.size == 4
                              ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(got)))
                              : std::bit_cast<double>(got);
      std::snprintf(digits, sizeof digits, type.size == 4 ? "%.7g" : "%.15g", real);
      out += std::isfinite(real) ? digits : "null";
    } else if (type.is_signed) {
      const unsigned unused = 64U - 8U * type.size;
      out += std::to_string(static_cast<std::int64_t>(got << unused) >> unused);
    } else {
      out += std::to_string(got);
    }
    return true;
  }

  bool text(std::string& out) {
    std::uint64_t size = 0;
    if (!take(4, size) || size > left()) return false;
    out += "\"";
    for (std::uint64_t i = 0; i + 1 < size; ++i) {
      const char c = static_cast<char>(body_[at_ + i]);
      if (c == '"' || c == '\\') {
        out += '\\';
        out += c;
      } else if (static_cast<unsigned char>(c) < 0x20) {
        char escaped[8];
        std::snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(c));
        out += escaped;
      } else {
        out += c;
      }
    }
    out += "\"";
    if (size > 0 && body_[at_ + size - 1] != 0) return false;
    at_ += static_cast<std::size_t>(size);
    return true;
  }

  bool take(std::size_t size, std::uint64_t& out) {
    at_ = (at_ + size - 1) / size * size;
    if (at_ > body_.size() || size > left()) {
      at_ = body_.size();
      return false;
    }
    out = 0;
    for (std::size_t i = 0; i < size; ++i)
      out |= static_cast<std::uint64_t>(body_[at_ + i]) << (8 * (little_ ? i : size - 1 - i));
    at_ += size;
    return true;
  }

  ByteSpan body_;
  bool little_;
  std::size_t at_{};
};

}  // namespace

Result<std::string> cdr_to_json(const IdlType& type, ByteSpan cdr) {
  if (cdr.size() < 4 || cdr[0] != 0 || cdr[1] > 1)
    return Error{Reason::malformed, "not plain CDR: another encapsulation"};
  Decoder decoder(cdr);
  std::string out;
  if (!decoder.value(type, out)) return Error{Reason::malformed, "the bytes do not fit the type"};
  if (decoder.left() > 3)
    return Error{Reason::malformed, std::to_string(decoder.left()) + " bytes more than the type has"};
  return out;
}

}  // namespace adit::record
