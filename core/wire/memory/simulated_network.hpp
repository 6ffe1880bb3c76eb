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

struct SimulatedNetworkParams {
  std::uint64_t seed{1};           ///< of losses and participant ids
  std::uint32_t radio_domain{77};  ///< this one passes the radio model; all others are inner networks
  LinkProfile link{};              ///< between machines for which set_link() says nothing else
  Duration inner_latency{100us};   ///< one way on inner networks, which lose nothing, [0, 1 s]
};

/// One sample seen on the air: at the sender, and once more at each receiver.
struct SampleEvent {
  enum class Kind : std::uint8_t {
    sent,       ///< handed to the wire by `from`; `to` is nobody
    delivered,  ///< handed to the reader of `to`
    lost,       ///< best effort: did not reach `to`
  };
  Kind kind{};
  Duration at{};  ///< virtual time
  ParticipantId from{}, to{};
  std::string_view from_name{}, to_name{};  ///< as given to join()
  std::uint32_t domain{};
  std::string_view topic{}, type{}, partition{};
  std::span<const std::uint8_t> bytes{};  ///< serialised sample with its encapsulation header
};

/// The radio and the inner networks of a rehearsal: wires with the topics and QoS classes of the real one, on
/// virtual time. What the real one costs is charged to the radio model: RTPS, UDP and IP headers,
/// participant announcements, endpoint discovery of each pair, heartbeats, acknowledgements, repairs. A
/// sender's datagrams leave frame by frame at the link's bandwidth, by priority of their class and within its
/// budget; frames are lost one by one (core/wire/link/). All calls on the scheduler's thread. Same seed, same
/// run.
///
/// Machines are known by name. Their positions and links outlive their participants.
class SimulatedNetwork {
 public:
  SimulatedNetwork(VirtualScheduler& scheduler, SimulatedNetworkParams params);
  ~SimulatedNetwork();  ///< wires still open stay valid but are silent
  SimulatedNetwork(const SimulatedNetwork&) = delete;
  SimulatedNetwork& operator=(const SimulatedNetwork&) = delete;

  /// A new participant of `machine`, with an id never used before. Destroying it says goodbye to the others.
  std::unique_ptr<Participant> join(std::uint32_t domain, const std::string& machine);
  /// The machine's participants fall silent at once, without a goodbye: nothing more is sent or heard.
  /// Others drop them when their lease runs out. A later join() is heard again.
  void crash(const std::string& machine);

  /// Both directions between two machines.
  void set_link(const std::string& a, const std::string& b, const LinkProfile& profile);
  /// A fault of the radio from now on, until end_disturbance() of the returned number. Faults overlap: each
  /// `for:` of a script ends only its own.
  DisturbanceId disturb(Disturbance disturbance);
  void end_disturbance(DisturbanceId id);
  /// A cut both ways between two machines, as a switch: it does not count how often it was set.
  void cut(const std::string& a, const std::string& b, bool is_cut);
  /// Another chance of loss than the link's both ways, [0, 1], as a switch; nullopt: the link's own again.
  void degrade(const std::string& a, const std::string& b, std::optional<double> loss);
  /// World coordinates, m; for links with a range or that fade.
  void set_position(const std::string& machine, double x, double y, double z = 0.0);
  /// Attenuation by what stands between two positions, dB, >= 0; counts on links that fade. Asked for every
  /// frame on such a link: keep it cheap. An empty one: no walls.
  void set_attenuation(Attenuation walls);
  /// Mean received power between two machines, dBm; nothing where the link does not fade or a position is
  /// not known.
  std::optional<double> signal(const std::string& from, const std::string& to) const;

  /// Called for every sample sent, delivered and lost; the views are valid during the call only.
  void set_tap(std::function<void(const SampleEvent&)> tap);

  struct State;  // shared with the wires, private to core/wire/memory

 private:
  std::shared_ptr<State> core_;
  std::map<std::pair<std::string, std::string>, DisturbanceId> cuts_{}, degraded_{};  // the switches
};

}  // namespace adit::wire
