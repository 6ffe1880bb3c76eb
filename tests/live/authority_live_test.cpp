// SPDX-License-Identifier: Apache-2.0
#include <set>

#include "tests/live/authority_table.hpp"

namespace adit::live {
namespace {

// One crew for all cases: participants and their discovery are what takes time.
#if !defined(__SANITIZE_THREAD__)
TEST(AuthorityLive, AllCases) {
  Table table(make_live_net(), 6s);
  for (const Case& c : authority_cases::all()) table.play(c);
}
#else
// What all threads pass through: answers, notices, foreign participants, a station that is killed.
TEST(AuthorityLive, CasesWatchedForDataRaces) {
  const std::set<std::string> chosen{"take_locked", "grant_unlocks", "reset_override", "forger_release",
                                     "restart_keeps_holding"};
  Table table(make_live_net(), 20s);
  std::size_t played = 0;
  for (const Case& c : authority_cases::all()) {
    if (!chosen.contains(c.name)) continue;
    table.play(c);
    ++played;
  }
  EXPECT_EQ(played, chosen.size());
}
#endif

}  // namespace
}  // namespace adit::live
