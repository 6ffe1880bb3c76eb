#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>

#include "core/geometry/pose.hpp"
#include "core/result/reason.hpp"
#include "core/wire/wire.hpp"

/// What the command interface speaks, free of generated message types: robot_agent/radio/convert.cpp
/// converts at the edge.
namespace adit::agent {

/// Of the radio contract.
inline constexpr std::uint16_t kProtocolVersion = 1;

/// 128 random bits kept on the owner's disk.
using Id = std::array<std::uint8_t, 16>;

/// Who rules since when; compared for equality only.
struct Epoch {
  std::uint64_t start{};    ///< drawn anew at each start of the agent
  std::uint32_t counter{};  ///< rises with every change of holder
  bool operator==(const Epoch&) const = default;
};

/// Who a message says it is from, and the participant that really sent it.
struct Sender {
  std::string name{};
  Id id{};
  wire::ParticipantId participant{};
};

enum class CommandKind : std::uint8_t {
  take,
  release,
  lock,
  unlock,
  grant,
  stop,
  reset,
  mode,
  go_to,
  query,
  restart,
  policy,
  plan,
  unknown
};

struct Command {
  std::string robot{};
  Sender from{};
  Epoch epoch{};
  std::uint64_t seq{};
  CommandKind kind{CommandKind::query};
  std::string text{};  ///< mode: its name; grant: the operator's; restart, policy: the component
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  ///< goto, plan: map frame, m; z may be NaN
  bool flag{};                                        ///< reset: override; policy: automatic
};

/// Exactly one per command and repeat.
struct Answer {
  std::string station{};
  Id station_id{};
  std::uint64_t seq{};  ///< 0 for a refused stream
  Reason reason{Reason::none};
  std::string text{};
  std::string holder{};
  Epoch epoch{};
  bool accepted() const { return reason == Reason::none; }
};

struct StickSample {
  std::string robot{};
  Id station_id{};
  wire::ParticipantId participant{};
  Epoch epoch{};
  std::uint64_t seq{};
  std::uint64_t echo{};  ///< a stamp of ours, ns
  Twist2 twist{};        ///< body frame
};

enum class Severity : std::uint8_t { info, warning, error };

/// Something an operator should know.
struct Notice {
  std::string operator_name{};  ///< whom it concerns; empty: everybody
  Severity severity{Severity::info};
  std::string code{};
  Reason reason{Reason::none};
  std::string text{};
};

/// 1 to 32 of [A-Za-z0-9_-].
bool valid_name(const std::string& name);

}  // namespace adit::agent
