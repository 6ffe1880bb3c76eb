// SPDX-License-Identifier: Apache-2.0
#include "core/contract/discovery.hpp"

#include <limits>

#include "adit/discovery.h"
#include "core/command/words.hpp"
#include "core/wire/topics.hpp"
#include "tests/contract/random_samples.hpp"

namespace adit::contract {

static float plausible(RandomSamples& random) {
  return random.random().chance(0.2) ? 0.0F : static_cast<float>(random.random().uniform(0.05, 1.6));
}

static void randomize(RandomSamples& random, radio::Capabilities& out) {
  random.any(out.name(), out.kind(), out.id(), out.protocol(), out.software(), out.platform(),
             out.holonomic(), out.length(), out.width(), out.height(), out.max_speed(), out.max_turn(),
             out.max_acceleration(), out.step(), out.slope(), out.stairs(), out.sensors(), out.modes(),
             out.services(), out.placed(), out.place());
  if (random.random().chance(0.2)) return;
  for (float* amount : {&out.length(), &out.width(), &out.height(), &out.max_speed(), &out.max_turn(),
                        &out.max_acceleration(), &out.step(), &out.slope()})
    *amount = plausible(random);
}

static void randomize(RandomSamples& random, radio::Presence& out) {
  random.any(out.name(), out.kind(), out.id(), out.protocol(), out.seq());
}

namespace {

std::vector<std::string> any_names(RandomSamples& random, std::size_t max) {
  std::vector<std::string> out(random.random().below(max + 1));
  for (std::string& word : out) word = random.name();
  return out;
}

TEST(ContractDiscovery, CapabilitiesComeBackAsTheyWereAndFitTheirTopic) {
  for_each_seed([](RandomSamples& random) {
    Capabilities sent{.name = random.name(),
                      .software = random.name(),
                      .platform = random.name(),
                      .sensors = any_names(random, Capabilities::kMaxSensors),
                      .modes = any_names(random, Capabilities::kMaxModes),
                      .services = any_names(random, Capabilities::kMaxServices)};
    random.any(sent.id, sent.protocol, sent.holonomic, sent.stairs);
    for (float* amount : {&sent.length, &sent.width, &sent.height, &sent.max_speed, &sent.max_turn,
                          &sent.max_acceleration, &sent.max_step, &sent.max_slope})
      *amount = plausible(random);
    if (random.random().chance(0.5)) sent.kind = AgentKind::station;
    if (sent.kind == AgentKind::station && random.random().chance(0.5)) sent.place = {1.0F, -2.5F, 0.25F};
    EXPECT_EQ(decode(through_cdr(encode(sent), wire::topics::kCapabilities)), sent);
  });
}

TEST(ContractDiscovery, AnyCapabilitiesAreBounded) {
  int taken = 0, places = 0;
  for_any<radio::Capabilities>([&](const radio::Capabilities& sample) {
    const auto read = decode(sample);
    EXPECT_EQ(read.has_value(), command::valid_name(sample.name()));
    if (!read) return;
    ++taken;
    EXPECT_EQ(read->kind == AgentKind::station, sample.kind() == radio::AGENT_STATION);
    for (const float amount : {read->length, read->width, read->height, read->max_speed, read->max_turn,
                               read->max_acceleration, read->max_step, read->max_slope}) {
      EXPECT_GE(amount, 0.0F);
      EXPECT_LE(amount, 100.0F);
    }
    EXPECT_LE(read->sensors.size(), Capabilities::kMaxSensors);
    EXPECT_LE(read->modes.size(), Capabilities::kMaxModes);
    EXPECT_LE(read->services.size(), Capabilities::kMaxServices);
    for (const auto* words : {&read->sensors, &read->modes, &read->services})
      for (const std::string& word : *words) EXPECT_TRUE(is_clean(word, kMaxName));
    for (const std::string& word : {read->software, read->platform}) EXPECT_TRUE(is_clean(word, kMaxName));
    if (!read->place) return;
    ++places;
    EXPECT_EQ(read->kind, AgentKind::station) << "a robot's state says where it is";
    EXPECT_TRUE(sample.placed());
    for (const float metres : *read->place) EXPECT_TRUE(std::isfinite(metres));
  });
  EXPECT_GT(taken, 0);
  EXPECT_GT(places, 0);
}

TEST(ContractDiscovery, AnAmountThatNoRobotHasIsRefusedWithItsLimits) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float wrong : {600.0F, 1e30F, inf, nan, -1.0F}) {
    for (auto amount : {&Capabilities::length, &Capabilities::width, &Capabilities::height,
                        &Capabilities::max_speed, &Capabilities::max_turn, &Capabilities::max_acceleration,
                        &Capabilities::max_step, &Capabilities::max_slope}) {
      Capabilities sent{.name = "r2"};
      sent.*amount = wrong;
      EXPECT_NE(amount_refused(encode(sent)), "") << wrong;
      EXPECT_EQ(decode(encode(sent)), Capabilities{.name = "r2"}) << "it is unknown";
    }
  }
  const auto sample = encode(Capabilities{.name = "r2", .length = 600.0F, .width = 0.5F});
  EXPECT_EQ(amount_refused(sample), "length of 600 m (expected 0, or 0.05 to 20)");
  EXPECT_NE(amount_refused(encode(Capabilities{.name = "r2", .length = 0.01F})), "") << "another unit";
}

TEST(ContractDiscovery, APresenceComesBackAsItWas) {
  for_any<radio::Presence>([](const radio::Presence& sample) {
    const auto read = decode(sample);
    EXPECT_EQ(read.has_value(), command::valid_name(sample.name()));
    if (!read) return;
    EXPECT_EQ(read->kind == AgentKind::station, sample.kind() == radio::AGENT_STATION);
    EXPECT_EQ(decode(through_cdr(encode(*read), wire::topics::kPresence)), read);
  });
}

TEST(ContractDiscovery, AClaimIsOneOfTheServices) {
  for_each_seed([](RandomSamples& random) {
    NameClaim claim;
    random.any(claim.held, claim.start);
    EXPECT_EQ(claim_of({"route", service_word(claim), "tilt"}), claim);
    EXPECT_LE(service_word(claim).size(), kMaxName);
  });
  EXPECT_EQ(service_word({true, 0x2a}), "name_taken:held:000000000000002a");
  EXPECT_EQ(claim_of({"route", "tilt"}), std::nullopt);
  for (const char* word : {"name_taken:", "name_taken:free", "name_taken:free:", "name_taken:free:xyz"})
    EXPECT_EQ(claim_of({word}), NameClaim{}) << word;
  EXPECT_TRUE(offers({"route", service::kCarryMap}, service::kCarryMap));
  EXPECT_FALSE(offers({"route"}, service::kCarryMap));
}

}  // namespace
}  // namespace adit::contract
