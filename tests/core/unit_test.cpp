// SPDX-License-Identifier: Apache-2.0
#include "core/supervisor/unit.hpp"

#include <gtest/gtest.h>

#include <future>

#include "core/exec/live_runtime.hpp"

namespace adit {
namespace {

/// A component that does nothing.
class Idle final : public Component {
 public:
  using Component::Component;
};

UnitParams idle_unit() {
  UnitParams params{};
  params.name = "idle";
  params.make = [](Executor& strand) -> Result<std::unique_ptr<Component>> {
    return std::unique_ptr<Component>(std::make_unique<Idle>("idle", strand));
  };
  return params;
}

// With policy `manual` it is not replaced: tasks that others post would wait for ever.
TEST(Unit, AnAbandonedHungPartStoresNothingThatIsPostedToIt) {
  LiveRuntime runtime;
  Unit unit(runtime, idle_unit());
  ASSERT_TRUE(unit.open());
  const auto slot = unit.slot();
  const auto strand = slot->strand;
  std::promise<void> entered, go_on;
  strand->post([&entered, go = go_on.get_future().share()] {
    entered.set_value();
    go.wait();
  });
  entered.get_future().wait();
  const auto scan = std::make_shared<int>(0);
  strand->post([scan] {});
  unit.abandon();
  EXPECT_EQ(scan.use_count(), 1);
  EXPECT_FALSE(strand->post([scan] {}));
  EXPECT_FALSE(strand->post_control([scan] {}));
  EXPECT_EQ(scan.use_count(), 1);
  EXPECT_EQ(runtime.left_behind(), 1u);
  EXPECT_FALSE(slot->generation->valid()) << "what writes from it must not";
  unit.replace();  // the operator's word
  EXPECT_TRUE(unit.slot()->generation->valid());
  EXPECT_NE(unit.slot()->strand, strand);
  EXPECT_EQ(runtime.left_behind(), 1u);
  go_on.set_value();
  unit.end();
}

// The agent is about to end: a task that hung and goes on must not write any more.
TEST(Unit, ARevokedPartWritesNothingFromItsStrand) {
  LiveRuntime runtime;
  Unit unit(runtime, idle_unit());
  ASSERT_TRUE(unit.open());
  const auto writers = unit.slot()->generation;
  unit.revoke();
  EXPECT_FALSE(writers->valid());
  unit.end();
}

}  // namespace
}  // namespace adit
