// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/rtps_guard.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "core/wire/fastdds/rtps_peek.hpp"
#include "core/wire/fastdds/rtps_submessage.hpp"
#include "core/wire/qos.hpp"

namespace adit::wire {
namespace {

using namespace rtps_bytes;

constexpr std::uint8_t kFirstVendorKind = 0x80, kSupportedMajor = 2;
constexpr std::size_t kGuid = 16, kLocator = 24, kMaxBits = 256, kMaxLocators = 8;
/// The library counts alignment and encapsulation differently than the bound of a topic does, bytes.
constexpr std::uint32_t kSampleMargin = 16;

// Entity ids of RTPS 2.2, 9.3.1.3.
constexpr std::uint32_t kAnnouncingReader = 0x000100c7, kPublicationsReader = 0x000003c7,
                        kSubscriptionsReader = 0x000004c7;

/// Writer of the discovery data that this reader reads; 0: it reads other data.
std::uint32_t discovery_writer(std::uint32_t reader) {
  if (reader == kAnnouncingReader) return kAnnouncingWriter;
  if (reader == kPublicationsReader) return kPublicationsWriter;
  return reader == kSubscriptionsReader ? kSubscriptionsWriter : 0;
}
bool is_discovery_writer(std::uint32_t writer) {
  return writer == kAnnouncingWriter || writer == kPublicationsWriter || writer == kSubscriptionsWriter;
}

/// Whether the set of numbers at `at`, behind its base, fits: a count of bits, its words, and `after` bytes.
bool set_fits(const Submessage& sub, std::size_t at, std::size_t after) {
  if (sub.body.size() < at + 4) return false;
  const std::uint64_t bits = word(sub, at);
  return bits <= kMaxBits && sub.body.size() >= at + 4 + (bits + 31) / 32 * 4 + after;
}

/// What a list of parameters says of a participant or an endpoint.
struct DiscoveryData {
  bool foreign{};  ///< It names another participant.
  bool named{};    ///< It names its own.
  bool goodbye{};
  std::uint32_t endpoint{};
};

}  // namespace

/// Reads one message. Each function returns why the message is refused, if it is.
class RtpsGuard::Reading {
 public:
  Reading(RtpsGuard& guard, Message message, Source source, const ParticipantId& own, Duration now)
      : guard_(guard), message_(message), source_(source), own_(own), now_(now) {}

  /// Reads all submessages. Nothing in `out`: the message is not for the library, which is no fault.
  std::optional<Refusal> read(std::vector<std::uint8_t>& copy, Message& out);

 private:
  struct Edit {
    std::size_t at{};  // In the result.
    std::array<std::uint8_t, 4> bytes{};
    std::size_t size{};
  };
  using Fault = std::optional<Refusal>;

  bool find_peer();
  Fault judge(const Submessage& sub);
  Fault judge_sample(const Submessage& sub);
  Fault judge_fragment(const Submessage& sub, std::uint32_t writer, std::size_t payload);
  Fault judge_discovery(const Submessage& sub, std::uint32_t writer, std::size_t payload);
  Fault judge_payload(const Submessage& sub, std::uint32_t writer, std::size_t payload, DiscoveryData& data);
  Fault judge_number(std::uint32_t writer, std::uint64_t number);
  Fault judge_heartbeat(std::uint32_t writer, std::uint64_t first, std::uint64_t last);
  Fault judge_gap(std::uint32_t writer, std::uint64_t start, std::uint64_t base);
  Fault judge_endpoint(const DiscoveryData& data);
  Fault admit();
  /// Takes the locator, or removes it when it is no address of the sender. Returns whether it was taken.
  bool take_locator(Message parameter, std::uint16_t id, bool little, bool announcement);
  bool is_address_of_sender(in_addr_t address, bool announcement) const;
  /// Of a writer of the sender, which is known. Those of a writer that is not announced are not stored.
  Numbers& numbers(std::uint32_t writer);
  void edit(const std::uint8_t* where, std::array<std::uint8_t, 4> bytes, std::size_t size);
  void believe();

  RtpsGuard& guard_;
  Message message_;
  Source source_;
  const ParticipantId& own_;
  Duration now_;
  ParticipantId sender_{};
  Peer* peer_{};      // Null: the sender is unknown, or this participant itself.
  bool bound_{};      // The sender may be believed.
  bool to_us_{true};  // What follows is for us, or for all.
  bool answers_{};    // A submessage addresses us.
  bool leaves_{};     // The sender says goodbye.
  std::size_t removed_{};
  std::vector<Edit> edits_{};
  std::vector<Source> locators_{};  // Of the announcement.
  Numbers unknown_{};               // Of a writer that is not announced.
};

bool RtpsGuard::Reading::find_peer() {
  sender_ = prefix_at(message_.data() + 8);
  const bool radio = guard_.settings_.radio;
  if (sender_ == own_ && own_ != ParticipantId{}) {
    bound_ = !radio || !guard_.settings_.own || guard_.settings_.own(source_);
    return bound_;
  }
  auto known = guard_.peers_.find(sender_);
  if (known != guard_.peers_.end() && now_ - known->second.heard >= Discovery::kLease) {
    guard_.forget(known);
    known = guard_.peers_.end();
  }
  if (!radio) {
    if (known == guard_.peers_.end()) {
      guard_.forget_silent(now_);
      if (guard_.peers_.size() >= kMaxParticipants)
        guard_.forget(std::min_element(guard_.peers_.begin(), guard_.peers_.end(),
                                       [](auto& a, auto& b) { return a.second.heard < b.second.heard; }));
      known = guard_.peers_.try_emplace(sender_).first;
    }
    peer_ = &known->second;
    return bound_ = true;
  }
  if (known == guard_.peers_.end()) return true;
  Peer& peer = known->second;
  if (peer.port == source_.port &&
      std::find(peer.addresses.begin(), peer.addresses.end(), source_.address) != peer.addresses.end()) {
    peer_ = &peer;
    return bound_ = true;
  }
  if (peer.first == source_) {  // Another one had its name while it was silent.
    peer.port = source_.port;
    peer.addresses = {source_.address};
    peer_ = &peer;
    return bound_ = true;
  }
  // After a silence an announcement may bind it to another socket.
  return now_ - peer.heard >= kSilence;
}

std::optional<Refusal> RtpsGuard::Reading::read(std::vector<std::uint8_t>& copy, Message& out) {
  copy.clear();
  if (!has_header(message_) || message_[4] != kSupportedMajor) return Refusal::malformed;
  if (!find_peer()) return Refusal::forged;
  std::size_t kept = kHeader;  // Bytes from the begin of the message without a removed submessage.
  std::size_t at = kHeader;
  while (message_.size() - at >= kSubmessageHeader) {
    Submessage sub{message_[at], message_[at + 1], (message_[at + 1] & 1) != 0, {}};
    std::size_t length = half(message_, at + 2, sub.little);
    const std::size_t rest = message_.size() - at - kSubmessageHeader;
    if (length > rest) break;  // Truncated: the library stops here, too.
    // Length 0 means up to the end of the message, but of these two kinds it means an empty body.
    if (length == 0 && sub.kind != kPad && sub.kind != kInfoTimestamp) length = rest;
    if (length % 4 != 0 && length != rest) return Refusal::malformed;  // Parsers disagree on what follows.
    const std::size_t end = at + kSubmessageHeader + length;
    sub.body = message_.subspan(at + kSubmessageHeader, length);
    const bool ignored = sub.kind >= kFirstVendorKind || sub.kind == kInfoReply ||
                         sub.kind == kInfoReplyIp4 || (!to_us_ && sub.kind != kInfoDestination);
    const std::size_t edits = edits_.size();
    const Fault fault = ignored ? Fault{} : judge(sub);
    if (fault == Refusal::number_jump)  // The rest of the message can be what is waited for.
      ++guard_.refused_[static_cast<std::size_t>(*fault)];
    else if (fault)
      return fault;
    if (ignored || fault) {
      removed_ += end - at;
      edits_.resize(edits);
    } else {
      if (kept == at) {
        kept = end;
      } else {
        if (copy.empty()) copy.assign(message_.begin(), message_.begin() + static_cast<std::ptrdiff_t>(kept));
        copy.insert(copy.end(), message_.begin() + static_cast<std::ptrdiff_t>(at),
                    message_.begin() + static_cast<std::ptrdiff_t>(end));
      }
    }
    at = end;
  }
  if (!bound_) return {};  // Nothing of it is for the library.
  if (copy.empty() && !edits_.empty())
    copy.assign(message_.begin(), message_.begin() + static_cast<std::ptrdiff_t>(kept));
  for (const Edit& e : edits_)
    std::copy_n(e.bytes.begin(), e.size, copy.begin() + static_cast<std::ptrdiff_t>(e.at));
  out = copy.empty() ? message_.first(kept) : Message(copy);
  believe();
  return {};
}

void RtpsGuard::Reading::believe() {
  if (peer_ == nullptr) return;
  peer_->heard = now_;
  if (answers_ && !peer_->answered) {
    peer_->answered = true;
    guard_.drop_locators(*peer_);
  }
  if (leaves_) guard_.forget(guard_.peers_.find(sender_));
}

std::optional<Refusal> RtpsGuard::Reading::judge(const Submessage& sub) {
  const Message body = sub.body;
  constexpr Fault kFine{}, kMalformed = Refusal::malformed;
  switch (sub.kind) {
    case kPad:
      return kFine;
    case kInfoTimestamp:
      return body.size() >= 8 || (sub.flags & 2) != 0 ? kFine : kMalformed;
    case kInfoDestination:
      if (body.size() < 12) return kMalformed;
      // The library takes an empty one for no change.
      if (prefix_at(body.data()) != ParticipantId{})
        to_us_ = own_ == ParticipantId{} || prefix_at(body.data()) == own_;
      answers_ = answers_ || prefix_at(body.data()) == own_;
      return kFine;
    case kInfoSource:  // Nothing that we hear speaks for another participant.
      return Refusal::forged;
    case kData:
    case kDataFrag:
      return judge_sample(sub);
    case kHeartbeat:
      if (body.size() < 28) return kMalformed;
      return judge_heartbeat(entity(body, 4), sequence(sub, 8), sequence(sub, 16));
    case kGap:
      if (!set_fits(sub, 24, 0)) return kMalformed;
      return judge_gap(entity(body, 4), sequence(sub, 8), sequence(sub, 16));
    case kAcknack:
    case kNackFrag:
      return set_fits(sub, sub.kind == kAcknack ? 16 : 20, 4) ? kFine : kMalformed;
    case kHeartbeatFrag:
      return body.size() >= 24 ? kFine : kMalformed;
    default:
      return kMalformed;
  }
}

std::optional<Refusal> RtpsGuard::Reading::judge_sample(const Submessage& sub) {
  const Message body = sub.body;
  const bool fragment = sub.kind == kDataFrag;
  const std::size_t fixed = fragment ? kDataFixed + 12 : kDataFixed;
  // The library takes inline parameters to begin behind the fields that are read here.
  if (body.size() < fixed + 4 || half(body, 2, sub.little) != fixed - 4) return Refusal::malformed;
  const bool with_data = fragment || (sub.flags & kWithData) != 0;
  const bool with_key = !fragment && (sub.flags & kWithKey) != 0;
  if ((with_data && with_key) || (fragment && (sub.flags & kWithData) != 0)) return Refusal::malformed;
  std::optional<std::size_t> payload = fixed;
  if ((sub.flags & kWithQos) != 0) {
    payload = each_parameter(body, fixed, sub.little, [](std::uint16_t id, Message value) {
      if (id == kKeyHash) return value.size() == kGuid;
      if (id == kStatusInfo) return value.size() == 4;
      return value.size() % 4 == 0;
    });
    if (!payload) return Refusal::malformed;
  }
  if ((with_data || with_key) && *payload >= body.size()) return Refusal::malformed;
  const std::uint32_t reader = entity(body, 4), writer = entity(body, 8);
  const std::uint64_t number = sequence(sub, 12);
  if (number == 0 || number >> 62 != 0) return Refusal::malformed;
  if (const Fault fault = judge_number(writer, number)) return fault;
  if (is_discovery_writer(writer) || discovery_writer(reader) != 0) {
    if (discovery_writer(reader) != 0 && discovery_writer(reader) != writer) return Refusal::foreign;
    if (guard_.settings_.radio && sender_ != own_) {
      if (fragment) return Refusal::malformed;
      if (const Fault fault = judge_discovery(sub, writer, *payload)) return fault;
    }
  }
  return fragment ? judge_fragment(sub, writer, *payload) : Fault{};
}

std::optional<Refusal> RtpsGuard::Reading::judge_fragment(const Submessage& sub, std::uint32_t writer,
                                                          std::size_t payload) {
  const std::uint64_t start = word(sub, 20), size = word(sub, 28);
  const std::uint64_t count = half(sub.body, 24, sub.little), bytes = half(sub.body, 26, sub.little);
  const std::uint64_t carried = sub.body.size() - payload;
  if (size == 0 || size > guard_.largest_ + kSampleMargin) return Refusal::sample_size;
  if (start == 0 || count == 0 || bytes == 0) return Refusal::malformed;
  const std::uint64_t fragments = (size + bytes - 1) / bytes, last = start - 1 + count;
  if (last > fragments) return Refusal::malformed;
  // The library copies what the header says: all of it must be there.
  const std::uint64_t end = std::min(last * bytes, size), begin = (start - 1) * bytes;
  if (carried < end - begin) return Refusal::malformed;
  if (peer_ == nullptr) return {};
  // It keeps the sizes of the first fragment of a sample, and copies the others by them.
  constexpr std::size_t kSamples = 64;
  Numbers& n = numbers(writer);
  const std::uint64_t number = sequence(sub, 12);
  if (number <= n.fragmented_before) return Refusal::number_jump;
  const std::pair sizes{static_cast<std::uint32_t>(size), static_cast<std::uint16_t>(bytes)};
  if (n.fragmented.try_emplace(number, sizes).first->second != sizes) return Refusal::malformed;
  if (n.fragmented.size() > kSamples) {
    n.fragmented_before = n.fragmented.begin()->first;
    n.fragmented.erase(n.fragmented.begin());
  }
  return {};
}

std::optional<Refusal> RtpsGuard::Reading::judge_discovery(const Submessage& sub, std::uint32_t writer,
                                                           std::size_t payload) {
  DiscoveryData data;
  bool known_status = true;  // The library takes an unknown one for none.
  if ((sub.flags & kWithQos) != 0) {
    each_parameter(sub.body, kDataFixed, sub.little, [&](std::uint16_t id, Message value) {
      if (id == kKeyHash) {
        data.named = true;
        data.foreign = data.foreign || prefix_at(value.data()) != sender_;
        data.endpoint = entity(value, 12);
      }
      if (id == kStatusInfo) {
        data.goodbye = value[3] != 0;
        known_status = known_status && value[0] == 0 && value[1] == 0 && value[2] == 0 && value[3] <= 3;
      }
      return true;
    });
  }
  if (!known_status) return Refusal::malformed;
  const bool announcement = writer == kAnnouncingWriter;
  if ((sub.flags & kWithData) != 0) {
    if (const Fault fault = judge_payload(sub, writer, payload, data)) return fault;
  } else {
    if (!data.goodbye) return Refusal::malformed;
    if ((sub.flags & kWithKey) != 0) {
      const Message key = sub.body.subspan(payload);  // The library takes up to 16 bytes of it for a GUID.
      if (key.size() <= kGuid && (key.size() != kGuid || prefix_at(key.data()) != sender_))
        return Refusal::foreign;
    }
  }
  if (data.foreign || !data.named) return Refusal::foreign;
  if (!announcement) {
    if (!bound_) return {};
    if (!data.goodbye) return judge_endpoint(data);
    if (peer_ != nullptr) {
      peer_->endpoints.erase(data.endpoint);
      peer_->numbers.erase(data.endpoint);
    }
    return {};
  }
  if (data.goodbye) {
    leaves_ = bound_;
    return {};
  }
  return admit();
}

std::optional<Refusal> RtpsGuard::Reading::judge_payload(const Submessage& sub, std::uint32_t writer,
                                                         std::size_t payload, DiscoveryData& data) {
  const Message body = sub.body;
  constexpr std::uint8_t kListBigEndian = 2, kListLittleEndian = 3;
  if (payload + 4 > body.size() || body[payload] != 0) return Refusal::malformed;
  const std::uint8_t encapsulation = body[payload + 1];
  if (encapsulation != kListBigEndian && encapsulation != kListLittleEndian) return Refusal::malformed;
  const bool little = encapsulation == kListLittleEndian;
  const bool announcement = writer == kAnnouncingWriter;
  const std::uint16_t name = announcement ? kParticipantGuid : kEndpointGuid;
  bool well_formed = true;
  locators_.clear();
  const auto end = each_parameter(body, payload + 4, little, [&](std::uint16_t id, Message value) {
    well_formed = well_formed && value.size() % 4 == 0;
    switch (id) {
      case kParticipantGuid:
      case kEndpointGuid:
      case kKeyHash:  // The library reads it here, too.
        if (value.size() != kGuid) return well_formed = false;
        data.foreign = data.foreign || prefix_at(value.data()) != sender_;
        data.named = data.named || id == name;
        if (id == kEndpointGuid) data.endpoint = entity(value, 12);
        break;
      case kLease: {
        if (!announcement) break;
        if (value.size() != 8) return well_formed = false;
        constexpr auto seconds = static_cast<std::uint8_t>(Discovery::kLease / 1s);
        using Word = std::array<std::uint8_t, 4>;
        edit(value.data(), little ? Word{seconds, 0, 0, 0} : Word{0, 0, 0, seconds}, 4);
        edit(value.data() + 4, {}, 4);
        break;
      }
      case kUnicast:
      case kDefaultUnicast:
      case kMetatrafficUnicast:
      case kMulticast:
      case kMetatrafficMulticast:
      case kDefaultMulticast:
        if (value.size() != kLocator) return well_formed = false;
        if (!take_locator(value, id, little, announcement))
          edit(value.data() - 4, {}, 2);  // Its id becomes that of padding.
        break;
      default:
        break;
    }
    return well_formed;
  });
  return well_formed && end ? Fault{} : Refusal::malformed;
}

bool RtpsGuard::Reading::is_address_of_sender(in_addr_t address, bool announcement) const {
  if (address == source_.address) return true;
  if (!announcement)
    return peer_ != nullptr &&
           std::find(peer_->addresses.begin(), peer_->addresses.end(), address) != peer_->addresses.end();
  // A participant with interfaces on two of our networks has one address on each.
  const Settings& s = guard_.settings_;
  return (!s.reachable || s.reachable(address)) && s.neighbours && !s.neighbours(address, source_.address);
}

bool RtpsGuard::Reading::take_locator(Message value, std::uint16_t id, bool little, bool announcement) {
  constexpr std::uint32_t kUdpV4 = 1, kRtpsGroup = 0xefff0001;  // 239.255.0.1
  if (word(value, 0, little) != kUdpV4) return false;
  const std::uint32_t port = word(value, 4, little);
  in_addr_t address{};
  std::memcpy(&address, value.data() + 20, sizeof address);
  if (id == kMulticast || id == kMetatrafficMulticast || id == kDefaultMulticast)
    return ntohl(address) == kRtpsGroup;
  if (port == 0 || port > UINT16_MAX || !is_address_of_sender(address, announcement)) return false;
  if (!announcement) return true;
  if (locators_.size() >= kMaxLocators) return false;
  locators_.push_back({address, static_cast<std::uint16_t>(port)});
  return true;
}

std::optional<Refusal> RtpsGuard::Reading::judge_endpoint(const DiscoveryData& data) {
  if (peer_ == nullptr) return {};
  if (!peer_->endpoints.contains(data.endpoint) && peer_->endpoints.size() >= kMaxEndpoints)
    return Refusal::too_many;
  peer_->endpoints.insert(data.endpoint);
  return {};
}

std::optional<Refusal> RtpsGuard::Reading::admit() {
  if (locators_.empty()) return Refusal::foreign;  // Answers would go to others.
  Peers& peers = guard_.peers_;
  if (peer_ == nullptr) {
    Source first = source_;
    if (const auto moved = peers.find(sender_); moved != peers.end()) {
      first = moved->second.first;
      guard_.forget(moved);
    }
    if (peers.size() >= kMaxParticipants) guard_.forget_silent(now_);
    std::size_t here = 0, unanswered = 0;
    for (const auto& [id, peer] : peers) {
      if (peer.addresses.front() != source_.address) continue;
      ++here;
      unanswered += peer.answered ? 0 : 1;
    }
    if (peers.size() >= kMaxParticipants || here >= kMaxPerAddress || unanswered >= kMaxUnanswered)
      return Refusal::too_many;
    peer_ = &peers[sender_];
    peer_->port = source_.port;
    peer_->first = first;
    peer_->met = now_;
    bound_ = true;
  }
  guard_.drop_locators(*peer_);
  peer_->addresses = {source_.address};
  for (const Source& locator : locators_) {
    if (std::find(peer_->addresses.begin(), peer_->addresses.end(), locator.address) ==
        peer_->addresses.end())
      peer_->addresses.push_back(locator.address);
    const bool used = std::any_of(peers.begin(), peers.end(), [&](const auto& entry) {
      const auto& theirs = entry.second.locators;
      return entry.second.answered && std::find(theirs.begin(), theirs.end(), locator) != theirs.end();
    });
    if (!peer_->answered && !used) guard_.unanswered_.try_emplace(locator, sender_);
  }
  peer_->locators = locators_;
  return {};
}

RtpsGuard::Numbers& RtpsGuard::Reading::numbers(std::uint32_t writer) {
  const auto known = peer_->numbers.find(writer);
  if (known != peer_->numbers.end()) return known->second;
  // On a radio domain the library ignores a writer that was not announced, unless it missed its goodbye.
  constexpr std::size_t kMaxWriters = 1024;
  const bool announced =
      !guard_.settings_.radio || is_discovery_writer(writer) || peer_->endpoints.contains(writer);
  if (!announced || peer_->numbers.size() >= kMaxWriters) return unknown_ = {};
  return peer_->numbers[writer];
}

std::optional<Refusal> RtpsGuard::Reading::judge_number(std::uint32_t writer, std::uint64_t number) {
  if (peer_ == nullptr) return {};
  Numbers::Start& start = numbers(writer).samples;
  if (start.number == 0) start = {number, now_};
  return number <= start.most(now_) ? Fault{} : Refusal::number_jump;
}

std::optional<Refusal> RtpsGuard::Reading::judge_heartbeat(std::uint32_t writer, std::uint64_t first,
                                                           std::uint64_t last) {
  if (first == 0 || first >> 62 != 0 || last >> 62 != 0 || last + 1 < first) return Refusal::malformed;
  if (peer_ == nullptr) return {};
  Numbers& n = numbers(writer);
  const bool is_first = n.beats.number == 0;
  const Numbers::Start start = is_first ? Numbers::Start{first, now_} : n.beats;
  const std::uint64_t most_at_first = guard_.settings_.radio ? kMaxFirst : kMaxFirstElsewhere;
  if (first > (is_first ? most_at_first : start.most(now_))) return Refusal::number_jump;
  // A history can begin long before its last sample.
  const std::uint64_t newest =
      std::max(start.most(now_), n.samples.number != 0 ? n.samples.most(now_) : most_at_first);
  if (last > newest) return Refusal::number_jump;
  n.beats = start;
  return {};
}

std::optional<Refusal> RtpsGuard::Reading::judge_gap(std::uint32_t writer, std::uint64_t start,
                                                     std::uint64_t base) {
  if (start == 0 || base < start || base >> 62 != 0) return Refusal::malformed;
  if (base - start > kMaxGap) return Refusal::number_jump;
  if (peer_ == nullptr) return {};
  Numbers& n = numbers(writer);
  const std::uint64_t forgiven = kGapPerSecond * static_cast<std::uint64_t>((now_ - n.gaps_at) / 1s);
  if (forgiven > 0) n.gaps -= std::min(n.gaps, forgiven), n.gaps_at = now_;
  if (n.gaps + (base - start) > kMaxGap) return Refusal::number_jump;
  n.gaps += base - start;
  return {};
}

void RtpsGuard::Reading::edit(const std::uint8_t* where, std::array<std::uint8_t, 4> bytes,
                              std::size_t size) {
  edits_.push_back({static_cast<std::size_t>(where - message_.data()) - removed_, bytes, size});
}

void RtpsGuard::drop_locators(const Peer& peer) {
  for (const Source& locator : peer.locators) unanswered_.erase(locator);
}

void RtpsGuard::forget(Peers::iterator peer) {
  drop_locators(peer->second);
  peers_.erase(peer);
}

void RtpsGuard::forget_silent(Duration now) {
  for (auto peer = peers_.begin(); peer != peers_.end();) {
    const auto here = peer++;
    if (now - here->second.heard >= Discovery::kLease) forget(here);
  }
}

void RtpsGuard::admit_samples(std::uint32_t max_bytes) {
  const std::lock_guard lock(mutex_);
  largest_ = std::max(largest_, max_bytes);
}

std::span<const std::uint8_t> RtpsGuard::pass(std::span<const std::uint8_t> message, Source source,
                                              const ParticipantId& own, Duration now,
                                              std::vector<std::uint8_t>& copy) {
  const std::lock_guard lock(mutex_);
  Message out{};
  const auto refusal = Reading(*this, message, source, own, now).read(copy, out);
  if (!refusal) return out;
  ++refused_[static_cast<std::size_t>(*refusal)];
  return {};
}

bool RtpsGuard::may_send(in_addr_t address, std::uint16_t port, std::uint64_t bytes, Duration now) {
  const std::lock_guard lock(mutex_);
  const auto known = unanswered_.find({address, port});
  if (known == unanswered_.end()) return true;
  Peer& peer = peers_.at(known->second);
  const auto seconds = static_cast<std::uint64_t>((now - peer.met) / 1s);
  if (peer.sent + bytes > kFirstBytes + kBytesPerSecond * seconds) {
    ++refused_[static_cast<std::size_t>(Refusal::rationed)];
    return false;
  }
  peer.sent += bytes;
  return true;
}

RefusalCounts RtpsGuard::refused() const {
  const std::lock_guard lock(mutex_);
  return refused_;
}

}  // namespace adit::wire
