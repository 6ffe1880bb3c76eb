// SPDX-License-Identifier: Apache-2.0
#include "core/contract/common.hpp"

#include <gmock/gmock.h>

#include "tests/contract/random_samples.hpp"

namespace adit::contract {
namespace {

TEST(ContractCommon, AnEpochComesBackAsItWas) {
  for_any<radio::Epoch>([](const radio::Epoch& sample) {
    const Epoch epoch = decode(sample);
    EXPECT_EQ(epoch, (Epoch{sample.start(), sample.counter()}));
    EXPECT_EQ(decode(through_cdr(encode(epoch))), epoch);
  });
}

TEST(ContractCommon, WordsAreCleanedAndCounted) {
  EXPECT_THAT(cleaned_names({"a\x1b[31m", std::string(40, 'b'), "c"}, 2),
              testing::ElementsAre("a?[31m", std::string(kMaxName, 'b')));
}

TEST(ContractCommon, ALongTextIsCutVisibly) {
  EXPECT_EQ(clipped("abcdef", 6), "abcdef");
  EXPECT_EQ(clipped("abcdefg", 6), "abc...");
}

enum class Colour : std::uint8_t { red, green, grey };

TEST(ContractCommon, AnUnknownEnumeratorIsReplaced) {
  EXPECT_EQ(known_or(1, Colour::green, Colour::grey), Colour::green);
  EXPECT_EQ(known_or(2U, Colour::green, Colour::grey), Colour::grey);
  EXPECT_EQ(known_or(-1, Colour::green, Colour::grey), Colour::grey);
}

TEST(ContractCommon, AnAmountIsFiniteAndNotNegative) {
  EXPECT_EQ(amount(2.5F), 2.5F);
  for (const float wrong : {-1.0F, std::nanf(""), std::numeric_limits<float>::infinity(), 2e12F})
    EXPECT_EQ(amount(wrong), 0.0F);
  EXPECT_TRUE(finite(1.0, 2.0F));
  EXPECT_FALSE(finite(1.0, std::nanf("")));
}

}  // namespace
}  // namespace adit::contract
