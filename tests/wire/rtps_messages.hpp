// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/wire/link_state.hpp"

/// RTPS messages, little endian, as a participant or somebody who forges one sends them.
namespace adit::wire::test {

using Bytes = std::vector<std::uint8_t>;

inline void add(Bytes& to, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}
inline void add_entity(Bytes& to, std::uint32_t entity) {
  for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<std::uint8_t>(entity >> shift));
}
/// RTPS numbers are two 32-bit words, the high one first.
inline void add_number(Bytes& to, std::uint64_t number) {
  add(to, number >> 32, 4);
  add(to, number & 0xffffffff, 4);
}

template <class More>
void append(Bytes& to, const More& more) {
  for (const std::uint8_t byte : more) to.push_back(byte);
}

inline ParticipantId participant(std::uint8_t n) {
  ParticipantId id{};
  id.fill(n);
  return id;
}
inline Bytes guid(const ParticipantId& id, std::uint32_t entity) {
  Bytes out(id.begin(), id.end());
  add_entity(out, entity);
  return out;
}

inline Bytes submessage(std::uint8_t kind, const Bytes& body, std::uint8_t flags = 0) {
  Bytes out{kind, static_cast<std::uint8_t>(flags | 1)};
  add(out, body.size(), 2);
  append(out, body);
  return out;
}
inline Bytes rtps_message(const ParticipantId& sender, const std::vector<Bytes>& submessages) {
  Bytes out;
  append(out, std::array<std::uint8_t, 8>{'R', 'T', 'P', 'S', 2, 3, 1, 15});
  append(out, sender);
  for (const Bytes& sub : submessages) append(out, sub);
  return out;
}

inline Bytes parameter(std::uint16_t id, const Bytes& value) {
  Bytes out;
  add(out, id, 2);
  add(out, value.size(), 2);
  append(out, value);
  return out;
}
inline Bytes locator(const char* address, std::uint32_t port, std::uint32_t kind = 1) {
  Bytes out;
  add(out, kind, 4);
  add(out, port, 4);
  out.resize(20);
  const in_addr_t ip = ::inet_addr(address);
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(ip >> 8 * i));
  return out;
}
inline Bytes list(const std::vector<Bytes>& parameters) {
  Bytes out;
  for (const Bytes& one : parameters) append(out, one);
  add(out, 1, 2);
  add(out, 0, 2);
  return out;
}
/// A serialised parameter list.
inline Bytes payload(const std::vector<Bytes>& parameters) {
  Bytes out{0, 3, 0, 0};
  const Bytes rest = list(parameters);
  append(out, rest);
  return out;
}

inline constexpr std::uint32_t kAnnouncer = 0x000100c2, kPublications = 0x000003c2,
                               kSubscriptions = 0x000004c2;
/// The reader that a submessage of that writer addresses: for discovery its own, else any.
inline std::uint32_t reader_of(std::uint32_t writer) {
  return writer == kPublications || writer == kSubscriptions ? writer + 5 : 0;
}

/// DATA; `qos`: its inline parameters, none if empty.
inline Bytes data(std::uint32_t reader, std::uint32_t writer, std::uint64_t number, const Bytes& content,
                  const Bytes& qos = {}) {
  Bytes body;
  add(body, 0, 2);
  add(body, 16, 2);
  add_entity(body, reader);
  add_entity(body, writer);
  add_number(body, number);
  append(body, qos);
  append(body, content);
  return submessage(0x15, body, static_cast<std::uint8_t>((qos.empty() ? 0 : 2) | (content.empty() ? 0 : 4)));
}
/// DATA_FRAG with one fragment of `carried` bytes.
inline Bytes fragment(std::uint32_t writer, std::uint64_t number, std::uint32_t start, std::uint16_t count,
                      std::uint16_t bytes, std::uint32_t sample, std::size_t carried) {
  Bytes body;
  add(body, 0, 2);
  add(body, 28, 2);
  add_entity(body, reader_of(writer));
  add_entity(body, writer);
  add_number(body, number);
  add(body, start, 4);
  add(body, count, 2);
  add(body, bytes, 2);
  add(body, sample, 4);
  body.resize(body.size() + carried);
  return submessage(0x16, body);
}
inline Bytes heartbeat(std::uint32_t writer, std::uint64_t first, std::uint64_t last,
                       std::uint32_t count = 1) {
  Bytes body;
  add_entity(body, reader_of(writer));
  add_entity(body, writer);
  add_number(body, first);
  add_number(body, last);
  add(body, count, 4);
  return submessage(0x07, body);
}
inline Bytes gap(std::uint32_t writer, std::uint64_t start, std::uint64_t base) {
  Bytes body;
  add_entity(body, reader_of(writer));
  add_entity(body, writer);
  add_number(body, start);
  add_number(body, base);
  add(body, 0, 4);
  return submessage(0x08, body);
}
/// ACKNACK that asks for the numbers from `first` to `last`, at most 256.
inline Bytes acknack(std::uint32_t reader, std::uint32_t writer, std::uint64_t first, std::uint64_t last,
                     std::uint32_t count) {
  const auto bits = static_cast<std::uint32_t>(std::min<std::uint64_t>(last - first + 1, 256));
  Bytes body;
  add_entity(body, reader);
  add_entity(body, writer);
  add_number(body, first);
  add(body, bits, 4);
  for (std::uint32_t i = 0; i < (bits + 31) / 32; ++i) add(body, 0xffffffff, 4);
  add(body, count, 4);
  return submessage(0x06, body);
}
inline Bytes destination(const ParticipantId& to) { return submessage(0x0e, {to.begin(), to.end()}); }

inline Bytes lease(std::uint32_t seconds) {
  Bytes value;
  add(value, seconds, 4);
  add(value, 0, 4);
  return parameter(0x02, value);
}
/// Announcement of a participant that receives there.
inline Bytes announcement(const ParticipantId& of, const std::vector<Bytes>& locators,
                          std::uint32_t seconds = 60, std::uint64_t number = 1) {
  // Protocol version, vendor, and the built-in endpoints of participants, writers and readers.
  std::vector<Bytes> all{parameter(0x15, {2, 3, 0, 0}), parameter(0x16, {1, 15, 0, 0}),
                         parameter(0x58, {0x3f, 0, 0, 0}), parameter(0x50, guid(of, 0x1c1)), lease(seconds)};
  for (const Bytes& one : locators) all.push_back(parameter(0x32, one));
  return data(0, kAnnouncer, number, payload(all));
}
inline Bytes goodbye(const ParticipantId& of) {
  return data(0, kAnnouncer, 2, {}, list({parameter(0x70, guid(of, 0x1c1)), parameter(0x71, {0, 0, 0, 3})}));
}
/// Announcement of a writer or a reader of `of`.
inline Bytes endpoint(std::uint32_t writer, const ParticipantId& of, std::uint32_t entity,
                      const std::string& topic, std::uint64_t number,
                      const std::vector<Bytes>& locators = {}) {
  Bytes name;
  add(name, topic.size() + 1, 4);
  append(name, topic);
  name.resize(name.size() + 4 - topic.size() % 4);
  std::vector<Bytes> all{parameter(0x5a, guid(of, entity)), parameter(0x05, name)};
  for (const Bytes& one : locators) all.push_back(parameter(0x2f, one));
  return data(reader_of(writer), writer, number, payload(all));
}

}  // namespace adit::wire::test
