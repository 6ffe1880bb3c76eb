// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/radio/radio_edge.hpp"

#include <utility>

#include "adit/authority.h"
#include "adit/bulk.h"
#include "adit/camera.h"
#include "adit/command.h"
#include "adit/discovery.h"
#include "adit/link.h"
#include "adit/robot.h"
#include "adit/team.h"
#include "core/contract/bulk.hpp"
#include "core/contract/link.hpp"
#include "core/contract/traffic_meter.hpp"
#include "core/wire/component_io.hpp"
#include "core/wire/link/peer_meter.hpp"
#include "core/wire/topics.hpp"
#include "robot_agent/radio/convert.hpp"

namespace adit::agent {

namespace topics = wire::topics;

constexpr Duration kPresencePeriod = 1s;

struct RadioEdge::Endpoints {
  wire::ComponentIo io;
  std::string robot;
  wire::Participant& wire{io.wire};
  Executor& strand{io.strand};
  contract::TrafficMeter meter{1s};
  std::uint64_t seq{};

  wire::Writer<radio::Acknowledgement> acknowledgement{};
  wire::Writer<radio::AuthorityStatus> authority{};
  wire::Writer<radio::BehaviourState> behaviour{};
  wire::Writer<radio::RobotState> state{};
  wire::Writer<radio::Route> route{};
  wire::Writer<radio::Capabilities> capabilities{};
  wire::Writer<radio::LinkReport> link{};
  wire::Writer<radio::Presence> presence{};
  wire::Writer<radio::TeamBeacon> team{};
  wire::Writer<radio::BulkPiece> bulk{}, bulk_to_carriers{};
  wire::Writer<radio::BulkAck> carrier_ack{};  ///< Open if this robot carries maps.
  std::function<void(const radio::BulkAck&, const wire::SampleInfo&)> acknowledged{};
  bool reaches_carriers{false};
  contract::Presence presence_sample{};
  contract::Capabilities capabilities_sample{};
  wire::PeerMeter stations{};  // Quality of the link from each station.
  Timer presence_timer{};
  std::uint64_t malformed{};
  std::vector<std::unique_ptr<wire::RawReader>> readers{};

  template <class T, class Handler>
  Result<void> read(const wire::Topic<T>& topic, Handler handler, const std::string& partition = {}) {
    return io.open(readers.emplace_back(), topic, std::move(handler), partition);
  }
  void say_present() {
    if (presence_sample.name.empty()) return;  // send_capabilities() was not called yet.
    ++presence_sample.seq;
    (void)presence.write(encode(presence_sample));
  }
  // The participant counts failed writes, and the link report shows them.
  template <class T>
  void send(wire::Writer<T>& writer, T sample) {
    sample.seq(++seq);
    (void)writer.write(sample);
  }
};

RadioEdge::RadioEdge(std::unique_ptr<Endpoints> endpoints) : endpoints_(std::move(endpoints)) {}
RadioEdge::~RadioEdge() = default;

Result<std::unique_ptr<RadioEdge>> RadioEdge::open(const wire::ComponentIo& io, const std::string& robot) {
  std::unique_ptr<Endpoints> e(new Endpoints{io, robot});
  for (const auto& made :
       {io.open(e->acknowledgement, topics::kAcknowledgement), io.open(e->authority, topics::kAuthority),
        io.open(e->behaviour, topics::kBehaviour), io.open(e->state, topics::kRobotState),
        io.open(e->capabilities, topics::kCapabilities), io.open(e->link, topics::kLinkReport),
        io.open(e->presence, topics::kPresence), io.open(e->team, topics::kTeam),
        io.open(e->bulk, topics::kBulk)})
    if (!made) return made.error();
  return std::unique_ptr<RadioEdge>(new RadioEdge(std::move(e)));
}

Result<void> RadioEdge::listen(Dependencies dependencies) {
  Endpoints& e = *endpoints_;
  Directory& directory = dependencies.directory;
  const auto& commands = dependencies.commands;
  const auto answer = [&e, settle = dependencies.settle](const std::optional<Answer>& a) {
    if (!a) return;
    radio::Acknowledgement sample = encode(*a);
    sample.robot(e.robot);
    const auto send = [&e, sample = std::move(sample)] { (void)e.acknowledgement.write(sample); };
    if (a->seq == 0) return send();  // A stick sample changes no stored state.
    settle(send);
  };
  Namesakes& namesakes = dependencies.namesakes;
  e.acknowledged = [&e, taken = dependencies.pieces_acknowledged](const radio::BulkAck& a,
                                                                  const wire::SampleInfo& info) {
    const auto ack = contract::decode(a);
    if (taken && ack) taken(ack->station, ack->to(e.robot), info.sender);
  };
  e.wire.on_participant(e.strand,
                        [&e, commands, &directory, &namesakes](const wire::ParticipantEvent& event) {
                          if (!e.io.valid()) return;
                          if (!event.incompatible.empty()) return;  // Stations notify their operators.
                          directory.on_participant(event);
                          if (!event.present) namesakes.left(event.id);
                          if (event.present)
                            e.say_present();  // Sends a heartbeat at once, not at the next second.
                          else
                            commands([&](CommandInterface& interface) { interface.departed(event.id); });
                        });
  for (const auto& made : {
           e.read(topics::kPresence,
                  [&e, commands, &directory, &namesakes](const radio::Presence&sample,
                                                         const wire::SampleInfo&info) {
                    const auto p = contract::decode(sample);
                    if (!p) return;
                    const Time now = info.received;  // The strand may have been busy since.
                    if (p->kind == contract::AgentKind::station) {
                      e.stations.heard(p->name, p->seq, now);
                      namesakes.station(now);
                      commands([&](CommandInterface& interface) {
                        interface.hear({p->name, p->id, info.sender}, p->protocol, now);
                      });
                    } else if (p->name == e.robot && info.sender != e.wire.id()) {
                      namesakes.heard(info.sender, now);
                      directory.on_namesake(p->name, p->id, info.sender, now);
                    }
                    if (p->name != e.robot) directory.on_presence(p->name, p->id, info.sender, now);
                  }),
           e.read(topics::kCapabilities,
                  [&e, commands, &directory, &namesakes, refused = dependencies.refused](
                      const radio::Capabilities&sample, const wire::SampleInfo&info) {
                    const auto c = contract::decode(sample);
                    const std::string wrong = contract::amount_refused(sample);
                    if (!c || !wrong.empty()) {
                      ++e.malformed;
                      if (c && refused) refused(c->name, wrong);
                      return;
                    }
                    const Time now = info.received;  // The strand may have been busy since.
                    if (c->kind == contract::AgentKind::station)
                      commands([&](CommandInterface& interface) {
                        interface.hear({c->name, c->id, info.sender}, c->protocol, now);
                      });
                    else if (c->name == e.robot)
                      namesakes.described(info.sender, contract::claim_of(c->services), now);
                    if (c->place)
                      e.wire.set_place(info.sender, {(*c->place)[0], (*c->place)[1], (*c->place)[2]});
                    if (c->name != e.robot) directory.on_capabilities({*c, info.sender}, now);
                  }),
           e.read(
               topics::kCommand,
               [command = dependencies.command, answer](const radio::Command&c, const wire::SampleInfo&info) {
                 command(received(contract::decode(c), info.sender), answer);
               },
               e.robot),
           e.read(
               topics::kJoystick,
               [&e, commands, answer](const radio::Joystick&j, const wire::SampleInfo&info) {
                 commands([&](CommandInterface& interface) {
                   const Time now = e.strand.now();
                   answer(interface.handle({contract::decode(j), info.sender, now - info.received}, now));
                 });
               },
               e.robot),
           e.read(topics::kTeam,
                  [&e, take = dependencies.beacon](const radio::TeamBeacon&b, const wire::SampleInfo&info) {
                    if (info.sender == e.wire.id() || !take) return;
                    const auto beacon = contract::decode(b);
                    e.malformed += beacon ? 0 : 1;
                    take(beacon, info.sender, info.received);
                  }),
           e.read(topics::kBulkAck, e.acknowledged),
       })
    if (!made) return made.error();
  if (dependencies.cameras) {
    auto opened = e.read(topics::kCameraViews, [take = dependencies.cameras](const radio::CameraViews& sample,
                                                                             const wire::SampleInfo& info) {
      if (const auto views = contract::decode(sample)) take(*views, info.sender);
    });
    if (!opened) return opened.error();
  }
  if (!dependencies.piece_to_carry) return {};
  if (auto made = e.io.open(e.carrier_ack, topics::kBulkAck, topics::kCarryPartition); !made)
    return made.error();
  return e.read(
      topics::kBulk,
      [take = dependencies.piece_to_carry](const radio::BulkPiece& sample, const wire::SampleInfo& info) {
        if (const auto piece = contract::decode(sample)) take(*piece, info.sender);
      },
      topics::kCarryPartition);
}

void RadioEdge::reach_carriers() {
  Endpoints& e = *endpoints_;
  if (std::exchange(e.reaches_carriers, true)) return;
  // After an error the map stays with this robot; it is not tried again.
  (void)e.io.open(e.bulk_to_carriers, topics::kBulk, topics::kCarryPartition);
  (void)e.read(topics::kBulkAck, e.acknowledged, topics::kCarryPartition);
}

void RadioEdge::close() {
  endpoints_->wire.on_participant(endpoints_->strand, {});
  endpoints_->presence_timer.cancel();
  endpoints_->readers.clear();
}

void RadioEdge::send(const TeamBeacon& beacon) {
  (void)endpoints_->team.write(encode(beacon));  // Best effort: the next one replaces it.
}

void RadioEdge::send(const transfer::Piece& piece, std::uint32_t session) {
  const radio::BulkPiece out =
      encode(contract::BulkPiece{endpoints_->robot, session, piece.id, static_cast<std::uint8_t>(piece.kind),
                                 piece.waiting, piece.data});
  // Best effort: core/transfer repairs what is lost.
  if (!piece.for_carriers)
    (void)endpoints_->bulk.write(out);
  else if (endpoints_->bulk_to_carriers)
    (void)endpoints_->bulk_to_carriers.write(out);
}

void RadioEdge::send(const transfer::PeerId& carrier,
                     const std::vector<std::pair<std::string, transfer::Receipt>>& receipts) {
  if (!endpoints_->carrier_ack) return;
  // Best effort: a receipt has what those before it had.
  (void)endpoints_->carrier_ack.write(encode(contract::BulkAck{.station = endpoints_->robot,
                                                               .station_id = carrier,
                                                               .start = 1,
                                                               .receipts = receipts,
                                                               .carrier = true}));
}

void RadioEdge::send_authority(const CommandInterface& commands, Time now) {
  endpoints_->send(endpoints_->authority, encode(status_of(commands, endpoints_->robot, now)));
}

void RadioEdge::send_behaviour(contract::BehaviourState state) {
  state.robot = endpoints_->robot;
  endpoints_->send(endpoints_->behaviour, encode(state));
}

void RadioEdge::send_state(contract::RobotState state) {
  state.robot = endpoints_->robot;
  (void)endpoints_->state.write(encode(state));
}

void RadioEdge::send_route(contract::Route route) {
  if (!endpoints_->route) return;
  route.robot = endpoints_->robot;
  endpoints_->send(endpoints_->route, encode(route));
}

void RadioEdge::send_capabilities(const Platform& platform, const Id& id, std::uint16_t protocol,
                                  const ModeTable& modes) {
  Endpoints& e = *endpoints_;
  e.capabilities_sample = capabilities_of(platform, e.robot, id, protocol, modes);
  if (e.carrier_ack) e.capabilities_sample.services.push_back(contract::service::kCarryMap);
  (void)e.capabilities.write(encode(e.capabilities_sample));
  // Without it, stations show no route.
  if (platform.router != "none") (void)e.io.open(e.route, topics::kRoute);
  e.presence_sample = {e.robot, contract::AgentKind::robot, id, protocol, e.presence_sample.seq};
  e.say_present();
  e.presence_timer = e.strand.every(kPresencePeriod, [&e] { e.say_present(); });
}

void RadioEdge::send_claim(const std::optional<Namesakes::Claim>& claim) {
  contract::Capabilities sample = endpoints_->capabilities_sample;
  if (claim) sample.services.push_back(contract::service_word(*claim));
  (void)endpoints_->capabilities.write(encode(sample));
}

void RadioEdge::send_link_report(Time now, std::uint64_t inner_malformed, double state_rate) {
  Endpoints& e = *endpoints_;
  contract::LinkReport report = e.meter.read(e.robot, e.wire.counters(), e.wire.sender(), now);
  report.state_rate = state_rate;
  report.malformed += static_cast<std::uint32_t>(inner_malformed + e.malformed);
  constexpr Duration kForgotten = 60s;  // A station that was silent for longer has no link.
  for (const wire::PeerMeter::Peer& peer : e.stations.peers(now)) {
    if (peer.held > kForgotten)
      e.stations.forget(peer.name);
    else
      report.peers.push_back({peer.name, peer.number, seconds(peer.held), peer.lost});
  }
  e.send(e.link, encode(report));
}

}  // namespace adit::agent
