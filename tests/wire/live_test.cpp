// SPDX-License-Identifier: Apache-2.0
// What only the real wire has: other processes, sockets, foreign writers.
#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>

#include "core/wire/fastdds/fastdds_participant.hpp"
#include "tests/folders/folders.hpp"
#include "tests/wire/nets.hpp"
#include "tests/wire/samples.hpp"

namespace adit::wire {
namespace {

constexpr TopicInfo kPing{"adit/ping", "Bytes", QosClass::urgent, 16, topics::kUnkeyed, 1 << 16};
constexpr TopicInfo kPong{"adit/pong", "Bytes", QosClass::urgent, 16, topics::kUnkeyed, 1 << 16};

/// Resident memory of this process, KiB.
long resident_kb() {
  std::ifstream status("/proc/self/statm");
  long size = 0, pages = 0;
  status >> size >> pages;
  return pages * (::sysconf(_SC_PAGESIZE) / 1024);
}

TEST(LiveWire, TwoProcessesEchoSmallAndLargeSamples) {
  LiveNet net;
  const auto strand = net.strand("test");
  live::Process echo({"wire_echo", std::to_string(live::domain())});
  ASSERT_TRUE(echo.wait_for_output("ready", live::Seconds(10)));
  const auto wire = net.join("client");
  Seen<std::vector<std::uint8_t>> seen;
  const auto reader = std::move(wire->make_reader(kPong, "", *strand, [&](auto bytes, const SampleInfo&) {
    seen.add({bytes.begin(), bytes.end()});
    return true;
  }));
  const auto writer = std::move(wire->make_writer(kPing, "")).value();
  ASSERT_TRUE(net.until([&] { return writer->matched() == 1; }));
  std::size_t expected = 0;
  for (const std::size_t size : {8U, 100U, 1400U, 5000U, 32768U}) {
    std::vector<std::uint8_t> sample(size, 7);
    sample[0] = 0, sample[1] = 1;
    ASSERT_TRUE(writer->write(sample).ok());
    // The way back may be matched a moment later than the way there: reliable, but volatile.
    ASSERT_TRUE(net.until([&] {
      if (seen.size() > expected) return true;
      if (expected == 0) (void)writer->write(sample);
      return false;
    })) << size;
    EXPECT_EQ(seen.all().back(), sample);
    net.pass(200ms);
    expected = seen.size();
  }
}

TEST(LiveWire, AKilledProcessDoesNotHoldUpAWriter) {
  LiveNet net;
  const std::vector<std::uint8_t> sample{0, 1, 0, 0, 1, 2, 3, 4};
  Duration shortest = Duration::max();
  for (int i = 0; i < live::max_measurements() && shortest >= 2s; ++i) {
    live::Process echo({"wire_echo", std::to_string(live::domain())});
    ASSERT_TRUE(echo.wait_for_output("ready", live::Seconds(10)));
    const auto wire = net.join("client");
    const auto writer = std::move(wire->make_writer(kPing, "")).value();
    ASSERT_TRUE(net.until([&] { return writer->matched() == 1; }));
    echo.signal(SIGKILL);
    echo.wait(live::Seconds(5));
    const Duration start = net.elapsed();
    for (int n = 0; n < 1000; ++n) ASSERT_TRUE(writer->write(sample).ok());
    shortest = std::min(shortest, net.elapsed() - start);
  }
  EXPECT_LT(shortest, 2s);
}

TEST(LiveWire, MalformedSamplesOnEveryTopicAreCountedAndSurvived) {
  LiveNet net;
  const auto strand = net.strand("test");
  const auto victim = net.join("victim"), foreign = net.join("foreign");
  const auto all = examples();
  std::vector<std::unique_ptr<RawReader>> readers;
  std::vector<std::unique_ptr<RawWriter>> writers;
  Seen<std::string> good;
  for (const Example& e : all) {
    readers.push_back(
        std::move(victim->make_reader(e.topic, "", *strand, [&good, &e](auto bytes, const SampleInfo&) {
          if (!e.decodes(bytes)) return false;
          good.add(e.topic.name);
          return true;
        })).value());
    writers.push_back(std::move(foreign->make_writer(e.topic, "")).value());
  }
  ASSERT_TRUE(net.until([&] {
    return std::all_of(writers.begin(), writers.end(), [](const auto& w) { return w->matched() == 1; });
  }));
  std::size_t bad = 0;
  const auto send = [&](std::size_t i, const std::vector<std::uint8_t>& bytes) {
    if (!writers[i]->write(bytes).ok()) return;
    ++bad;
    net.until(
        [&] {
          std::uint64_t malformed = 0;
          for (const TopicCount& count : victim->counters().topics) malformed += count.malformed;
          return malformed == bad;
        },
        3s);
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<std::uint8_t> truncated(all[i].bytes.begin(), all[i].bytes.end() - 1);
    // RTPS pads samples to four bytes.
    while (truncated.size() % 4 != 0 || all[i].decodes(truncated)) truncated.pop_back();
    send(i, truncated);
    if (!all[i].topic.keyed) {
      auto encapsulation = all[i].bytes;
      encapsulation[1] = 0x42;
      send(i, encapsulation);
      send(i, {0, 1, 0, 0});
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t before = good.size();
    ASSERT_TRUE(writers[i]->write(all[i].bytes).ok());
    EXPECT_TRUE(net.until([&] { return good.size() == before + 1; }, 3s)) << all[i].topic.name;
  }
  std::uint64_t malformed = 0;
  for (const TopicCount& count : victim->counters().topics) {
    malformed += count.malformed;
    EXPECT_EQ(count.peer, foreign->id()) << count.topic;
  }
  EXPECT_GE(bad, all.size());
  EXPECT_EQ(malformed, bad);
}

TEST(LiveWire, PeersAreFoundWithoutMulticast) {
  LiveNet net;
  FastDdsParams params{.domain = live::domain(1), .peers = {"127.0.0.1"}, .multicast = false};
  const auto a = std::move(open_fastdds(params)).value(), b = std::move(open_fastdds(params)).value();
  const auto writer = std::move(a->make_writer(kPing, "")).value();
  const auto strand = net.strand("test");
  const auto reader = b->make_reader(kPing, "", *strand, [](auto, const SampleInfo&) { return true; });
  EXPECT_TRUE(net.until([&] { return writer->matched() == 1; }));
}

// Another process has the ports that this participant would take first: what goes there is for it, and
// counted.
TEST(LiveWire, PortsThatWereTakenAreNotItsOwn) {
  LiveNet net;
  const std::uint32_t domain = live::domain(3);
  std::vector<int> taken;
  std::uint16_t port = 0;
  for (int i = 0; i < 3; ++i) {
    port = static_cast<std::uint16_t>(7411 + 250 * domain + 2 * i);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    taken.push_back(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    ASSERT_EQ(::bind(taken.back(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  {
    const FastDdsParams params{
        .domain = domain, .peers = {"127.0.0.1:" + std::to_string(port)}, .multicast = false};
    const auto wire = std::move(open_fastdds(params)).value();
    char datagram[2048];
    EXPECT_TRUE(net.until([&] { return ::recv(taken.back(), datagram, sizeof datagram, MSG_DONTWAIT) > 0; }));
    EXPECT_GT(wire->counters().total_out, 0u);
  }
  for (const int fd : taken) ::close(fd);
}

TEST(LiveWire, LargeScansArriveComplete) {
  LiveNet net;
  FastDdsParams params{.domain = live::domain(2), .large_samples = true};
  const auto strand = net.strand("test");
  const auto sim = std::move(open_fastdds(params)).value(), agent = std::move(open_fastdds(params)).value();
  Seen<std::size_t> seen;
  const auto reader = agent->make_reader(topics::kPoints, "", *strand, [&](auto bytes, const SampleInfo&) {
    seen.add(bytes.size());
    return true;
  });
  const auto writer = std::move(sim->make_writer(topics::kPoints, "")).value();
  ASSERT_TRUE(net.until([&] { return writer->matched() == 1; }));
  net.pass(200ms);
  std::vector<std::uint8_t> scan(230'000);
  scan[1] = 1;
  // One that comes while the receiver gets no processor time may find its socket full, and is lost.
  int written = 0;
  for (; written < 100 && seen.size() < 10; ++written) {
    const std::size_t before = seen.size();
    ASSERT_TRUE(writer->write(scan).ok());
    net.until([&] { return seen.size() > before; }, 100ms);
  }
  EXPECT_GE(seen.size(), 10U);
  if (live::patience() <= 1) {
    EXPECT_EQ(written, 10) << "lost on an idle machine";
  }
  for (const std::size_t size : seen.all()) EXPECT_EQ(size, scan.size());
}

// The driver edge reads what others write on rt/cmd_vel, to notice a second master.
TEST(LiveWire, AVelocityCostsOneDatagramToASingleDriver) {
  LiveNet net;
  FastDdsParams params{.domain = live::domain(2), .large_samples = true};
  const auto strand = net.strand("test");
  const auto agent = std::move(open_fastdds(params)).value(),
             driver = std::move(open_fastdds(params)).value();
  Seen<ParticipantId> wheels, rivals;
  const auto heard = [](Seen<ParticipantId>& seen) {
    return [&seen](auto, const SampleInfo& info) {
      seen.add(info.sender);
      return true;
    };
  };
  const auto reader = driver->make_reader(topics::kCmdVel, "", *strand, heard(wheels));
  const auto writer = std::move(agent->make_writer(topics::kCmdVel, "")).value();
  ASSERT_TRUE(net.until([&] { return writer->matched() >= 1; }));
  std::vector<std::uint8_t> velocity(52);
  velocity[1] = 1;
  const auto bytes_per_velocity = [&] {
    net.pass(300ms);
    constexpr std::size_t kSamples = 200;
    const std::uint64_t before = agent->counters().total_out;
    const std::size_t seen = wheels.size();
    for (std::size_t i = 1; i <= kSamples; ++i) {
      EXPECT_TRUE(writer->write(velocity).ok());
      EXPECT_TRUE(net.until([&] { return wheels.size() >= seen + i; }));
    }
    return static_cast<double>(agent->counters().total_out - before) / kSamples;
  };
  const double alone = bytes_per_velocity();
  const auto rival = agent->make_reader(topics::kCmdVelHeard, "", *strand, heard(rivals));
  EXPECT_LT(bytes_per_velocity(), 1.2 * alone);
  EXPECT_EQ(rivals.size(), 0U);
}

// A reader that hangs costs one sample of memory, and has the newest when it goes on.
TEST(LiveWire, AHungReaderOfScansCostsNoMemory) {
  LiveNet net;
  FastDdsParams params{.domain = live::domain(2), .large_samples = true};
  const auto strand = net.strand("test");
  const auto sim = std::move(open_fastdds(params)).value(), agent = std::move(open_fastdds(params)).value();
  Seen<std::pair<int, std::size_t>> seen;
  const auto reader = agent->make_reader(topics::kPoints, "", *strand, [&](auto bytes, const SampleInfo&) {
    seen.add({bytes[4], bytes.size()});
    return true;
  });
  const auto writer = std::move(sim->make_writer(topics::kPoints, "")).value();
  ASSERT_TRUE(net.until([&] { return writer->matched() == 1; }));
  net.pass(200ms);
  std::vector<std::uint8_t> scan(1'000'000);
  scan[1] = 1;
  const auto received = [&] {
    std::uint64_t sum = 0;
    for (const TopicCount& count : agent->counters().topics) sum += count.samples_in;
    return sum;
  };
  // The receive buffer may lose a fragment of a scan: so many are written until enough have come.
  const auto write_until = [&](std::uint64_t enough, Duration pause = 5ms) {
    for (int i = 1; i <= 1000 && received() < enough; ++i) {
      ++scan[4];
      ASSERT_TRUE(writer->write(scan).ok());
      net.pass(pause);
    }
  };
  write_until(5);
  std::promise<void> hang, hangs;
  strand->post([&] {
    hangs.set_value();
    hang.get_future().wait();
  });
  hangs.get_future().wait();
  const std::size_t before = seen.size();
  write_until(received() + 3);
  const long start = resident_kb();
  write_until(received() + 60);
  EXPECT_LT(resident_kb() - start, 8 * 1024);
  // The socket may hold some scans yet, which a slow machine reads late. They come before the reader goes on,
  // and after them one more, which is the newest.
  std::uint64_t came = 0;
  do {
    came = received();
    net.pass(300ms);
  } while (received() != came);
  write_until(came + 1, 300ms);
  hang.set_value();
  ASSERT_TRUE(net.until([&] { return seen.size() > before; }));
  net.pass(300ms);
  EXPECT_LE(seen.size(), before + 2);  // of the one that came while it went on, too
  EXPECT_EQ(seen.all().back(), (std::pair<int, std::size_t>{scan[4], scan.size()}));
}

// A ROS 2 robot's environment is its own: our participants take nothing from it.
TEST(LiveWire, TheEnvironmentOfRos2ChangesNothing) {
  LiveNet net;
  const auto strand = net.strand("test");
  const std::string profiles = scratch_folder() + "/profiles.xml";
  std::ofstream(profiles) << "<dds><log><use_default>FALSE</use_default></log><library_settings>"
                             "<intraprocess_delivery>FULL</intraprocess_delivery></library_settings></dds>";
  ::setenv("ROS_DISCOVERY_SERVER", "127.0.0.1:11811", 1);
  ::setenv("FASTRTPS_DEFAULT_PROFILES_FILE", profiles.c_str(), 1);
  const auto a = net.join("a"), b = net.join("b");
  const auto writer = std::move(a->make_writer(kPing, "")).value();
  const auto reader = b->make_reader(kPing, "", *strand, [](auto, const SampleInfo&) { return true; });
  EXPECT_TRUE(net.until([&] { return writer->matched() == 1; }));
  ::unsetenv("ROS_DISCOVERY_SERVER");
  ::unsetenv("FASTRTPS_DEFAULT_PROFILES_FILE");
}

TEST(LiveWire, WrongParametersAreErrors) {
  EXPECT_EQ(open_fastdds({.domain = 233}).reason(), Reason::bad_argument);
  EXPECT_EQ(open_fastdds({.interfaces = {"eth0"}}).reason(), Reason::bad_argument);
  EXPECT_EQ(open_fastdds({.interfaces = {"192.0.2.1"}}).reason(), Reason::bad_argument);
  EXPECT_EQ(open_fastdds({.peers = {"127.0.0.1:x"}}).reason(), Reason::bad_argument);
  EXPECT_EQ(open_fastdds({.peers = {"robot"}}).reason(), Reason::bad_argument);
}

TEST(LiveWire, ClosesWhileSamplesAndCallbacksAreUnderWay) {
  LiveNet net;
  const auto strand = net.strand("test");
  const auto sender = net.join("sender");
  const auto writer = std::move(sender->make_writer(kPing, "")).value();
  const std::vector<std::uint8_t> sample{0, 1, 0, 0, 1, 2, 3, 4};
  for (int round = 0; round < 5; ++round) {
    auto count = std::make_unique<std::atomic<int>>(0);
    auto receiver = net.join("receiver");
    receiver->on_participant(*strand, [&](const ParticipantEvent&) { ++*count; });
    auto reader =
        receiver->make_reader(kPing, "", *strand, [&](auto, const SampleInfo&) { return ++*count > 0; });
    ASSERT_TRUE(net.until([&] { return writer->matched() == 1; }));
    for (int i = 0; i < 200; ++i) (void)writer->write(sample);
    reader = Error{Reason::none, ""};
    receiver.reset();
    count.reset();  // any later call of a handler would touch it
    ASSERT_TRUE(net.until([&] { return writer->matched() == 0; }));
  }
}

// The library ends the process when a submessage of its vendor's statistics is not the last one of a
// datagram.
TEST(LiveWire, AForeignDatagramOfEightyEightBytesEndsNobody) {
  LiveNet net;
  const auto strand = net.strand("test");
  const auto robot = net.join("robot"), station = net.join("station");
  Seen<std::size_t> seen;
  const auto reader = std::move(robot->make_reader(kPing, "", *strand, [&](auto bytes, const SampleInfo&) {
                        seen.add(bytes.size());
                        return true;
                      })).value();
  const auto writer = std::move(station->make_writer(kPing, "")).value();
  ASSERT_TRUE(net.until([&] { return writer->matched() == 1; }));
  std::vector<std::uint8_t> datagram(88);
  const std::uint8_t header[]{'R', 'T', 'P', 'S', 2, 3, 1, 15};
  std::copy(std::begin(header), std::end(header), datagram.begin());
  datagram[20] = 0x80, datagram[21] = 1, datagram[22] = 56;
  datagram[80] = 0x01, datagram[81] = 1, datagram[82] = 4;
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  for (std::uint32_t port = 7410; port < 7414; ++port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port + 250 * live::domain()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ASSERT_EQ(::sendto(fd, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&address),
                       sizeof address),
              static_cast<ssize_t>(datagram.size()));
  }
  ::close(fd);
  const std::uint64_t before = robot->counters().total_in;
  ASSERT_TRUE(writer->write(std::vector<std::uint8_t>{0, 1, 0, 0, 1, 2, 3, 4}).ok());
  EXPECT_TRUE(net.until([&] { return seen.size() == 1; }));
  EXPECT_GT(robot->counters().total_in, before);
}

}  // namespace
}  // namespace adit::wire
