// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/contract/camera.hpp"
#include "core/transfer/pacer.hpp"
#include "perception/camera/ladder.hpp"
#include "perception/camera/stripe_encoder.hpp"
#include "robot_agent/camera/camera_calls.hpp"

namespace adit::agent {

/// What one camera is to send, and the pieces of the one picture that is on its way. A state machine without
/// a clock; CameraPart does the work that it asks for.
class CameraStream {
 public:
  static constexpr std::size_t kMaxLookers = 16;
  static constexpr Duration kLooks{3s};      ///< After a station's last view it no longer looks.
  static constexpr Duration kShotWait{10s};  ///< A shot that could not be taken by then is given up.

  explicit CameraStream(std::uint32_t run) : run_(run) {}

  /// Takes what a station looks at; a width of 0 ends it.
  void look(const transfer::PeerId& station, const contract::CameraView& view, Time now);
  /// Whether live pictures are wanted; shots alone do not count.
  bool is_watched(Time now) const;
  /// Whether a shot is wanted.
  bool shot_wanted(Time now) const;
  bool is_active(Time now) const { return is_watched(now) || shot_wanted(now); }

  /// Chooses size and rate. `bytes_per_second`: what the link leaves to this camera.
  void adapt(double bytes_per_second, Time now);
  const perception::Rung& rung() const { return choice_.rung; }
  /// Whether the next live picture may be coded: the one before is sent, and its time has come.
  bool is_ready(Time now) const;
  /// Notes that a picture is being coded, or that it could not be.
  void begin(Time now);
  void failed();
  /// Drops the pieces of a picture that is on its way.
  void drop() { outgoing_.clear(); }

  /// What the encoder knows of the receivers; it is used by one job at a time, between begin() and the next.
  std::shared_ptr<perception::StripeEncoder> encoder() { return encoder_; }
  /// Applies what receivers reported missing; call it before a job.
  void prepare_encoder();
  /// Takes a coded picture; its pieces go out next, if it is still watched. `most`: bytes of a piece.
  void coded(perception::StripeEncoder::Coded picture, std::uint64_t stamp,
             const std::optional<Pose3>& T_map_camera, Time exposed, std::size_t most, Time now);
  bool has_pieces() const { return !outgoing_.empty(); }
  /// The next piece, with its age at this time.
  std::vector<std::uint8_t> next_piece(Time now);

  /// Stations whose shots the next picture is for, and their numbers.
  std::vector<std::pair<transfer::PeerId, std::uint32_t>> wanted_shots(Time now) const;
  /// Notes that such a shot was taken.
  void took_shot(const transfer::PeerId& station, std::uint32_t number);

  /// Pieces that were sent, and how many of them arrived, by the reports of stations since the last call.
  struct Arrivals {
    std::uint32_t sent{}, arrived{};
  };
  Arrivals take_arrivals();

 private:
  struct Looker {
    contract::CameraView view{};
    Time until{};
    std::uint32_t shot_done{};
    Time shot_since{};
    std::uint32_t arrived{}, sent{};  ///< At its last report of this run.
    bool reported{};                  ///< There was one since it began to look.

    bool wants_shot(Time now) const {
      return view.shot != 0 && view.shot != shot_done && now - shot_since < kShotWait;
    }
  };
  std::uint32_t run_;
  std::map<transfer::PeerId, Looker> lookers_{};
  perception::Ladder ladder_{};
  perception::Ladder::Choice choice_{};
  std::shared_ptr<perception::StripeEncoder> encoder_{std::make_shared<perception::StripeEncoder>()};
  bool all_stripes_{};                   ///< A station began to look: it has none.
  std::vector<std::uint8_t> missing_{};  ///< Stripes that some receiver lacks.
  std::uint32_t format_since_{};         ///< First frame of the present format.
  perception::PictureFormat format_{};
  std::deque<perception::PicturePiece> outgoing_{};
  Time exposed_{};  ///< Of the picture that is on its way.
  Time base_{};     ///< The next picture is due a period later.
  bool coding_{};
  std::uint32_t frame_{}, pieces_{};
  Arrivals arrivals_{};
};

}  // namespace adit::agent
