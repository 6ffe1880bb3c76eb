// SPDX-License-Identifier: Apache-2.0
#include "tests/live/authority_table.hpp"

namespace adit::live {
namespace {

class AuthorityInRehearsal : public testing::TestWithParam<Case> {};

TEST_P(AuthorityInRehearsal, Case) {
  Table(make_rehearsal_net(), std::chrono::seconds(authority_cases::kLease)).play(GetParam());
}
INSTANTIATE_TEST_SUITE_P(Rules, AuthorityInRehearsal, testing::ValuesIn(authority_cases::all()),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace adit::live
