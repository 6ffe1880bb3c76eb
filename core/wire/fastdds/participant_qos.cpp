// SPDX-License-Identifier: Apache-2.0
#include "core/wire/fastdds/participant_qos.hpp"

#include <arpa/inet.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <charconv>
#include <cmath>
#include <set>

#include "core/wire/cost.hpp"
#include "core/wire/fastdds/endpoint_qos.hpp"
#include "core/wire/fastdds/filtering_transport.hpp"
#include "core/wire/link/budget.hpp"
#include "core/wire/qos.hpp"

namespace adit::wire {
namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
namespace {

constexpr std::uint32_t kLoopbackDatagram = 65000;
/// Receive buffer for complete scans until they are read, bytes; the kernel gives at most net.core.rmem_max.
constexpr std::uint32_t kScanBuffer = 4 << 20;
constexpr std::uint32_t kParticipantsPerHost = 16;  // Ports tried at an address that is given without one.
constexpr std::uint32_t kSendBuffer = 212992;       // Bytes, the default of Linux.
/// The library reserves room in each message for statistics, 60 bytes that are removed again, and for a
/// heartbeat, 32 bytes, which hardly ever goes with a fragment. With 20 of these, an endpoint announcement
/// with a short name fits one frame of 500 bytes.
constexpr std::uint32_t kNeverSent = 60 + 20;
/// The longest announcement of an endpoint (longest topic and type, a name of 32 bytes as partition, one
/// address) with what kNeverSent is for, bytes. The library does not repair an announcement that needs two
/// datagrams.
constexpr std::uint32_t kAnnouncement = 592;
constexpr std::uint32_t kAddress = 24;                 // Each further address in it.
constexpr const char* kRtpsMulticast = "239.255.0.1";  // RTPS multicast group.

eprosima::fastrtps::Duration_t duration(Duration d) {
  return {static_cast<std::int32_t>(d / 1s), static_cast<std::uint32_t>((d % 1s).count())};
}

/// Parses ADDRESS or ADDRESS:PORT; port 0: the ports of the first participants there.
Result<rtps::Locator_t> locator(const std::string& text) {
  rtps::Locator_t result;
  result.kind = LOCATOR_KIND_UDPv4;
  result.port = 0;
  const std::size_t colon = text.find(':');
  const std::string address = text.substr(0, colon);
  std::uint16_t port = 0;
  if (colon != std::string::npos) {
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data() + colon + 1, end, port);
    if (parsed.ec != std::errc{} || parsed.ptr != end || port == 0) {
      return Error{Reason::bad_argument, "peer " + text + ": expected ADDRESS or ADDRESS:PORT"};
    }
  }
  if (!rtps::IPLocator::isIPv4(address) || !rtps::IPLocator::setIPv4(result, address)) {
    return Error{Reason::bad_argument, "peer " + text + ": " + address + " is no IPv4 address"};
  }
  result.port = port;
  return result;
}

/// Returns the IPv4 addresses of this machine's interfaces that are up, as the library determines them.
std::set<std::string> own_addresses() {
  std::set<std::string> result;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return result;
  for (const ifaddrs* at = first; at != nullptr; at = at->ifa_next) {
    if ((at->ifa_flags & IFF_RUNNING) == 0) continue;
    if (at->ifa_addr == nullptr || at->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN]{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(at->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text, sizeof text) != nullptr) result.insert(text);
  }
  freeifaddrs(first);
  return result;
}

/// Adds a flow controller that gives the class its share of the link per period: at least four frames,
/// because a sample is sent only when a complete fragment of it fits.
void add_flow(const char* name, double share, const LinkProfile& link, dds::DomainParticipantQos& qos) {
  const double frames = std::max(4.0, share * link.bandwidth / 8.0 * 0.02 / link.frame_bytes());  // In 20 ms.
  const double bytes = std::floor(frames) * link.frame_bytes();
  auto flow = std::make_shared<eprosima::fastdds::rtps::FlowControllerDescriptor>();
  flow->name = name;
  flow->max_bytes_per_period = static_cast<std::int32_t>(bytes);
  flow->period_ms = static_cast<std::uint64_t>(std::max(1.0, bytes * 8.0 / (share * link.bandwidth) * 1e3));
  qos.flow_controllers().push_back(std::move(flow));
}

}  // namespace

Result<dds::DomainParticipantQos> dds_participant_qos(const FastDdsParams& params,
                                                      std::shared_ptr<TransportContext> context) {
  if (params.domain > 232) {
    return Error{Reason::bad_argument, "domain " + std::to_string(params.domain) + ": expected 0 to 232"};
  }
  dds::DomainParticipantQos qos;
  qos.name(params.name.c_str());
  // Otherwise every announcement would contain host, user and process, a third of its size.
  qos.properties().properties().clear();

  // The built-in transports are off because they use every interface of the machine.
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = params.interfaces;
  const std::set<std::string> own = own_addresses();
  for (const std::string& address : params.interfaces) {
    if (!rtps::IPLocator::isIPv4(address)) {
      return Error{Reason::bad_argument,
                   "interface " + address + ": expected an IPv4 address of this machine"};
    }
    // The library would continue without an error, and neither send nor receive.
    if (!own.contains(address)) {
      return Error{Reason::bad_argument,
                   "interface " + address + ": no interface of this machine that is up has this address"};
    }
  }
  if (udp->interfaceWhiteList.empty()) udp->interfaceWhiteList.push_back("127.0.0.1");
  udp->non_blocking_send = true;
  // Without a size the library takes the buffer for full after each sample; a heartbeat then goes with each
  // fragment and each repair to every reader, and every reader acknowledges it.
  udp->sendBufferSize = kSendBuffer;
  udp->maxMessageSize = params.large_samples ? kLoopbackDatagram : WireCost::kFrame + kNeverSent;
  if (params.large_samples) udp->receiveBufferSize = kScanBuffer;
  if (params.link) {
    const auto addresses = static_cast<std::uint32_t>(udp->interfaceWhiteList.size());
    const std::uint32_t frame = params.link->frame_bytes() - WireCost::kUdpAndIp + kNeverSent;
    udp->maxMessageSize =
        std::min(udp->maxMessageSize, std::max(frame, kAnnouncement + kAddress * (addresses - 1)));
    const Budget budget;
    add_flow(kBulkFlow, budget.share[5], *params.link, qos);
  }
  udp->maxInitialPeersRange = kParticipantsPerHost;
  qos.transport().user_transports.push_back(
      std::make_shared<FilteringTransportDescriptor>(udp, std::move(context)));

  auto& builtin = qos.wire_protocol().builtin;
  auto& discovery = builtin.discovery_config;
  discovery.leaseDuration = duration(Discovery::kLease);
  discovery.leaseDuration_announcementperiod = duration(Discovery::kAnnouncement);
  discovery.initial_announcements.count = Discovery::kInitialAnnouncements;
  discovery.initial_announcements.period = duration(Discovery::kInitialPeriod);
  builtin.typelookup_config.use_client = false;
  builtin.typelookup_config.use_server = false;
  builtin.use_WriterLivelinessProtocol = false;  // The application's own samples show liveliness.

  for (const std::string& peer : params.peers) {
    auto parsed = locator(peer);
    if (!parsed) return parsed.error();
    builtin.initialPeersList.push_back(*parsed);
  }
  if (!params.multicast) {
    // An own unicast list keeps the library from listening to the multicast group.
    rtps::Locator_t any;
    any.kind = LOCATOR_KIND_UDPv4;
    any.port = 0;
    builtin.metatrafficUnicastLocatorList.push_back(any);
    if (builtin.initialPeersList.empty()) builtin.initialPeersList.push_back(*locator("127.0.0.1"));
  } else if (!params.peers.empty()) {
    builtin.initialPeersList.push_back(*locator(kRtpsMulticast));
  }
  return qos;
}

}  // namespace adit::wire
