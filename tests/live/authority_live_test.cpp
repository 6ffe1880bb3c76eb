#include "tests/live/authority_table.hpp"

namespace adit::live {
namespace {

// One crew for all cases: participants and their discovery are what takes time.
TEST(AuthorityLive, AllCases) {
  Table table(make_live_net(), 6s);
  for (const Case& c : authority_cases::all()) table.play(c);
}

}  // namespace
}  // namespace adit::live
