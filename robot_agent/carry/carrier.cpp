// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/carry/carrier.hpp"

#include "core/time/random.hpp"
#include "robot_agent/perception/piece_job.hpp"

namespace adit::agent {
namespace {

constexpr const char* kNoRoom = "no room to carry more of the map";

}  // namespace

Carrier::Carrier(std::uint64_t seed, CarryBounds bounds)
    : poses_(bounds, [this](const transfer::PeerId& station,
                            const std::string& robot) { return views_.wants(station, robot, now_); }),
      blocks_(bounds, [this](const transfer::PeerId& station, const std::string& robot) {
        return views_.wants(station, robot, now_);
      }) {
  Random random(seed);
  for (std::uint8_t& byte : id_) byte = static_cast<std::uint8_t>(random.below(256));
}

void Carrier::compute_on(Executor& strand, Task ready) {
  strand_ = &strand;
  blocks_.encode_on(strand, std::move(ready));
}

void Carrier::tick(Time now) {
  now_ = now;
  blocks_.tick();
}

Result<void> Carrier::take(const contract::BulkPiece& piece, Time now) {
  if (decoding_ >= kMaxDecoding) {
    ++refused_;
    return {Reason::queue_full, "too many pieces are decoded"};
  }
  const auto outcome = std::make_shared<Result<void>>();
  ++decoding_;
  store(piece, [this, piece, now, outcome](const Result<void>& stored) {
    --decoding_;
    note(piece, stored, strand_ != nullptr ? strand_->now() : now);
    *outcome = stored;
  });
  return *outcome;
}

void Carrier::note(const contract::BulkPiece& piece, const Result<void>& stored, Time now) {
  if (!stored) ++refused_;
  if (stored || transfer::is_acknowledged(stored.reason()))
    (void)receiver_.take(piece.robot, piece.session, piece.id, now);
}

void Carrier::store(const contract::BulkPiece& piece, Stored done) {
  if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::map_blocks))
    decode(piece, nullptr, std::move(done));
  else if (piece.kind == static_cast<std::uint8_t>(transfer::Kind::map_poses))
    done(store_poses(piece));
  else
    done({Reason::not_supported, "no part of a map"});
}

void Carrier::decode(const contract::BulkPiece& piece, std::shared_ptr<const Bases> bases, Stored done) {
  // At first the bases are not known: decoding says of which blocks it wants them.
  struct Decoded {
    Result<perception::MapPiece> blocks{perception::MapPiece{}};
    perception::SubmapKey key{};
    std::vector<perception::BlockIndex> wanted{};
  };
  compute_or_now(
      strand_, {.name = "carried piece", .modelled = kPieceCoding, .lane = "carried piece"},
      [data = piece.data, bases] {
        // Of no block: its checksum differs from that of what the sender has.
        constexpr std::uint64_t kUnknown = 0x9e37'79b9'7f4a'7c15;
        Decoded out;
        out.blocks = perception::decode(
            data, [&](const auto& key, const auto& index) -> std::optional<perception::CoarseBlock> {
              if (bases) {
                const auto base = bases->find(index);
                return base == bases->end() ? std::nullopt : std::optional(base->second);
              }
              out.key = key;
              out.wanted.push_back(index);
              return perception::CoarseBlock{index, kUnknown, kUnknown};
            });
        return out;
      },
      [this, piece, done = std::move(done)](const Result<Decoded>& decoded) {
        // Not acknowledged, as it comes again.
        if (!decoded) return done({Reason::out_of_range, decoded.error().text});
        if (decoded->wanted.empty()) return done(store_blocks(decoded->blocks, piece.robot));
        auto here = std::make_shared<Bases>();
        for (const perception::BlockIndex& index : decoded->wanted)
          if (const auto block = blocks_.find(decoded->key, index)) (*here)[index] = *block;
        decode(piece, std::move(here), done);
      });
}

Result<void> Carrier::store_blocks(const Result<perception::MapPiece>& blocks, const std::string& robot) {
  if (!blocks) return blocks.error();
  if (blocks->key.robot != robot) return {Reason::malformed, "a piece of another robot's map"};
  if (!blocks_.take(*blocks)) return {Reason::queue_full, kNoRoom};
  return {};
}

Result<void> Carrier::store_poses(const contract::BulkPiece& piece) {
  const auto poses = perception::decode_poses(piece.data);
  if (!poses) return poses.error();
  for (const perception::SubmapPose& pose : poses->poses)
    if (pose.key.robot != piece.robot) return {Reason::malformed, "poses of another robot's map"};
  if (!poses_.take(piece.robot, *poses)) return {Reason::queue_full, kNoRoom};
  return {};
}

void Carrier::heard(const transfer::Ack& ack, Time now) {
  now_ = now;
  views_.heard(ack, now);
  for (const transfer::ContentDigest& digest : ack.digests) {
    poses_.compare(ack.peer, digest);
    blocks_.compare(ack.peer, digest);
  }
}

}  // namespace adit::agent
