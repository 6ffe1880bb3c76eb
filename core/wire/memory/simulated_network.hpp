// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/exec/virtual_runtime.hpp"
#include "core/wire/link.hpp"
#include "core/wire/memory/disturbance.hpp"
#include "core/wire/participant.hpp"

namespace adit::wire {

/// Parameters of SimulatedNetwork.
struct SimulatedNetworkParams {
  std::uint64_t seed{1};           ///< Seed of losses and participant ids.
  std::uint32_t radio_domain{77};  ///< This domain passes the radio model; all others are inner networks.
  LinkProfile link{};              ///< Between machines without a set_link() of their own.
  Duration inner_latency{100us};   ///< One-way latency of inner networks, which lose nothing, [0, 1 s].
};

/// One sample on the radio, reported at the sender and again at each receiver.
struct SampleEvent {
  enum class Kind : std::uint8_t {
    sent,       ///< Written by `from`; `to` is empty.
    delivered,  ///< Passed to the reader of `to`.
    lost,       ///< Best effort: did not reach `to`.
  };
  Kind kind{};
  Duration at{};  ///< Virtual time.
  ParticipantId from{}, to{};
  std::string_view from_name{}, to_name{};  ///< Names as given to join().
  std::uint32_t domain{};
  std::string_view topic{}, type{}, partition{};
  std::span<const std::uint8_t> bytes{};  ///< Serialised sample with its encapsulation header.
};

/// Simulates the radio and the inner networks of a rehearsal on virtual time. Participants have the topics
/// and QoS classes of the real wire, and the radio model is charged with what the real wire costs: RTPS, UDP
/// and IP headers, participant announcements, endpoint discovery of each pair, heartbeats, acknowledgements
/// and repairs. A sender's datagrams leave frame by frame at the link's bandwidth, by priority of their class
/// and within its budget; each frame is lost independently (core/wire/link/). All calls are made on the
/// scheduler's thread. The same seed gives the same run.
///
/// Machines are identified by name. Their positions and links outlive their participants.
class SimulatedNetwork {
 public:
  SimulatedNetwork(VirtualScheduler& scheduler, SimulatedNetworkParams params);
  ~SimulatedNetwork();  ///< Participants that still exist stay valid, but send and receive nothing.
  SimulatedNetwork(const SimulatedNetwork&) = delete;
  SimulatedNetwork& operator=(const SimulatedNetwork&) = delete;

  /// Creates a participant of `machine`, with an id never used before. Its destructor says goodbye to the
  /// others.
  std::unique_ptr<Participant> join(std::uint32_t domain, const std::string& machine);
  /// Silences the machine's participants at once, without a goodbye: they send and receive nothing more.
  /// Others drop them when their lease expires. Participants of a later join() work again.
  void crash(const std::string& machine);

  /// Sets the link between two machines, in both directions.
  void set_link(const std::string& a, const std::string& b, const LinkProfile& profile);
  /// Adds a fault of the radio from now until end_disturbance() of the returned number. Faults overlap: each
  /// `for:` of a script ends only its own.
  DisturbanceId disturb(Disturbance disturbance);
  void end_disturbance(DisturbanceId id);
  /// Cuts the link between two machines both ways, or restores it. Repeated calls do not add up.
  void cut(const std::string& a, const std::string& b, bool is_cut);
  /// Replaces the link's loss probability between two machines both ways, [0, 1]; nullopt restores the link's
  /// own. Repeated calls do not add up.
  void degrade(const std::string& a, const std::string& b, std::optional<double> loss);
  /// World coordinates, m; for links with a range or that fade.
  void set_position(const std::string& machine, double x, double y, double z = 0.0);
  /// Sets the function for the attenuation by obstacles between two positions, dB, >= 0; it applies to links
  /// that fade. It is called for every frame on such a link and must be cheap. An empty function means no
  /// walls.
  void set_attenuation(Attenuation walls);
  /// Mean received power between two machines, dBm. Nothing when the link does not fade or a position is not
  /// known.
  std::optional<double> signal(const std::string& from, const std::string& to) const;

  /// Sets a function that is called for every sample sent, delivered and lost; the views are valid only
  /// during the call.
  void set_tap(std::function<void(const SampleEvent&)> tap);

  struct State;  // Shared with the participants; private to core/wire/memory.

 private:
  std::shared_ptr<State> core_;
  // Faults set by cut() and degrade().
  std::map<std::pair<std::string, std::string>, DisturbanceId> cuts_{}, degraded_{};
};

}  // namespace adit::wire
