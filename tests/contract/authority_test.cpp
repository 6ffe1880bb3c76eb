// SPDX-License-Identifier: Apache-2.0
#include "core/contract/authority.hpp"

#include "adit/authority.h"
#include "core/command/words.hpp"
#include "core/wire/topics.hpp"
#include "tests/contract/random_samples.hpp"

namespace adit::contract {

static void randomize(RandomSamples& random, radio::Stopper& out) {
  random.any(out.station(), out.station_id());
}

static void randomize(RandomSamples& random, radio::AuthorityStatus& out) {
  random.any(out.robot(), out.epoch(), out.holder(), out.holder_id(), out.locked(), out.lock_lease_left(),
             out.stops(), out.seq());
}

namespace {

AuthorityStatus any_status(RandomSamples& random) {
  AuthorityStatus out{.robot = random.name(), .lease_left = static_cast<float>(random.number(100.0))};
  random.any(out.epoch.start, out.epoch.counter, out.locked);
  const auto party = [&random] {
    Party made{random.name(), {}};
    random.any(made.id);
    return made;
  };
  if (random.random().chance(0.7)) out.holder = party();
  out.stops.resize(random.random().below(AuthorityStatus::kMaxStops + 1));
  for (Party& stopper : out.stops) stopper = party();
  return out;
}

TEST(ContractAuthority, AStatusComesBackAsItWasAndFitsItsTopic) {
  for_each_seed([](RandomSamples& random) {
    const AuthorityStatus sent = any_status(random);
    EXPECT_EQ(decode(through_cdr(encode(sent), wire::topics::kAuthority)), sent);
  });
}

TEST(ContractAuthority, AnySampleIsBounded) {
  int taken = 0;
  for_any<radio::AuthorityStatus>([&taken](const radio::AuthorityStatus& sample) {
    const auto read = decode(sample);
    EXPECT_EQ(read.has_value(), command::valid_name(sample.robot()));
    if (!read) return;
    ++taken;
    EXPECT_TRUE(std::isfinite(read->lease_left));
    EXPECT_LE(read->stops.size(), AuthorityStatus::kMaxStops);
    EXPECT_EQ(read->holder.has_value(), !sample.holder().empty());
    if (read->holder) {
      EXPECT_TRUE(is_clean(read->holder->name, kMaxName));
    }
    for (const Party& stopper : read->stops) EXPECT_TRUE(is_clean(stopper.name, kMaxName));
  });
  EXPECT_GT(taken, 0);
}

}  // namespace
}  // namespace adit::contract
